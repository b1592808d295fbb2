#include <cstdio>

#include "analysis/measures.h"
#include "analysis/result_file.h"
#include "analysis/whole_file.h"
#include "runners/commands/commands.h"
#include "runners/commands/progress.h"
#include "runners/commands/shell_command.h"
#include "runners/experiment.h"
#include "runners/input_hashes.h"
#include "runners/provenance.h"
#include "runners/simulation.h"

namespace remote_touch {

namespace {

// What makes the result again: no output path, no verbosity.
std::string normalised(const RunRequest& request) {
  std::vector<std::string> words = {"remote-touch", "run", request.experiment};
  for (const std::string& assignment : request.overrides) words.insert(words.end(), {"--set", assignment});
  return shell_command(words);
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
  const TextAttributes origin = provenance(experiment.to_json(), normalised(request), line.kernels->isa,
                                           input_hashes(experiment.inputs()));
  const Trace trace = simulate(experiment, options);
  const std::string sum = write_trace(request.output, trace, origin, durations);
  std::printf("%s: %zu ticks, digest %s\n", request.output.c_str(), trace.length(), sum.c_str());
  for (const Measure& measure : measures())
    std::printf("  %-20s %12.6g %s\n", measure.name, measure.of(trace), measure.unit);
  return kDone;
}

}  // namespace remote_touch
