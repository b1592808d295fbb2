#include "analysis/tally/tally_means.h"

#include <algorithm>

#include "analysis/statistics/interval_estimates.h"
#include "analysis/statistics/limit.h"
#include "analysis/sweeps/sweep_means.h"
#include "analysis/sweeps/sweep_result.h"
#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

// Returns null if the tally has no run of the cell.
const CellTally* tally_of(const SweepTally& tally, std::uint64_t cell) {
  const auto found = std::lower_bound(tally.cells.begin(), tally.cells.end(), cell);
  if (found == tally.cells.end() || *found != cell) return nullptr;
  return &tally.tallies[static_cast<std::size_t>(found - tally.cells.begin())];
}

EventCounts counts_in(const CellTally& cell, std::size_t measure) {
  const MeasureTally& m = cell.measures[measure];
  const auto events = static_cast<std::int64_t>(m.sum.value());
  return {events, m.values - events, m.unknown};
}

// The runs of a fixed cell are equal, and count as one.
Estimate fraction_of(const SweepTally& tally, std::size_t measure, const CellGroup& group,
                     const CellStreams& streams) {
  EventCounts all;
  bool are_fixed = true;
  for (const std::size_t cell : group.cells) {
    const EventCounts own = event_counts(tally, measure, cell);
    all.add(RunsAtValue{0, own, streams.is_fixed(cell)}.of_one_run_if_fixed().counts);
    are_fixed &= streams.is_fixed(cell) || own.runs() == 0;
  }
  return are_fixed && all.runs() > 0 ? exact_fraction(all) : estimated_fraction(all);
}

Estimate mean_of(const SweepTally& tally, std::size_t measure, const CellGroup& group,
                 const CellStreams& streams) {
  std::vector<StratumMoments> strata;
  bool are_fixed = true;
  for (const std::size_t cell : group.cells)
    if (const CellTally* const own = tally_of(tally, cell)) {
      const MeasureTally& values = own->measures[measure];
      const bool is_fixed = streams.is_fixed(cell);
      const std::int64_t without_value = values.unknown + values.infinite;
      are_fixed &= is_fixed;
      strata.push_back({{static_cast<double>(values.values), values.values > 0 ? values.mean() : 0,
                         values.values > 1 ? values.variance() : 0, 0},
                        is_fixed,
                        is_fixed ? std::min<std::int64_t>(without_value, 1) : without_value});
    }
  Estimate e = estimated_mean(strata, false);
  if (are_fixed && !strata.empty()) e.clusters += e.unknown, e.method = kExactMethod;
  return e;
}

}  // namespace

EventCounts event_counts(const SweepTally& tally, std::size_t measure, std::uint64_t cell) {
  const CellTally* const own = tally_of(tally, cell);
  return own ? counts_in(*own, measure) : EventCounts{};
}

std::int64_t noted_runs(const SweepTally& tally, std::uint64_t cell) {
  std::int64_t most = 0;
  if (const CellTally* const own = tally_of(tally, cell))
    for (const NoteTally& note : own->notes) most = std::max(most, note.runs);
  return most;
}

Table tally_means(const SweepTally& tally, const SweepResult& outline, std::size_t measure,
                  const std::vector<std::size_t>& by, const CellStreams& streams) {
  const Column& column = tally.measures[measure];
  const std::vector<CellGroup> groups = cell_groups(outline, by);
  const auto done = [&](std::size_t cell) {
    const CellTally* const own = tally_of(tally, cell);
    return own ? own->done : 0;
  };
  std::vector<Estimate> estimates;
  std::vector<std::int64_t> noted;
  for (const CellGroup& group : groups) {
    if (!streams.are_independent(group.cells))
      throw InputError("by",
                       "a tally does not know which runs of pooled cells share random numbers: expected "
                       "all axes, or a sweep with \"keep\": \"runs\"");
    Estimate e = is_event(column) ? fraction_of(tally, measure, group, streams)
                                  : mean_of(tally, measure, group, streams);
    std::int64_t runs = 0, with_note = 0;
    for (const std::size_t cell : group.cells) {
      runs += streams.is_fixed(cell) ? std::min<std::int64_t>(done(cell), 1) : done(cell);
      with_note += noted_runs(tally, cell);
    }
    if (!tally.note_kinds.empty()) noted.push_back(with_note);
    if (const std::string equal = equal_runs_note(streams, group.cells, done); !equal.empty())
      e.add_note(equal);
    note_unknown(e, runs, is_event(column));
    estimates.push_back(std::move(e));
  }
  Table table{"mean_" + column.name, "mean of " + column.name, axes_of(outline, by, groups)};
  add_estimates(table, estimates,
                {column.units, (is_event(column) ? "fraction: " : "mean: ") + column.long_name, kRunsMeaning},
                noted);
  return table;
}

}  // namespace remote_touch
