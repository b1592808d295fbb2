#include "runners/sweep/sweep_session.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <new>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/changed_settings.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string first_difference(const TextAttributes& theirs, const TextAttributes& ours) {
  const auto all = configuration_differences(attribute(theirs, "config"), attribute(ours, "config"));
  return all.empty() ? "its title" : all.front();
}

constexpr const char* kBuild[] = {"version", "git_commit", "git_dirty",      "source_digest", "compiler",
                                  "flags",   "program",    "program_sha256", "plugins"};

}  // namespace

TextAttributes build_of(const TextAttributes& attributes) {
  TextAttributes build;
  for (const char* name : kBuild) build.emplace_back(name, attribute(attributes, name));
  return build;
}

void require_same_sweep(const std::filesystem::path& file, const TextAttributes& theirs,
                        const TextAttributes& ours) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(file.string(),
                     what + ": expected a file of the same sweep, shard and build, or a new file");
  };
  if (attribute(theirs, "config") != attribute(ours, "config"))
    refuse("is of another configuration, first in " + first_difference(theirs, ours));
  const auto compare = [&](const std::string& name) {
    if (attribute(theirs, name) != attribute(ours, name))
      refuse("has " + name + " \"" + attribute(theirs, name) + "\", not \"" + attribute(ours, name) + "\"");
  };
  compare("shard");
  for (const char* name : kBuild) compare(name);
}

void require_same_origin(const MergedFile& part, const MergedFile& first) {
  const TextAttributes &ours = part.attributes, &theirs = first.attributes;
  for (const auto* attributes : {&ours, &theirs})  // either may have one that the other has not
    for (const auto& [name, value] : *attributes)
      // The path of the same file may be written differently.
      if (name != "input_digests" && name != "command" && name != kRecipe &&
          attribute(ours, name) != attribute(theirs, name))
        throw InputError(part.file,
                         "has another " + name + " than " + first.file +
                             (name == "config" ? ", first in " + first_difference(ours, theirs) : "") +
                             ": expected shards of one sweep, made by one build");
  for (const auto& input :
       changed_inputs(attribute(theirs, "input_digests"), attribute(ours, "input_digests")))
    throw InputError(part.file, "has runs on another recording " + input.path + " (" + input.now + "; " +
                                    first.file + ": " + input.before + "): expected shards of one sweep");
}

namespace {

[[noreturn]] void refuse_changed(const std::filesystem::path& file, const ChangedInput& input) {
  throw InputError(file.string(), "has runs on another recording " + input.path + " (" + input.before +
                                      "; now " + input.now + "): expected the same recording, or a new file");
}

// Throws InputError if a finished run has read a recording that has changed since: its values belong to
// another recording.
void require_same_inputs(const std::filesystem::path& file, const Sweep& sweep, const SweepResult& result,
                         const std::vector<ChangedInput>& changed) {
  if (changed.empty()) return;
  for (const std::size_t place : result.runs_in(RunState::done))
    for (const InputPart& part : sweep.experiment(result.cell_of(result.run_at(place)), 0).inputs())
      for (const ChangedInput& input : changed)
        if (input.path == in_one_line(part.path)) refuse_changed(file, input);
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

// Reads the file of a sweep that keeps its runs. made: has no results.
SweepPlan plan_of_runs(const Sweep& sweep, KeptSweep made, const std::filesystem::path& file) {
  SweepPlan plan{std::move(made)};
  std::error_code unreachable;
  const auto there = std::filesystem::status(file, unreachable);
  if (std::filesystem::exists(there) && !std::filesystem::is_regular_file(there) &&
      !std::filesystem::is_directory(there))
    throw InputError(file.string(),
                     "a pipe or a device: expected a file, because a sweep stores each run when it is done");
  if (!std::filesystem::is_regular_file(there)) return plan;
  SweepResult& result = std::get<SweepResult>(plan.made.kept);
  StoredSweep stored = read_sweep(file);
  require_same_sweep(file, stored.attributes, plan.made.attributes);
  take_over(std::move(stored.result), file, result);
  const std::string inputs = attribute(plan.made.attributes, "input_digests");
  const auto changed = changed_inputs(attribute(stored.attributes, "input_digests"), inputs);
  require_same_inputs(file, sweep, result, changed);
  const auto failed = result.runs_in(RunState::failed);
  for (const std::size_t place : failed) result.state[place] = RunState::pending, result.error[place].clear();
  plan.made.attributes = std::move(stored.attributes);
  set_attribute(plan.made.attributes, "input_digests", inputs);
  const bool is_same = failed.empty() && changed.empty();
  plan.in_progress = stored.in_progress && is_same;
  plan.is_finished = !stored.in_progress && is_same;
  return plan;
}

SweepTally without_runs(const Sweep& sweep, const Shard& shard) {
  constexpr std::size_t kMaxTallyCells = 1'000'000;
  SweepTally tally(sweep.outline(), sweep.keep() == Keep::events);
  const std::size_t cells = shard.cells_of(tally.cell_count());
  if (cells == 0 || cells > kMaxTallyCells)
    throw InputError(sweep.title(), "shard " + shard.text() + " has " + std::to_string(cells) +
                                        " cells: expected 1 to " + std::to_string(kMaxTallyCells) + "; use " +
                                        (cells == 0 ? "at most as many shards as cells" : "more shards"));
  return tally;
}

// The same for a sweep that keeps a tally.
SweepPlan plan_of_tally(KeptSweep made, const std::filesystem::path& file) {
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable)) return {std::move(made)};
  StoredTally stored = read_tally(Hdf5Reader(file));
  require_same_sweep(file, stored.attributes, made.attributes);
  for (const auto& input : changed_inputs(attribute(stored.attributes, "input_digests"),
                                          attribute(made.attributes, "input_digests")))
    refuse_changed(file, input);
  require_trusted(file, stored.attributes);
  return {{std::move(stored.tally), std::move(stored.attributes)}};
}

}  // namespace

std::size_t SweepPlan::done() const {
  const auto* const tally = std::get_if<SweepTally>(&made.kept);
  return tally ? tally->held.count() : count_of(std::get<SweepResult>(made.kept), RunState::done);
}

std::size_t SweepPlan::total(const Shard& shard) const {
  if (const auto* const result = std::get_if<SweepResult>(&made.kept))
    return done() + count_of(*result, RunState::pending);
  return ShardSet{{shard.index}, shard.count}.runs_of(made.grid());
}

SweepPlan plan_in_file(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
                       const std::filesystem::path& file) {
  return sweep.keep() == Keep::runs ? plan_of_runs(sweep, {sweep.plan(shard), attributes}, file)
                                    : plan_of_tally({without_runs(sweep, shard), attributes}, file);
}

SweepSession::SweepSession(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
                           const std::filesystem::path& file)
    : sweep_(sweep),
      shard_(shard),
      file_(resolved(file)),
      lock_(file_),
      plan_(plan_in_file(sweep, shard, attributes, file_)) {}

bool SweepSession::run(const Kernels& kernels, const std::atomic<bool>* stop, const Progress& progress) {
  const DoRuns here = [&](SweepResult& runs, const std::function<void(std::size_t)>& stored) {
    return do_pending_runs(sweep_, runs, {&kernels, stop, stored});
  };
  return run(here, 2, progress);
}

bool SweepSession::run(const DoRuns& do_runs, double batch_s, const Progress& progress) {
  return sweep_.keep() == Keep::runs ? run_rounds(do_runs, progress)
                                     : run_batches(do_runs, batch_s, progress);
}

void SweepSession::forget(const std::vector<std::size_t>& runs, const std::string& why) {
  if (sweep_.keep() == Keep::runs) return forget_stored(runs);
  for (const std::size_t run : runs)
    if (const auto place = batch_.place_of(run)) batch_.state[*place] = RunState::pending;
  if (why.empty()) return;
  plan_.made.attributes.emplace_back(kDistrusted, why);
  if (done() > 0) store();
}

// --- a sweep that keeps its runs ---

// Shards do only the first round. Refinement needs the runs of all shards, so it begins on the merged file.
bool SweepSession::add_round_if_whole() {
  if (shard_.count > 1 || !add_round(sweep_, result())) return false;
  plan_.in_progress = false;  // the file does not have the new round yet
  return true;
}

bool SweepSession::run_rounds(const DoRuns& do_runs, const Progress& progress) {
  const SweepResult before = result();
  bool is_finished = plan_.is_finished;
  try {
    while (!result().runs_in(RunState::pending).empty() || add_round_if_whole()) {
      is_finished = false;
      do_round(do_runs, progress);
    }
  } catch (...) {  // finished runs are in the file, whatever ended this call
    require_unchanged_inputs(before);
    throw;
  }
  if (is_finished) return false;
  require_unchanged_inputs(before);
  write_sweep(file_, result(), plan_.made.attributes);
  return true;
}

// Throws InputError if a recording has changed. All runs of this call are then pending again, because it is
// not known which of them have read a recording before it changed.
void SweepSession::require_unchanged_inputs(const SweepResult& before) {
  const std::string inputs = attribute(plan_.made.attributes, "input_digests");
  if (inputs.empty()) return;
  try {
    require_unchanged(sweep_.inputs(), inputs);
  } catch (const InputError&) {
    result() = before;
    write_sweep_in_progress(file_, before, plan_.made.attributes);
    throw;
  }
}

void SweepSession::forget_stored(const std::vector<std::size_t>& runs) {
  SweepResult& result = this->result();
  const bool is_refined = !result.round.empty();
  std::int32_t first_round = std::numeric_limits<std::int32_t>::max();
  const auto reset = [&](std::size_t place, RunState state) {
    for (Column& measure : result.measures)
      std::get<std::vector<double>>(measure.values)[place] = std::numeric_limits<double>::quiet_NaN();
    result.state[place] = state, result.notes[place] = 0, result.error[place].clear();
    if (state == RunState::not_sampled) result.round[place] = -1;
  };
  for (const std::size_t run : runs) {
    const std::size_t place = result.place_of(run).value();
    reset(place, RunState::pending);
    if (is_refined) first_round = std::min(first_round, result.round[place]);
  }
  for (std::size_t place = 0; place < result.round.size(); ++place)
    if (result.round[place] > first_round) reset(place, RunState::not_sampled);
  write_sweep_in_progress(file_, result, plan_.made.attributes);
}

void SweepSession::do_round(const DoRuns& do_runs, const Progress& progress) {
  constexpr std::chrono::seconds kBetweenFlushes{1};
  SweepInProgress storage(file_, result(), plan_.made.attributes, plan_.in_progress);
  plan_.in_progress = true;
  const std::size_t earlier = this->done(), total = this->total();
  std::size_t done = earlier;
  auto flushed = Clock::now();
  const auto finished = [&](std::size_t place) {
    storage.record(result(), place);
    progress(++done, total, earlier);
    if (Clock::now() - flushed < kBetweenFlushes) return;
    storage.flush();
    flushed = Clock::now();
  };
  const std::size_t without_memory = do_runs(result(), finished);
  storage.flush();
  if (without_memory > 0)
    throw InputError(file_.string(), "out of memory in " + std::to_string(without_memory) +
                                         " runs: the other runs are stored in the file; the same command "
                                         "continues with the rest");
}

// --- a sweep that keeps a tally ---

void add_runs(const SweepResult& batch, SweepTally& tally) {
  const TallyLayout layout = tally.layout();
  std::vector<double> values(batch.measures.size());
  for (std::size_t place = 0; place < batch.held_count(); ++place) {
    for (std::size_t m = 0; m < values.size(); ++m)
      values[m] = std::get<std::vector<double>>(batch.measures[m].values)[place];
    if (batch.state[place] == RunState::done)
      tally.add_done(layout, batch.run_at(place), values, batch.notes[place]);
    if (batch.state[place] == RunState::failed)
      tally.add_failed(layout, batch.run_at(place), batch.error[place]);
  }
}

// Returns up to `count` of the lowest runs that are not made.
std::vector<std::uint64_t> SweepSession::next_runs(std::size_t count) {
  const auto replicates = static_cast<std::uint64_t>(tally().replicates);
  std::vector<std::uint64_t> runs;
  for (std::size_t i = next_cell_; i < shard_.cells_of(tally().cell_count()); ++i) {
    const std::uint64_t first = shard_.cell(i) * replicates;
    const RunRanges missing = tally().held.missing_in({first, first + replicates});
    if (missing.ranges().empty() && i == next_cell_) ++next_cell_;
    for (const RunRange& range : missing.ranges())
      for (std::uint64_t run = range.first; run < range.end; ++run) {
        if (runs.size() == count) return runs;
        runs.push_back(run);
      }
  }
  return runs;
}

// Throws InputError if a recording has changed since the session began: then it is not known which runs have
// read it.
void SweepSession::store() {
  require_unchanged(sweep_.inputs(), attribute(plan_.made.attributes, "input_digests"));
  write_tally(file_, tally(), plan_.made.attributes);
}

bool SweepSession::run_batches(const DoRuns& do_runs, double batch_s, const Progress& progress) {
  constexpr std::size_t kLeastBatch = 16, kMostBatch = 1 << 20;  // runs that are added together
  const std::size_t earlier = done();
  std::size_t size = kLeastBatch;
  auto stored = Clock::now();
  double storing_s = 0.5;
  for (;;) {
    batch_ = sweep_.part(next_runs(size));
    if (batch_.held_count() == 0) break;
    const auto start = Clock::now();
    try {
      if (do_runs(batch_, [](std::size_t) {}) > 0) throw std::bad_alloc();
    } catch (...) {
      add_runs(batch_, tally());
      if (done() > earlier) store();
      throw;
    }
    add_runs(batch_, tally());
    progress(done(), total(), earlier);
    const double took_s = seconds_since(start);
    if (took_s < batch_s / 2) size = std::min((took_s < batch_s / 16 ? 8 : 2) * size, kMostBatch);
    if (took_s > 1.5 * batch_s) size = std::max(size / 2, kLeastBatch);
    if (seconds_since(stored) < std::max(10.0, 20 * storing_s)) continue;
    const auto began = Clock::now();
    store();
    stored = Clock::now(), storing_s = seconds_since(began);
  }
  if (done() == earlier) return false;
  store();
  return true;
}

}  // namespace remote_touch
