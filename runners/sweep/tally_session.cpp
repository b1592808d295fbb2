#include "runners/sweep/tally_session.h"

#include <algorithm>
#include <chrono>
#include <new>

#include "analysis/storage/atomic_file.h"
#include "core/parameters/input_error.h"
#include "runners/experiment/provenance/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_origin.h"
#include "runners/sweep/sweep_run.h"

namespace remote_touch {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxCells = 1'000'000;
constexpr std::size_t kLeastBatch = 16, kMostBatch = 1 << 20;  // runs that are added together

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

SweepTally without_runs(const Sweep& sweep) {
  const SweepResult outline = sweep.outline();
  SweepTally tally;
  tally.axes = outline.axes, tally.replicates = outline.replicates, tally.measures = outline.measures;
  tally.note_kinds = outline.note_kinds, tally.keeps_events = sweep.keep() == Keep::events;
  return tally;
}

// Adds the runs of the batch that were made.
void add(const SweepResult& batch, const TallyLayout& layout, SweepTally& tally) {
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

}  // namespace

TallyPlan tally_plan_in_file(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
                             const std::filesystem::path& file) {
  TallyPlan plan{without_runs(sweep), attributes};
  const std::size_t cells = shard.cells_of(plan.tally.cell_count());
  if (cells == 0 || cells > kMaxCells)
    throw InputError(sweep.title(), "shard " + shard.text() + " has " + std::to_string(cells) +
                                        " cells: expected 1 to " + std::to_string(kMaxCells) + "; use " +
                                        (cells == 0 ? "at most as many shards as cells" : "more shards"));
  plan.own_runs = cells * static_cast<std::uint64_t>(plan.tally.replicates);
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable)) return plan;
  StoredTally stored = read_tally(Hdf5Reader(file));
  require_same_sweep(file, stored.schema, stored.attributes, attributes);
  const std::string inputs = attribute(attributes, "input_digests");
  for (const auto& input : changed_inputs(attribute(stored.attributes, "input_digests"), inputs))
    throw InputError(file.string(), "has runs on another recording " + input.path + " (" + input.before +
                                        "; now " + input.now +
                                        "): expected the same recording, or a new file");
  require_trusted(file, stored.attributes);
  plan.tally = std::move(stored.tally);
  plan.attributes = std::move(stored.attributes);
  return plan;
}

TallySession::TallySession(const Sweep& sweep, const Shard& shard, const TextAttributes& attributes,
                           const std::filesystem::path& file)
    : sweep_(sweep),
      shard_(shard),
      file_(resolved(file)),
      lock_(file_),
      plan_(tally_plan_in_file(sweep, shard, attributes, file_)) {}

// Returns up to `count` of the lowest runs that are not made.
std::vector<std::uint64_t> TallySession::next_runs(std::size_t count) {
  const auto replicates = static_cast<std::uint64_t>(plan_.tally.replicates);
  std::vector<std::uint64_t> runs;
  for (std::size_t i = next_cell_; i < shard_.cells_of(plan_.tally.cell_count()); ++i) {
    const std::uint64_t first = shard_.cell(i) * replicates;
    const RunRanges missing = plan_.tally.held.missing_in({first, first + replicates});
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
void TallySession::store() {
  require_unchanged(sweep_.inputs(), attribute(plan_.attributes, "input_digests"));
  digest_ = write_tally(file_, plan_.tally, plan_.attributes);
}

bool TallySession::run(const Kernels& kernels, const std::atomic<bool>* stop, const Progress& progress) {
  const DoBatch here = [&](SweepResult& batch) {
    if (do_pending_runs(sweep_, batch, {&kernels, stop}) > 0) throw std::bad_alloc();
  };
  return run(here, 2, progress);
}

bool TallySession::run(const DoBatch& do_batch, double batch_s, const Progress& progress) {
  const TallyLayout layout = plan_.tally.layout();
  const std::size_t earlier = plan_.tally.held.count();
  std::size_t size = kLeastBatch;
  auto stored = Clock::now();
  double storing_s = 0.5;
  for (;;) {
    SweepResult batch = sweep_.part(next_runs(size));
    if (batch.held_count() == 0) break;
    const auto start = Clock::now();
    try {
      do_batch(batch);
    } catch (...) {
      add(batch, layout, plan_.tally);
      if (plan_.tally.held.count() > earlier) store();
      throw;
    }
    add(batch, layout, plan_.tally);
    progress(plan_.tally.held.count(), own_runs(), earlier);
    const double took_s = seconds_since(start);
    if (took_s < batch_s / 2) size = std::min((took_s < batch_s / 16 ? 8 : 2) * size, kMostBatch);
    if (took_s > 1.5 * batch_s) size = std::max(size / 2, kLeastBatch);
    if (seconds_since(stored) < std::max(10.0, 20 * storing_s)) continue;
    const auto began = Clock::now();
    store();
    stored = Clock::now(), storing_s = seconds_since(began);
  }
  if (plan_.tally.held.count() == earlier) {
    digest_ = remote_touch::digest(plan_.tally);
    return false;
  }
  store();
  return true;
}

void TallySession::distrust(const std::string& why) {
  plan_.attributes.emplace_back(kDistrusted, why);
  if (plan_.tally.held.count() > 0) store();
}

}  // namespace remote_touch
