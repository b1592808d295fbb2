#include "runners/sweep/sweep_replay.h"

#include "analysis/figures/result_file.h"
#include "core/kernels/isa.h"
#include "runners/provenance/input_hashes.h"
#include "runners/provenance/provenance.h"

namespace remote_touch {

std::string cell_text(const SweepResult& result, std::size_t cell) {
  std::string text;
  for (const std::size_t place : result.place(cell))
    text.append(text.empty() ? "" : ",").append(std::to_string(place));
  return text;
}

Replay replay_run(const StoredSweep& stored, const Sweep& sweep, std::size_t run, SimulationOptions options,
                  const std::filesystem::path& output) {
  const std::size_t cell = stored.result.cell_of(run);
  const int replicate = stored.result.replicate_of(run);
  Replay replay{sweep.experiment(cell, replicate), {}, {}};
  options.hash_frames = true;
  const std::string inputs = input_hashes(replay.experiment.inputs());
  replay.trace = simulate(replay.experiment, options);
  const std::string command = attribute(stored.attributes, "command") + "; remote-touch replay --cell " +
                              cell_text(stored.result, cell) + " --replicate " + std::to_string(replicate);
  const std::string isa = (options.kernels ? *options.kernels : kernels_for(best_isa())).isa;
  replay.digest =
      write_trace(output, replay.trace, provenance(replay.experiment.to_json(), command, isa, inputs), {});
  return replay;
}

}  // namespace remote_touch
