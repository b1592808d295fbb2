#include "runners/sweep/sweep_run.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <new>

#include "analysis/storage/digest.h"
#include "analysis/storage/result_file.h"
#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/run_notes.h"
#include "runners/sweep/stored_sweep.h"
#include "runners/sweep/sweep.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxError = 300;  // every run has room for the longest

// Returns the message in one line of UTF-8, cut between characters where there is no room for more.
std::string stored_error(const std::exception& error) {
  const std::string text = printable(error.what());
  std::size_t end = std::min(text.size(), kMaxError);
  while (end > 0 && end < text.size() && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return text.substr(0, end);
}

// Throws InputError if the experiment of a run reads a recording that no checked cell reads, so that no run
// has an input that the result does not name.
void require_known_inputs(const Sweep& sweep, const Experiment& experiment) {
  for (const InputPart& part : experiment.inputs())
    if (std::find(sweep.inputs().begin(), sweep.inputs().end(), part) == sweep.inputs().end())
      throw InputError(part.path, "is read by a cell that was not checked: expected at most " +
                                      std::to_string(kMaxChecked) + " cells, or recordings along one axis");
}

// Does the run at a place and writes its values, or its error, into its own elements of the result.
void do_run_at(const Sweep& sweep, const SweepRunOptions& options, std::size_t place, SweepResult& result) {
  const std::size_t run = result.run_at(place);
  RunOutcome outcome = do_run(sweep, options, result.cell_of(run), result.replicate_of(run));
  for (std::size_t i = 0; i < outcome.values.size(); ++i)
    std::get<std::vector<double>>(result.measures[i].values)[place] = outcome.values[i];
  result.notes[place] = outcome.notes;
  result.state[place] = outcome.state;
  result.error[place] = std::move(outcome.error);
}

}  // namespace

RunOutcome do_run(const Sweep& sweep, const SweepRunOptions& options, std::size_t cell, int replicate) {
  RunOutcome outcome;
  try {
    SimulationOptions simulation;
    simulation.kernels = options.kernels;
    simulation.stop = options.stop;
    simulation.find_true_contact = sweep.needs_true_contact();
    RunReport report;
    simulation.report = &report;
    const Experiment experiment = sweep.experiment(cell, replicate);
    require_known_inputs(sweep, experiment);
    const Trace trace = simulate(experiment, simulation);
    for (const Measure& measure : sweep.measures()) outcome.values.push_back(value_of(measure, trace));
    add_unknown_outcome(sweep.measures(), trace, report.notes);
    outcome.notes = note_bits(report.notes);
    outcome.state = RunState::done;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    outcome = {RunState::failed, {}, 0, stored_error(error)};
  }
  return outcome;
}

std::size_t do_pending_runs(const Sweep& sweep, SweepResult& result, const SweepRunOptions& options) {
  const std::vector<std::size_t> places = result.runs_in(RunState::pending);
  std::exception_ptr failure;
  std::mutex one_at_a_time;
  std::atomic<bool> ends{false};
  std::atomic<std::size_t> without_memory{0};
  options.runs(places.size(), [&](std::size_t i) {
    if (ends) return;
    try {
      do_run_at(sweep, options, places[i], result);
      const std::lock_guard lock(one_at_a_time);
      if (options.finished) options.finished(places[i]);
    } catch (const std::bad_alloc&) {
      ++without_memory;
    } catch (...) {
      const std::lock_guard lock(one_at_a_time);
      if (!ends.exchange(true)) failure = std::current_exception();
    }
  });
  if (failure) std::rethrow_exception(failure);
  return without_memory;
}

bool add_round(const Sweep& sweep, SweepResult& result) {
  const auto rule = sweep.refinement();
  if (!rule) return false;
  const std::int32_t round = *std::max_element(result.round.begin(), result.round.end()) + 1;
  const std::vector<std::size_t> runs = next_round(result, *rule);
  for (const std::size_t run : runs) result.state[run] = RunState::pending, result.round[run] = round;
  return !runs.empty();
}

SweepResult run_sweep(const Sweep& sweep, const SweepRunOptions& options) {
  SweepResult result = sweep.plan();
  do {
    if (do_pending_runs(sweep, result, options) > 0) throw std::bad_alloc();
  } while (add_round(sweep, result));
  return result;
}

namespace {

// Returns the provenance of the replayed run: from the recipe of its sweep or, if that has none, from the
// text of its command.
TextAttributes origin(const TextAttributes& of_sweep, const SweepGrid& grid, std::size_t run,
                      const Replay& replay, const std::string& isa, const std::string& inputs) {
  const std::size_t cell = grid.cell_of(run);
  const int replicate = grid.replicate_of(run);
  const std::string config = replay.experiment.to_json();
  if (std::optional<Recipe> recipe = recipe_of(of_sweep)) {
    recipe->action = "replay";
    recipe->cell = grid.axis_indices(cell), recipe->replicate = replicate;
    return provenance(config, *recipe, isa, inputs);
  }
  const std::string command = attribute(of_sweep, "command") + "; " + program_text() + " replay --cell " +
                              cell_text(grid, cell) + " --replicate " + std::to_string(replicate);
  return provenance(config, command, isa, inputs);
}

}  // namespace

Replay replay_run(const TextAttributes& attributes, const Sweep& sweep, std::size_t run,
                  SimulationOptions options, const std::filesystem::path& output, Strict strict) {
  const SweepGrid grid = sweep.outline();
  Replay replay{sweep.experiment(grid.cell_of(run), grid.replicate_of(run)), {}, {}, {}, {}};
  options.hash_frames = true;
  options.find_true_contact = sweep.needs_true_contact();
  const std::string inputs = input_hashes(replay.experiment.inputs());
  options.report = &replay.report;
  replay.trace = simulate(replay.experiment, options);
  require_unchanged(replay.experiment.inputs(), inputs);
  add_unknown_outcome(sweep.measures(), replay.trace, replay.report.notes);
  if (strict == Strict::yes) refuse_notes(replay.report);
  const std::string isa = (options.kernels ? *options.kernels : kernels_for(best_isa())).isa;
  replay.attributes = origin(attributes, grid, run, replay, isa, inputs);
  replay.experiment.add_depth_device(replay.attributes);
  add_report(replay.attributes, replay.report);
  const std::vector<Column> columns = replay.trace.columns();
  replay.digest = output.empty() ? digest(columns) : write_trace(output, columns, replay.attributes, {});
  return replay;
}

}  // namespace remote_touch
