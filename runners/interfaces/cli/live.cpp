// The commands about this machine and live runs: `live`, `devices` and `jitter`.
#include <spawn.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/result_file.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/libraries/depth_device.h"
#include "runners/live/devices/clock.h"
#include "runners/live/devices/device_table.h"
#include "runners/live/loop/live_log.h"
#include "runners/live/loop/live_run.h"
#include "runners/live/loop/live_view.h"
#include "runners/live/sensors/sensor_table.h"

namespace remote_touch {
namespace {

struct LiveRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string device, depth = "sim:";  // empty device: browser: if view, else sim:
  std::string record, output, report;  // files to write; empty: none
  std::optional<double> duration_s;    // none: until a signal comes
  bool strict = false;
  bool view = false;  // shows the run in a browser
  int view_port = 0;
};

struct DevicesRequest {
  std::string report, device = "sim:";  // report: the file to write; empty: none
  double duration_s = 10;               // of each measurement of the report
};

struct JitterRequest {
  double duration_s = 10, rate_hz = 1000;
};

std::string device_of(const LiveRequest& request) {
  if (!request.device.empty()) return request.device;
  return request.view ? "browser:" : "sim:";
}

std::string normalised(const LiveRequest& request) {
  std::vector<std::string> words = program_words();
  words.insert(words.end(),
               {"live", request.experiment, "--device", device_of(request), "--depth", request.depth});
  for (const std::string& assignment : request.overrides) words.insert(words.end(), {"--set", assignment});
  return shell_command(words);
}

void report_line(const std::string& text) {
  std::fprintf(stderr, "live: %s%s", text.c_str(), text.ends_with('\n') ? "" : "\n");
}

// Returns the files that a live run reads: the files of the experiment, of replay:FILE and of pcd:FILE.
std::vector<std::string> inputs_of(const LiveRequest& request, const Experiment& experiment) {
  std::vector<std::string> files = with_parts(request.experiment, experiment.inputs());
  for (const std::string& address : {request.depth, request.device})
    files.push_back(address.substr(address.find(':') + 1));
  return files;
}

// Makes SIGQUIT end the program as SIGINT does, and ignores SIGPIPE and SIGTSTP. A haptic device must be
// released however the program ends, and a stopped program would not release it.
void set_live_signals() {
  struct sigaction interrupt {};
  sigaction(SIGINT, nullptr, &interrupt);
  sigaction(SIGQUIT, &interrupt, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGTSTP, SIG_IGN);
}

// Returns the folders to try for the page that leads the browser to the address, in order. A browser that is
// installed as a snap has a temporary folder of its own, but reads files of the home folder whose names do
// not begin with a dot.
std::vector<std::filesystem::path> redirect_folders() {
  std::vector<std::filesystem::path> folders;
  if (const char* const home = std::getenv("HOME")) folders.emplace_back(home);
  std::error_code none;
  if (const auto temporary = std::filesystem::temp_directory_path(none); !none) folders.push_back(temporary);
  return folders;
}

void report_no_browser(const std::string& why) {
  report_line("no browser was opened (" + why + "): open the address above in one");
}

// Opens the address in the browser of the desktop; Ctrl-C does not end that browser. Without a desktop
// nothing is opened, and the user reads the printed address. Returns the page that the browser reads. Reports
// why no browser could be started.
RedirectPage show_in_browser(const std::string& address) {
  if (!std::getenv("DISPLAY") && !std::getenv("WAYLAND_DISPLAY")) return {};
  RedirectPage page(address, redirect_folders());
  std::string program = "xdg-open", file = page.file();
  if (file.empty()) {
    report_no_browser("its page cannot be written");
    return {};
  }
  char* const arguments[] = {program.data(), file.data(), nullptr};
  posix_spawnattr_t own_session;
  posix_spawnattr_init(&own_session);
  posix_spawnattr_setflags(&own_session, POSIX_SPAWN_SETSID);
  pid_t child = 0;
  const int error = posix_spawnp(&child, program.c_str(), nullptr, &own_session, arguments, environ);
  posix_spawnattr_destroy(&own_session);
  if (error != 0) report_no_browser(program + ": " + std::strerror(error));
  return page;
}

std::unique_ptr<LiveView> open_view(const CommandLine& line, const LiveRequest& request,
                                    const Experiment& experiment, LiveOptions& options) {
  auto view = std::make_unique<LiveView>(experiment,
                                         LiveViewSource{normalised(request), options.device, options.depth},
                                         *line.kernels, request.view_port);
  view->connect(options);
  return view;
}

// Prints the address, and opens it in a browser if there is a desktop. If the session has a device other than
// browser:, the page only shows the run.
RedirectPage show_address(const LiveView& view, const std::string& device) {
  std::printf("open this page to see the run%s: %s\n", device == "browser:" ? " and to move the hand" : "",
              view.address().c_str());
  std::fflush(stdout);
  return show_in_browser(view.address());
}

// Reports while the run continues. A file that cannot be written does not end the run.
void report_now(const LiveReport& report, const std::string& file, const TextAttributes& origin) try {
  report_line("so far\n" + text(report));
  if (!file.empty()) write_figure(file, live_figure(report), origin);
} catch (const std::exception& error) {
  report_line(error.what());
}

// Writes the trace if --output is given. If all ticks were kept, prints its digest, which a replay of the
// recording has too.
void print_trace(const LiveRequest& request, const LiveLog& log, const TextAttributes& origin) {
  const std::string trace_digest = request.output.empty()
                                       ? digest(log.trace.columns())
                                       : write_trace(request.output, log.trace, origin, log.row_step_s);
  if (log.is_whole())
    std::printf("  digest of the trace: %s\n", trace_digest.c_str());
  else
    std::printf("  only the first %zu of %lld ticks were kept as a trace; --record keeps all of them\n",
                log.trace.length(), static_cast<long long>(log.ticks));
}

// Calls write() and adds its failure to `lost`. The other files are still written, because the motion of a
// hand cannot be repeated.
void note_failure(std::string& lost, const std::function<void()>& write) {
  std::string why;
  try {
    write();
    return;
  } catch (const std::bad_alloc&) {
    why = "out of memory";
  } catch (const std::exception& error) {
    why = error.what();
  }
  lost += (lost.empty() ? "" : "; ") + why;
}

// Adds the reason to the attributes of a run that was refused. Removes the hashes of its inputs, because the
// run may not have read files with these hashes.
void add_refusal(TextAttributes& origin, const LiveResult& result) {
  std::erase_if(origin, [](const auto& attribute) { return attribute.first == "input_digests"; });
  origin.emplace_back("ended", result.ended);
}

// Prints where recording and trace are kept until the end. Called before the loop begins.
void print_files(const LiveRequest& request) {
  if (!request.record.empty())
    report_line("recording " + request.record + "; until the end it is " +
                journal_of(request.record).string() + ", which is kept if the program is interrupted");
  else if (!request.output.empty())
    report_line(
        request.output +
        " is only in memory until the end; use --record to keep the session if the program is interrupted");
}

int command_live(const CommandLine& line, const LiveRequest& request) {
  const std::string journal = request.record.empty() ? "" : journal_of(request.record).string();
  require_distinct({{"--record", request.record},
                    {"--record", journal},
                    {"--output", request.output},
                    {"--report", request.report}});
  const Experiment experiment = Experiment::load(request.experiment, request.overrides);
  std::vector<FileLock> locks;
  for (const std::string& file : {request.record, request.output, request.report})
    if (!file.empty()) locks.push_back(lock_output(line, file, inputs_of(request, experiment)));
  if (!request.record.empty()) require_no_journal_beside(request.record);
  LiveOptions options;
  options.device = device_of(request), options.depth = request.depth;
  options.duration_s = request.duration_s.value_or(0);
  options.record = request.record;
  options.kernels = line.kernels;
  options.stop = line.stop, options.report = line.report, options.rearm = line.rearm;
  const std::vector<InputPart> inputs = live_inputs(experiment, options.device, options.depth, request.view);
  const std::string digests = input_hashes(inputs);
  options.provenance = provenance(experiment.to_json(), normalised(request), line.kernels->isa, digests);
  options.check_inputs = [&] { require_unchanged(inputs, digests); };
  if (!line.quiet) options.report_line = report_line;
  options.on_report = [&](const LiveReport& report) {
    report_now(report, request.report, options.provenance);
  };
  const auto view = request.view ? open_view(line, request, experiment, options) : nullptr;
  RedirectPage redirect;
  options.on_start = [&] {
    if (view) redirect = show_address(*view, options.device);
    if (!line.quiet) print_files(request);
  };
  set_live_signals();
  print_replaced(request.overrides);
  const LiveResult result = run_live(experiment, options);
  if (view) view->end(result.ended);
  experiment.add_depth_device(options.provenance);
  add_report(options.provenance, result.report);
  if (!result.refused.empty()) add_refusal(options.provenance, result);

  std::printf("%s and %s: %s; ended: %s\n", result.device.c_str(), request.depth.c_str(),
              result.real_time.c_str(), result.ended.c_str());
  const LiveReport report = live_report(result.log, result.counts);
  if (result.force_scale < 1)
    std::printf(
        "    forces and torques were scaled by %.3g, so that no spring exceeds the maximum stiffness of the device\n",
        result.force_scale);
  std::fputs(text(report).c_str(), stdout);
  if (const std::string slave = slave_summary(result.log.trace); !slave.empty())
    std::printf("  %s\n", slave.c_str());
  std::fputs(text_of(result.report).c_str(), stdout);
  std::string lost = result.lost;
  note_failure(lost, [&] { print_trace(request, result.log, options.provenance); });
  note_failure(lost, [&] {
    if (!request.report.empty()) write_figure(request.report, live_figure(report), options.provenance);
  });
  // This is no InputError: after Ctrl-C the program would take that for the end of a wait, and not print it.
  if (lost.empty()) lost = result.refused;
  if (!lost.empty()) throw std::runtime_error(lost);
  if (request.strict) refuse_notes(result.report);
  return result.failed ? kCheckFailed : kDone;
}

template <class Entry>
void print_entry(const Entry& entry) {
  const Availability availability = entry.availability();
  std::printf("  %-28s %s\n  %-28s %s%s\n", entry.example, entry.summary, "",
              !availability.compiled_in || availability.found ? ""
              : availability.was_searched                     ? "not found: "
                                                              : "unknown: ",
              availability.detail.c_str());
}

std::string verdict(const FoundDepthDevice& device) {
  if (!device.trial.failure.empty()) return "cannot be used: " + device.trial.failure;
  const std::string times =
      formatted("320 x 240 pixels in %.1f ms, on the CPU in %.1f ms: %s", device.trial.device_ms,
                device.trial.cpu_ms, device.trial.device_ms < device.trial.cpu_ms ? "faster" : "not faster");
  return (device.inexact_because.empty() ? "the bits of the CPU; "
                                         : "only with exact = false: it " + device.inexact_because + "; ") +
         times;
}

void print_depth_devices(const Kernels& kernels) {
  std::puts("depth_pipeline.device: OpenCL devices");
  std::string why_none;
  for (const FoundDepthDevice& device : try_depth_devices(kernels, why_none))
    std::printf("  %-28s %s\n  %-28s %s\n", device.address.c_str(), device.name.c_str(), "",
                verdict(device).c_str());
  if (!why_none.empty()) std::printf("  none: %s\n", why_none.c_str());
}

// The report of `devices --report` has numbers and fixed words only: no text of a device, of a library or of
// an error, which may have a serial number, a path or a name.
constexpr const char* kDeviceReport = "{\n \"schema\": \"remote-touch-device-report/1\"";
constexpr double kHoldLimit_N = 1;

Json number_or_null(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

Json jitter_json(const CommandLine& line, double duration_s) {
  const double rate_hz = 1000;
  Jitter jitter = measure_jitter(duration_s, rate_hz, line.stop, steady_clock());
  std::sort(jitter.late_s.begin(), jitter.late_s.end());
  Json json = {{"rate_hz", rate_hz}, {"ticks", jitter.late_s.size()}, {"missed", jitter.missed}};
  for (const auto& [name, fraction] :
       {std::pair("late_p50_us", 0.5), {"late_p99_us", 0.99}, {"late_max_us", 1}})
    json[name] = number_or_null(1e6 * quantile(jitter.late_s, fraction));
  return json;
}

// Holds the device on the simulated table with the safety gate at 1 N.
Json hold_json(const CommandLine& line, const DevicesRequest& request) {
  const Experiment experiment =
      Experiment::load("fig4.16", {"safety.max_force_N=" + formatted("%g", kHoldLimit_N)});
  LiveOptions options;
  options.device = request.device, options.duration_s = request.duration_s;
  options.kernels = line.kernels, options.stop = line.stop, options.rearm = line.rearm;
  if (!line.quiet) options.report_line = report_line;
  set_live_signals();
  const LiveResult result = run_live(experiment, options);
  std::printf("ended: %s\n", result.ended.c_str());
  const LiveReport report = live_report(result.log, result.counts);
  Json times, counts;
  for (const LiveReport::Times& one : report.times)
    times[one.name] = {{"count", one.count},
                       {"p50_us", number_or_null(1e6 * quantile(one.sorted, 0.5))},
                       {"p99_us", number_or_null(1e6 * quantile(one.sorted, 0.99))},
                       {"max_us", number_or_null(1e6 * one.greatest)}};
  for (const LiveReport::Count& one : report.counts) counts[one.name] = number_or_null(one.value);
  return {{"gate_N", kHoldLimit_N},
          {"failed", result.failed || !result.refused.empty() || !result.lost.empty()},
          {"force_scale", result.force_scale},
          {"times", times},
          {"counts", counts}};
}

int write_device_report(const CommandLine& line, const DevicesRequest& request) {
  const DeviceEntry& entry = find_scheme(devices(), "--device", parse_uri("--device", request.device));
  require_report(line, request.report, {}, kDeviceReport);
  utsname system{};
  uname(&system);
  Json available;
  for (const DeviceEntry& one : devices()) available[one.scheme] = one.availability().found;
  std::printf("timing of the loop, %g s; then hold the handle for %g s: at most %g N\n", request.duration_s,
              request.duration_s, kHoldLimit_N);
  std::fflush(stdout);
  Json report = {{"schema", "remote-touch-device-report/1"},
                 {"version", version()},
                 {"instruction_set", line.kernels->isa},
                 {"system", std::string(system.sysname) + " " + system.release + " " + system.machine},
                 {"device", entry.scheme},
                 {"simulated", entry.scheme == std::string("sim")},
                 {"found", available},
                 {"duration_s", request.duration_s}};
  report["jitter"] = jitter_json(line, request.duration_s);
  report["hold"] = hold_json(line, request);
  write_file_atomically(request.report, report.dump(1) + "\n");
  std::printf("%s: read it, and send it if you like\n", printable(request.report).c_str());
  return report["hold"]["failed"] ? kCheckFailed : kDone;
}

int command_devices(const CommandLine& line, const DevicesRequest& request) {
  if (!request.report.empty()) return write_device_report(line, request);
  std::puts("--device: haptic devices");
  for (const DeviceEntry& entry : devices()) print_entry(entry);
  std::puts("--depth: depth sensors");
  for (const SensorEntry& entry : sensors()) print_entry(entry);
  print_depth_devices(*line.kernels);
  return kDone;
}

int command_jitter(const CommandLine& line, const JitterRequest& request) {
  Jitter jitter = measure_jitter(request.duration_s, request.rate_hz, line.stop, steady_clock());
  std::printf("%zu ticks at %g Hz: %s\n", jitter.late_s.size(), request.rate_hz, jitter.real_time.c_str());
  std::fputs(histogram(jitter.late_s).c_str(), stdout);
  std::sort(jitter.late_s.begin(), jitter.late_s.end());
  const auto us = [&](double fraction) { return 1e6 * quantile(jitter.late_s, fraction); };
  std::printf("  late by p50 %.1f, p99 %.1f, p99.9 %.1f, at most %.1f us; missed %lld\n", us(0.5), us(0.99),
              us(0.999), us(1), jitter.missed);
  return kDone;
}

}  // namespace

void add_live(Subcommands& commands) {
  auto [command, live] = commands.add(
      "live", "run an experiment in real time, with a depth sensor and a haptic device", command_live);
  command
      ->add_option("experiment", live->experiment,
                   "a name from `remote-touch list`, a JSON file, or a recorded live session")
      ->required();
  add_set(command, live->overrides, "parameter=value, for example safety.max_force_N=3");
  command->add_option(
      "--device", live->device,
      "haptic device, SCHEME:ADDRESS; see remote-touch devices (default: sim:, with --view browser:)");
  CLI::Option* const view =
      command->add_flag("--view", live->view, "show the run in a browser, where the mouse moves the hand");
  command->add_option("--view-port", live->view_port, "port of the page on 127.0.0.1; 0: any free port")
      ->check(CLI::Range(0, 65535))
      ->needs(view)
      ->capture_default_str();
  command->add_option("--depth", live->depth, "depth sensor, SCHEME:ADDRESS; see remote-touch devices")
      ->capture_default_str();
  command->add_option("--duration", live->duration_s, "duration in seconds (default: until SIGINT)")
      ->check(between(1e-3, 1e6));
  command->add_option(
      "--record", live->record,
      "record device and sensor to this HDF5 file; until the end the recording is FILE.unfinished");
  command->add_option("-o,--output", live->output, "the HDF5 file for the trace");
  command->add_flag("--strict", live->strict,
                    "a note on the session is an error: exit code 2, after everything is stored");
  command->add_option(
      "--report", live->report,
      "write timing and counts to this HDF5 file (a figure for scripts/plot); also on SIGUSR1");
}

void add_devices(Subcommands& commands) {
  auto [command, request] =
      commands.add("devices", "list sensors, haptic devices and OpenCL devices: what was found, or why not",
                   command_devices, kNoThreads);
  CLI::Option* const report = command->add_option(
      "--report", request->report,
      "measure timing and a hold with at most 1 N, and write this JSON file, which has nothing private");
  command->add_option("--device", request->device, "the haptic device of the report")
      ->needs(report)
      ->capture_default_str();
  command->add_option("--duration", request->duration_s, "seconds of each of both measurements")
      ->check(between(0.1, 600))
      ->needs(report)
      ->capture_default_str();
}

void add_jitter(Subcommands& commands) {
  auto [other, jitter] = commands.add("jitter", "measure the timing of the haptic loop on this machine",
                                      command_jitter, kNoThreads);
  other->add_option("--duration", jitter->duration_s, "duration in seconds")
      ->check(between(0.01, 86400.0))
      ->capture_default_str();
  other->add_option("--rate", jitter->rate_hz, "ticks per second")
      ->check(between(1.0, 100000.0))
      ->capture_default_str();
}

}  // namespace remote_touch
