// The commands that run an experiment: `run`, and `baseline`, which compares it with a stored result.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "runners/evaluation/regression/baselines.h"
#include "runners/evaluation/regression/result_comparison.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/work_pool.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

struct RunRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string output;
  bool timing = false;
  bool strict = false;
  bool all = false;  // prints all measures
  int threads = 0;   // 0: as OpenMP decides
};

// The log of a task: a line for every step.
void print_sequence(const std::vector<SequenceStep>& steps, const std::vector<SequenceEntry>& log) {
  for (std::size_t i = 0; i < steps.size(); ++i) {
    std::printf("  sequence.%zu %s: ", i, name_of(steps[i]).c_str());
    if (i >= log.size()) {
      std::puts("has not begun");
      continue;
    }
    const SequenceEntry& entry = log[i];
    std::printf("began at %.3f s", entry.began_s);
    if (std::isnan(entry.ended_s))
      std::printf(", has not ended");
    else
      std::printf(", %s at %.3f s", entry.missed ? "missed" : "done", entry.ended_s);
    if (steps[i].end == StepEnd::reached && !std::isnan(entry.distance_m))
      std::printf(", %.2g m and %.2g deg from the goal", entry.distance_m,
                  entry.angle_rad / kRadiansPerDegree);
    std::puts("");
  }
}

// Prints a line for each measure: value, unit, meaning.
void print_measures(const Experiment& experiment, const Trace& trace, bool print_all) {
  const std::vector<MeasuredValue> all = measured_values(measures(), trace);
  const Fixtures fixtures = experiment.build_fixtures().empty() ? Fixtures::none : Fixtures::some;
  const std::vector<MeasuredValue> printed = print_all ? all : main_measures(all, fixtures);
  for (const auto& [measure, value] : printed)
    std::printf("  %-23s %12.6g %-13s  %s\n", measure->name.c_str(), value,
                unit_in_words(measure->unit).c_str(), measure->meaning.c_str());
  if (printed.size() < all.size()) std::printf("  (%zu more with --all)\n", all.size() - printed.size());
}

int command_run(const CommandLine& line, const RunRequest& request) {
  require_own_kind(request.experiment, "run");
  const Experiment experiment = Experiment::load(request.experiment, request.overrides);
  const FileLock lock =
      lock_output(line, request.output, with_parts(request.experiment, experiment.inputs()));
  Progress progress(request.experiment, line.quiet);
  std::vector<double> durations;
  SimulationOptions options;
  options.kernels = line.kernels;
  options.stop = line.stop;
  options.hash_frames = true;
  options.find_true_contact = true;
  options.progress = [&](double fraction) { progress.update(fraction); };
  RunReport report;
  options.report = &report;
  if (request.timing) options.step_duration_s = &durations;
  const std::string inputs = input_hashes(experiment.inputs());
  TextAttributes origin = provenance(
      experiment.to_json(), Recipe{"run", request.experiment, request.overrides}, line.kernels->isa, inputs);
  const Trace trace = simulate(experiment, options);
  require_unchanged(experiment.inputs(), inputs);
  add_unknown_outcome(measures(), trace, report.notes);
  if (request.strict) refuse_notes(report);
  experiment.add_depth_device(origin);
  add_report(origin, report);
  const std::string trace_digest = write_trace(request.output, trace, origin, durations);
  print_replaced(request.overrides);
  std::printf("%s: %zu ticks, digest %s\n", printable(request.output).c_str(), trace.length(),
              trace_digest.c_str());
  std::fputs(text_of(report).c_str(), stdout);
  print_measures(experiment, trace, request.all);
  print_sequence(experiment.sequence(), sequence_log(trace));
  return kDone;
}

struct BaselineCheckRequest {
  std::vector<std::string> names;  // empty: all, and none may be missing
  std::string folder = "data/baselines";
  std::string json, junit;
};

struct BaselineBlessRequest {
  std::vector<std::string> names;
  std::string reason;
  std::string folder = "data/baselines";
  std::string run, sweep;
  std::vector<std::string> overrides, also;
  bool one_compiler = false;
};

using State = BaselineCheck::State;

std::vector<Baseline> chosen(const Manifest& manifest, const BaselineCheckRequest& request) {
  std::vector<Baseline> list;
  for (const std::string& name : request.names) {
    const Baseline* baseline = manifest.find(name);
    if (!baseline)
      throw InputError("baseline " + name, "does not exist in " + request.folder + "/manifest.json");
    list.push_back(*baseline);
  }
  return request.names.empty() ? manifest.baselines : list;
}

// The files that a check reads. No report may replace them.
std::vector<std::string> files_of(const std::string& folder, const std::vector<Baseline>& list) {
  std::vector<std::string> files{manifest_file(folder).string()};
  for (const Baseline& baseline : list) {
    files.push_back(file_of(folder, baseline).string());
    files.push_back(subject_of(folder, baseline));
  }
  return files;
}

void print(const BaselineCheck& check) {
  constexpr const char* kWords[] = {"same", "CHANGED", "MISSING", "COULD NOT COMPARE", "not run"};
  std::printf("%-18s %-24s %s\n", kWords[static_cast<int>(check.state)], check.name.c_str(),
              check.text.c_str());
  if (check.comparison && check.state != State::same)
    std::fputs(report_of(*check.comparison).text().c_str(), stdout);
}

// "66 baselines: 63 same, 1 changed, 1 could not be compared, 1 not run; 0 missing"
void print_summary(const std::vector<BaselineCheck>& checks) {
  const auto count = [&](State state) {
    return std::count_if(checks.begin(), checks.end(),
                         [&](const auto& check) { return check.state == state; });
  };
  const auto missing = count(State::missing);
  std::printf("%td baselines: %td same, %td changed, %td could not be compared, %td not run; %td missing\n",
              static_cast<std::ptrdiff_t>(checks.size()) - missing, count(State::same), count(State::changed),
              count(State::not_comparable), count(State::not_run), missing);
}

ReportSuite suite_of(const std::vector<BaselineCheck>& checks) {
  using Case = ReportCase::State;
  constexpr Case kStates[] = {Case::passed, Case::failed, Case::failed, Case::error, Case::skipped};
  ReportSuite suite{"baselines"};
  for (const BaselineCheck& check : checks)
    suite.cases.push_back({check.name, kStates[static_cast<int>(check.state)], check.text});
  return suite;
}

// Returns the report of each check. A check without a comparison has one with its verdict and without
// columns.
std::string json_of(const std::vector<BaselineCheck>& checks) {
  std::vector<Report> reports;
  for (const BaselineCheck& check : checks) {
    ResultComparison none{"", "this program", check.state == State::not_run ? "not run" : "none"};
    none.verdict = check.text;
    if (check.state == State::missing) none.outcome = Outcome::changed;
    reports.push_back(report_of(check.comparison.value_or(none)));
    reports.back().tell("baseline", check.name);
  }
  return remote_touch::json_of(reports);
}

int exit_code(const std::vector<BaselineCheck>& checks) {
  const auto any = [&](State state) {
    return std::any_of(checks.begin(), checks.end(), [&](const auto& check) { return check.state == state; });
  };
  const bool any_failed = any(State::changed) || any(State::missing);
  if (!any(State::same) && !any_failed) return kBadInput;  // no baseline was compared
  return any(State::not_comparable) ? kBadInput : any_failed ? kCheckFailed : kDone;
}

int command_baseline_check(const CommandLine& line, const BaselineCheckRequest& request) {
  require_distinct({{"--json", request.json}, {"--junit", request.junit}});
  const Manifest manifest = read_manifest(request.folder);
  const std::vector<std::string> inputs = files_of(request.folder, manifest.baselines);
  if (!request.json.empty()) require_report(line, request.json, inputs, kJsonReports);
  if (!request.junit.empty()) require_report(line, request.junit, inputs, kJunitReport);
  const std::vector<Baseline> list = chosen(manifest, request);
  std::vector<BaselineCheck> checks;
  NoteCounts notes;
  Progress progress("baselines", line.quiet);
  for (const Baseline& baseline : list) {
    progress.update(checks.size(), list.size(), 0, "baselines");
    checks.push_back(check_baseline(request.folder, baseline, *line.kernels, line.stop, &notes));
    print(checks.back());
  }
  progress.clear();
  std::vector<BaselineCheck> missing;
  if (request.names.empty()) missing = missing_baselines(request.folder, manifest);
  for (const BaselineCheck& check : missing) print(check);
  checks.insert(checks.end(), missing.begin(), missing.end());
  if (checks.empty()) throw InputError(request.folder, "holds no baselines: expected a folder with some");
  for (const std::string& note : notes.lines()) std::printf("note: %s\n", note.c_str());
  print_summary(checks);
  if (!request.json.empty()) write_file_atomically(request.json, json_of(checks));
  if (!request.junit.empty()) write_file_atomically(request.junit, junit({suite_of(checks)}));
  return exit_code(checks);
}

int command_baseline_bless(const CommandLine& line, const BaselineBlessRequest& request) {
  std::vector<std::string> names = request.names;
  const bool all = names == std::vector<std::string>{"all"};
  if ((all || names.size() > 1) && !(request.run.empty() && request.sweep.empty()))
    throw InputError("--run, --sweep", "expected with one name only");
  if (all) {
    names.clear();
    for (const Baseline& baseline : read_manifest(request.folder).baselines) names.push_back(baseline.name);
    if (names.empty()) throw InputError(request.folder, "holds no baselines: expected a folder with some");
  }
  for (const std::string& name : names) {
    const std::string done = bless({request.folder, name, request.reason, request.run, request.sweep,
                                    request.overrides, request.also, request.one_compiler, line.stop});
    std::printf("%s\n", done.c_str());
    std::fflush(stdout);
  }
  print_replaced(request.overrides);
  return kDone;
}

}  // namespace

void add_run(Subcommands& commands) {
  auto [command, run] = commands.add("run", "run one experiment and store its trace", command_run);
  command
      ->add_option("experiment", run->experiment,
                   "a name from `remote-touch list`, a JSON file, or a recorded live session")
      ->required();
  add_set(command, run->overrides, "parameter=value, for example renderer.r1_m=0.004");
  command->add_option("-o,--output", run->output, "the HDF5 file to write")->required();
  command->add_option("--threads", run->threads, "number of threads (default: OMP_NUM_THREADS, or all)")
      ->check(CLI::Range(1, kMaxThreads));
  command->add_flag("--timing", run->timing, "also store the duration of each tick");
  command->add_flag("--all", run->all, "print all measures, not only those that matter most for this run");
  command->add_flag("--strict", run->strict,
                    "a note on the run is an error: exit code 2, and nothing is written");
}

void add_baseline(Subcommands& commands) {
  CLI::App* parent = commands.app.add_subcommand(
      "baseline", "check or store baselines: stored results that later versions are compared with");
  parent->require_subcommand(1);
  Subcommands below{*parent, commands.line, commands.act, commands.threads};
  auto [command, check] = below.add(
      "check",
      "compute every stored result again and compare; exit code 0: all the same, 1: some changed (better or "
      "worse), 2: some could not be compared",
      command_baseline_check);
  command->add_option("names", check->names, "names of baselines (default: all; none may be missing)");
  command->add_option("--folder", check->folder, "folder of the baselines")->capture_default_str();
  command->add_option("--json", check->json, "also write the complete report to this JSON file");
  command->add_option("--junit", check->junit, "also write a report in JUnit's XML format");

  auto [other, bless] =
      below.add("bless", "store a result as a baseline, with its spread over builds", command_baseline_bless);
  other->add_option("names", bless->names, "names of baselines, or all")->required();
  other->add_option("--reason", bless->reason, "why the new numbers are correct");
  other->add_option("--run", bless->run,
                    "for a new baseline: its experiment, a name or a JSON file in the folder");
  other->add_option("--sweep", bless->sweep, "for a new baseline: its sweep");
  add_set(other, bless->overrides, "for a new baseline: parameter=value");
  other->add_option("--other-build", bless->also, "a build of the same source by another compiler")
      ->allow_extra_args(false);
  other->add_flag("--one-compiler", bless->one_compiler, "measure the spread with this compiler only");
  other->add_option("--folder", bless->folder, "folder of the baselines")->capture_default_str();
}

}  // namespace remote_touch
