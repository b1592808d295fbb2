#include "runners/sweep/sweep_session.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "analysis/storage/atomic_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_origin.h"

namespace remote_touch {

namespace {

// Throws InputError if a finished run has read a recording that has changed since: its values belong to
// another recording.
void require_same_inputs(const std::filesystem::path& file, const Sweep& sweep, const SweepResult& result,
                         const std::vector<ChangedInput>& changed) {
  if (changed.empty()) return;
  for (const std::size_t place : result.runs_in(RunState::done))
    for (const RecordingPart& part : sweep.experiment(result.cell_of(result.run_at(place)), 0).inputs())
      for (const ChangedInput& input : changed)
        if (input.path == in_one_line(part.path))
          throw InputError(file.string(), "has runs on another recording " + input.path + " (" +
                                              input.before + "; now " + input.now +
                                              "): expected the same recording, or a new file");
}

void set_attribute(TextAttributes& attributes, const std::string& name, const std::string& value) {
  std::erase_if(attributes, [&](const auto& each) { return each.first == name; });
  if (!value.empty()) attributes.emplace_back(name, value);
}

// Copies the values, states, rounds, errors and notes of the runs of the earlier call. Everything else is
// known already.
void take_over(SweepResult&& earlier, const std::filesystem::path& file, SweepResult& result) {
  if (earlier.run_count() != result.run_count() || earlier.part != result.part ||
      earlier.measures.size() != result.measures.size() || earlier.round.size() != result.round.size() ||
      earlier.note_kinds != result.note_kinds)
    throw InputError(file.string(), "damaged (its arrays do not fit its configuration): expected a new file");
  for (std::size_t i = 0; i < result.measures.size(); ++i)
    result.measures[i].values = std::move(earlier.measures[i].values);
  result.state = std::move(earlier.state);
  result.round = std::move(earlier.round);
  result.error = std::move(earlier.error);
  result.notes = std::move(earlier.notes);
}

}  // namespace

SweepPlan plan_in_file(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
                       const std::filesystem::path& file) {
  SweepPlan plan{sweep.plan(shard), attributes};
  std::error_code unreachable;
  const auto there = std::filesystem::status(file, unreachable);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there) &&
      !std::filesystem::is_directory(there))
    throw InputError(file.string(),
                     "a pipe or a device: expected a file, because a sweep stores each run when it is done");
  if (!std::filesystem::is_regular_file(there)) return plan;
  StoredSweep stored = read_sweep(file);
  require_same_sweep(file, stored.schema, stored.attributes, attributes);
  take_over(without_others(std::move(stored.result)), file, plan.result);
  const std::string inputs = attribute(attributes, "input_digests");
  const auto changed = changed_inputs(attribute(stored.attributes, "input_digests"), inputs);
  require_same_inputs(file, sweep, plan.result, changed);
  const auto failed = plan.result.runs_in(RunState::failed);
  for (const std::size_t place : failed)
    plan.result.state[place] = RunState::pending, plan.result.error[place].clear();
  plan.attributes = std::move(stored.attributes);
  set_attribute(plan.attributes, "input_digests", inputs);
  const bool is_same = failed.empty() && changed.empty();
  plan.in_progress = stored.in_progress && is_same;
  plan.is_finished = !stored.in_progress && is_same;
  plan.is_there = true;
  return plan;
}

SweepSession::SweepSession(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
                           const std::filesystem::path& file)
    : sweep_(sweep),
      shard_(shard),
      file_(resolved(file)),
      lock_(file_),
      plan_(plan_in_file(sweep, shard, attributes, file_)) {}

// Shards do only the first round. Refinement needs the runs of all shards, so it begins on the merged file.
bool SweepSession::add_round_if_whole() {
  if (shard_.count > 1 || !add_round(sweep_, plan_.result)) return false;
  plan_.in_progress = false;  // the file does not have the new round yet
  return true;
}

bool SweepSession::run(const Kernels& kernels, const std::atomic<bool>* stop, const Progress& progress) {
  const DoRuns here = [&](SweepResult& result, const std::function<void(std::size_t)>& stored) {
    return do_pending_runs(sweep_, result, {&kernels, stop, stored});
  };
  return run(here, progress);
}

bool SweepSession::run(const DoRuns& do_runs, const Progress& progress) {
  const SweepResult before = plan_.result;
  bool is_finished = plan_.is_finished;
  try {
    while (!plan_.result.runs_in(RunState::pending).empty() || add_round_if_whole()) {
      is_finished = false;
      do_round(do_runs, progress);
    }
  } catch (...) {  // finished runs are in the file, whatever ended this call
    require_unchanged_inputs(before);
    throw;
  }
  if (is_finished) return false;
  require_unchanged_inputs(before);
  write_sweep(file_, plan_.result, plan_.attributes);
  return true;
}

// Throws InputError if a recording has changed. All runs of this call are then pending again, because it is
// not known which of them have read a recording before it changed.
void SweepSession::require_unchanged_inputs(const SweepResult& before) {
  const std::string inputs = attribute(plan_.attributes, "input_digests");
  if (inputs.empty()) return;
  try {
    require_unchanged(sweep_.inputs(), inputs);
  } catch (const InputError&) {
    plan_.result = before;
    write_sweep_in_progress(file_, plan_.result, plan_.attributes);
    throw;
  }
}

void SweepSession::forget(const std::vector<std::size_t>& places) {
  SweepResult& result = plan_.result;
  const bool is_refined = !result.round.empty();
  std::int32_t first_round = std::numeric_limits<std::int32_t>::max();
  const auto reset = [&](std::size_t place, RunState state) {
    for (Column& measure : result.measures)
      std::get<std::vector<double>>(measure.values)[place] = std::numeric_limits<double>::quiet_NaN();
    result.state[place] = state, result.notes[place] = 0, result.error[place].clear();
    if (state == RunState::not_sampled) result.round[place] = -1;
  };
  for (const std::size_t place : places) {
    reset(place, RunState::pending);
    if (is_refined) first_round = std::min(first_round, result.round[place]);
  }
  for (std::size_t place = 0; place < result.round.size(); ++place)
    if (result.round[place] > first_round) reset(place, RunState::not_sampled);
  write_sweep_in_progress(file_, result, plan_.attributes);
}

void SweepSession::do_round(const DoRuns& do_runs, const Progress& progress) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::seconds kBetweenFlushes{1};
  SweepInProgress storage(file_, plan_.result, plan_.attributes, plan_.in_progress);
  plan_.in_progress = true;
  const std::size_t earlier = plan_.result.runs_in(RunState::done).size();
  const std::size_t total = earlier + plan_.result.runs_in(RunState::pending).size();
  std::size_t done = earlier;
  auto flushed = Clock::now();
  const auto finished = [&](std::size_t place) {
    storage.record(plan_.result, place);
    progress(++done, total, earlier);
    if (Clock::now() - flushed < kBetweenFlushes) return;
    storage.flush();
    flushed = Clock::now();
  };
  const std::size_t without_memory = do_runs(plan_.result, finished);
  storage.flush();
  if (without_memory > 0)
    throw InputError(file_.string(), "out of memory in " + std::to_string(without_memory) +
                                         " runs: the other runs are stored in the file; the same command "
                                         "continues with the rest");
}

}  // namespace remote_touch
