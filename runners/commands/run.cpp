#include <cstdio>

#include "analysis/measures.h"
#include "analysis/result_file.h"
#include "analysis/whole_file.h"
#include "runners/commands/commands.h"
#include "runners/commands/progress.h"
#include "runners/experiment.h"
#include "runners/provenance.h"
#include "runners/simulation.h"

namespace remote_touch {

namespace {

// What makes the result again: no output path, no verbosity.
std::string normalised(const RunRequest& request) {
  std::string command = "remote-touch run " + request.experiment;
  for (const std::string& assignment : request.overrides) command += " --set " + assignment;
  return command;
}

}  // namespace

int command_run(const CommandLine& line, const RunRequest& request) {
  const Experiment experiment = Experiment::load(request.experiment, request.overrides);
  require_writable(request.output);
  Progress progress(request.experiment, line.quiet);
  std::vector<double> durations;
  SimulationOptions options;
  options.kernels = line.kernels;
  options.stop = line.stop;
  options.hash_frames = true;
  options.progress = [&](double share) { progress.update(share); };
  if (request.timing) options.step_duration_s = &durations;
  const Trace trace = simulate(experiment, options);
  const std::string sum =
      write_trace(request.output, trace,
                  provenance(experiment.to_json(), normalised(request), line.kernels->isa), durations);
  std::printf("%s: %zu ticks, digest %s\n", request.output.c_str(), trace.length(), sum.c_str());
  for (const Measure& measure : measures())
    std::printf("  %-20s %12.6g %s\n", measure.name, measure.of(trace), measure.unit);
  return kDone;
}

}  // namespace remote_touch
