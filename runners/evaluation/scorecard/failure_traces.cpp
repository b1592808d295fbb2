#include "runners/evaluation/scorecard/failure_traces.h"

#include "analysis/storage/hdf5_reader.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {

namespace {

// Returns true if the file is the trace of this experiment, which an earlier call of the same build wrote.
// Another build or another failure has another source digest or configuration.
bool is_there(const std::filesystem::path& file, const Experiment& experiment, const StoredSweep& stored) {
  std::error_code unreachable;
  if (!std::filesystem::is_regular_file(file, unreachable)) return false;
  try {
    const Hdf5Reader reader(file);
    const TextAttributes& attributes = reader.attributes();
    return attribute(attributes, "config") == experiment.to_json() &&
           attribute(attributes, "source_digest") == attribute(stored.attributes, "source_digest");
  } catch (const InputError&) {
    return false;  // a damaged file is replaced
  }
}

}  // namespace

std::optional<FailureTrace> trace_failure(const BenchmarkSweep& sweep, const StoredSweep& stored,
                                          const std::vector<Bound>& success,
                                          const std::filesystem::path& folder, const Kernels& kernels,
                                          const std::atomic<bool>* stop) {
  const SweepResult& result = stored.result;
  for (std::size_t level = 0; level < result.cell_count(); ++level) {
    const long found = typical_failure(result, success, level);
    if (found < 0) continue;
    const auto run = static_cast<std::size_t>(found);
    if (result.state[run] == RunState::failed)
      return FailureTrace{level, result.replicate_of(run), {}, {}, result.error[run]};
    FailureTrace failure{level, result.replicate_of(run), "traces/" + sweep.name + ".h5", {}};
    failure.command = program_text() + " replay runs/" + sweep.name + ".h5 " + option_of_run(result, run) +
                      " -o " + failure.file;
    const std::filesystem::path file = folder / failure.file;
    SimulationOptions options;
    options.kernels = &kernels, options.stop = stop;
    if (!is_there(file, sweep.sweep.experiment(level, failure.replicate), stored))
      replay_run(stored, sweep.sweep, run, options, file);
    return failure;
  }
  return {};
}

}  // namespace remote_touch
