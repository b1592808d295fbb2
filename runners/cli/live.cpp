#include "runners/live/loop/live_run.h"

#include <csignal>
#include <cstdio>
#include <exception>

#include "analysis/figures/result_file.h"
#include "analysis/storage/digest.h"
#include "core/parameters/input_error.h"
#include "runners/cli/commands.h"
#include "runners/cli/outputs.h"
#include "runners/provenance/input_hashes.h"
#include "runners/provenance/provenance.h"
#include "runners/provenance/shell_command.h"

namespace remote_touch {

namespace {

std::string normalised(const LiveRequest& request) {
  std::vector<std::string> words = {"remote-touch", "live",    request.experiment, "--device",
                                    request.device, "--depth", request.depth};
  for (const std::string& assignment : request.overrides) words.insert(words.end(), {"--set", assignment});
  return shell_command(words);
}

void report_line(const std::string& text) {
  std::fprintf(stderr, "live: %s%s", text.c_str(), text.ends_with('\n') ? "" : "\n");
}

// A haptic device must be let go whatever ends the program, and a program that is halted holds on to it.
void see_to_every_end() {
  struct sigaction interrupt {};
  sigaction(SIGINT, nullptr, &interrupt);
  sigaction(SIGQUIT, &interrupt, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGTSTP, SIG_IGN);
}

// While it runs: a file that cannot be written does not end it.
void report_now(const LiveReport& report, const std::string& file, const TextAttributes& origin) try {
  report_line("so far\n" + text(report));
  if (!file.empty()) write_figure(file, live_figure(report), origin);
} catch (const std::exception& error) {
  report_line(error.what());
}

// Writes it, if it is wanted, and tells its digest, which that of the recording is.
void print_trace(const LiveRequest& request, const LiveLog& log, const TextAttributes& origin) {
  const std::string sum = request.output.empty()
                              ? digest(log.trace.columns())
                              : write_trace(request.output, log.trace, origin, log.row_step_s);
  if (log.is_whole())
    std::printf("  digest of the trace: %s\n", sum.c_str());
  else
    std::printf("  only the first %zu of %lld ticks were kept as a trace; --record keeps all of them\n",
                log.trace.length(), static_cast<long long>(log.ticks));
}

}  // namespace

int command_live(const CommandLine& line, const LiveRequest& request) {
  const Experiment experiment = Experiment::load(request.experiment, request.overrides);
  std::vector<FileLock> locks;
  for (const std::string& file : {request.record, request.output, request.report})
    if (!file.empty())
      locks.push_back(lock_output(line, file, with_parts(request.experiment, experiment.inputs())));
  LiveOptions options;
  options.device = request.device, options.depth = request.depth;
  options.duration_s = request.duration_s.value_or(0);
  options.record = request.record;
  options.kernels = line.kernels;
  options.stop = line.stop, options.report = line.report, options.rearm = line.rearm;
  options.provenance = provenance(experiment.to_json(), normalised(request), line.kernels->isa,
                                  input_hashes(experiment.inputs()));
  if (!line.quiet) options.report_line = report_line;
  options.on_report = [&](const LiveReport& report) {
    report_now(report, request.report, options.provenance);
  };
  see_to_every_end();
  const LiveResult result = run_live(experiment, options);

  std::printf("%s and %s: %s; ended because %s\n", result.device.c_str(), request.depth.c_str(),
              result.real_time.c_str(), result.ended.c_str());
  const LiveReport report = live_report(result.log, result.counts);
  if (result.force_scale < 1)
    std::printf(
        "    forces and torques were scaled by %.3g, so that no spring exceeds the maximum stiffness of the device\n",
        result.force_scale);
  std::fputs(text(report).c_str(), stdout);
  if (!request.report.empty()) write_figure(request.report, live_figure(report), options.provenance);
  print_trace(request, result.log, options.provenance);
  if (!result.lost.empty()) throw InputError(result.lost);
  return result.failed ? kCheckFailed : kDone;
}

}  // namespace remote_touch
