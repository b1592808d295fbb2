#include "runners/sweep/sweep_replay.h"

#include "analysis/figures/result_file.h"
#include "analysis/storage/digest.h"
#include "core/kernels/isa.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/sweep/cell_text.h"
#include "runners/sweep/sweep_notes.h"

namespace remote_touch {

namespace {

// Returns the provenance of the replayed run: from the recipe of its sweep or, if that has none, from the
// text of its command.
TextAttributes origin(const StoredSweep& stored, std::size_t cell, const Replay& replay, int replicate,
                      const std::string& isa, const std::string& inputs) {
  const std::string config = replay.experiment.to_json();
  if (std::optional<Recipe> recipe = recipe_of(stored.attributes)) {
    recipe->action = "replay";
    recipe->cell = stored.result.axis_indices(cell), recipe->replicate = replicate;
    return provenance(config, *recipe, isa, inputs);
  }
  const std::string command = attribute(stored.attributes, "command") + "; " + program_text() +
                              " replay --cell " + cell_text(stored.result, cell) + " --replicate " +
                              std::to_string(replicate);
  return provenance(config, command, isa, inputs);
}

}  // namespace

Replay replay_run(const StoredSweep& stored, const Sweep& sweep, std::size_t run, SimulationOptions options,
                  const std::filesystem::path& output, Strict strict) {
  const std::size_t cell = stored.result.cell_of(run);
  const int replicate = stored.result.replicate_of(run);
  Replay replay{sweep.experiment(cell, replicate), {}, {}, {}, {}};
  options.hash_frames = true;
  options.find_true_contact = sweep.needs_true_contact();
  const std::string inputs = input_hashes(replay.experiment.inputs());
  options.report = &replay.report;
  replay.trace = simulate(replay.experiment, options);
  require_unchanged(replay.experiment.inputs(), inputs);
  add_unknown_outcome(sweep.measures(), replay.trace, replay.report.notes);
  if (strict == Strict::yes) refuse_notes(replay.report);
  const std::string isa = (options.kernels ? *options.kernels : kernels_for(best_isa())).isa;
  replay.attributes = origin(stored, cell, replay, replicate, isa, inputs);
  replay.experiment.add_depth_device(replay.attributes);
  add_report(replay.attributes, replay.report);
  const std::vector<Column> columns = replay.trace.columns();
  replay.digest = output.empty() ? digest(columns) : write_trace(output, columns, replay.attributes, {});
  return replay;
}

}  // namespace remote_touch
