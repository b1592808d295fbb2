#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>

#include "analysis/storage/result_file.h"
#include "analysis/trace/column.h"
#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "runners/sweep/stored_sweep.h"

namespace remote_touch {
namespace {

struct RunRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string output;
  bool timing = false;
  bool strict = false;
  bool all = false;  // prints all measures
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

}  // namespace

void add_run(Subcommands& commands) {
  auto [command, run] = commands.add("run", "run one experiment and store its trace", command_run);
  command
      ->add_option("experiment", run->experiment,
                   "a name from `remote-touch list`, a JSON file, or a recorded live session")
      ->required();
  add_set(command, run->overrides, "parameter=value, for example renderer.r1_m=0.004");
  command->add_option("-o,--output", run->output, "the HDF5 file to write")->required();
  command->add_flag("--timing", run->timing, "also store the duration of each tick");
  command->add_flag("--all", run->all, "print all measures, not only those that matter most for this run");
  command->add_flag("--strict", run->strict,
                    "a note on the run is an error: exit code 2, and nothing is written");
}

}  // namespace remote_touch
