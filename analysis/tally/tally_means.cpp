#include "analysis/tally/tally_means.h"

#include <algorithm>

#include "analysis/statistics/proportion.h"
#include "analysis/statistics/student.h"
#include "analysis/sweeps/cell_groups.h"
#include "analysis/sweeps/sweep_means.h"

namespace remote_touch {

namespace {

// Returns null if the tally has no run of the cell.
const CellTally* tally_of(const SweepTally& tally, std::uint64_t cell) {
  const auto found = std::lower_bound(tally.cells.begin(), tally.cells.end(), cell);
  if (found == tally.cells.end() || *found != cell) return nullptr;
  return &tally.tallies[static_cast<std::size_t>(found - tally.cells.begin())];
}

MeanDifference share_of(const SweepTally& tally, std::size_t measure, const CellGroup& group) {
  std::int64_t runs = 0;
  double events = 0;
  for (const std::size_t cell : group.cells)
    if (const CellTally* const own = tally_of(tally, cell)) {
      runs += own->measures[measure].values;
      events += own->measures[measure].sum.value();
    }
  if (runs == 0) return student_mean_of_moments({});
  const auto [low, high] = wilson_interval(static_cast<std::int64_t>(events), runs);
  return {runs, events / static_cast<double>(runs), low, high};
}

MeanDifference mean_of(const SweepTally& tally, std::size_t measure, const CellGroup& group) {
  std::vector<Moments> moments;
  for (const std::size_t cell : group.cells)
    if (const CellTally* const own = tally_of(tally, cell)) {
      const MeasureTally& values = own->measures[measure];
      moments.push_back({static_cast<double>(values.values), values.values > 0 ? values.mean() : 0,
                         values.values > 1 ? values.variance() : 0, 0});
    }
  return student_mean_of_moments(moments);
}

}  // namespace

Tally event_count(const SweepTally& tally, std::size_t measure, std::uint64_t cell) {
  const CellTally* const own = tally_of(tally, cell);
  if (!own) return {};
  return {static_cast<int>(own->measures[measure].sum.value()), static_cast<int>(own->done)};
}

Table tally_means(const SweepTally& tally, const SweepResult& outline, std::size_t measure,
                  const std::vector<std::size_t>& by) {
  const Column& column = tally.measures[measure];
  const std::vector<CellGroup> groups = cell_groups(outline, by);
  std::vector<MeanDifference> means;
  for (const CellGroup& group : groups)
    means.push_back(is_event(column) ? share_of(tally, measure, group) : mean_of(tally, measure, group));
  Table table{"mean_" + column.name, "mean of " + column.name, axes_of(outline, by, groups)};
  add_mean_columns(table, means, column.units, "mean: " + column.long_name, "runs");
  return table;
}

}  // namespace remote_touch
