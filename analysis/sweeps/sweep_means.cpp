#include "analysis/sweeps/sweep_means.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>

#include "analysis/statistics/mean.h"
#include "analysis/statistics/paired_test.h"
#include "analysis/statistics/proportion.h"
#include "analysis/statistics/student.h"
#include "analysis/sweeps/cell_groups.h"

namespace remote_touch {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

// The measure of each finished run; NaN for the other runs.
std::vector<double> finished_values(const SweepResult& result, const std::string& measure) {
  std::vector<double> values = result.measure(measure);
  for (std::size_t run = 0; run < values.size(); ++run)
    if (result.state[run] != RunState::done) values[run] = kNone;
  return values;
}

using Groups = std::vector<std::vector<double>>;  // values of each cell, one for each replicate

MeanDifference share_of(const Groups& cells) {
  int events = 0, runs = 0;
  for (const std::vector<double>& values : cells)
    for (const double value : values)
      if (!std::isnan(value)) events += value == 1 ? 1 : 0, ++runs;
  const auto [low, high] = wilson_interval(events, runs);
  return runs == 0 ? MeanDifference{0, kNone, kNone, kNone}
                   : MeanDifference{runs, static_cast<double>(events) / runs, low, high};
}

struct Difference {
  MeanDifference mean;
  double p = kNone;
};

Difference difference_of_events(const Groups& cells) {
  std::int64_t plus = 0, minus = 0, pairs = 0;
  for (const std::vector<double>& values : cells)
    for (const double value : values)
      if (!std::isnan(value)) plus += value > 0 ? 1 : 0, minus += value < 0 ? 1 : 0, ++pairs;
  if (pairs == 0) return {{0, kNone, kNone, kNone}};
  const auto [low, high] = paired_difference_interval(plus, minus, pairs);
  return {{pairs, static_cast<double>(plus - minus) / static_cast<double>(pairs), low, high},
          sign_test(plus, minus)};
}

Difference difference_of_numbers(const Groups& cells) {
  std::vector<double> all;
  for (const std::vector<double>& values : cells)
    std::copy_if(values.begin(), values.end(), std::back_inserter(all),
                 [](double value) { return !std::isnan(value); });
  if (all.empty()) return {{0, kNone, kNone, kNone}};
  return {student_mean({all}), mean_test(all)};
}

// Returns the p values after Holm's adjustment over those that are known.
std::vector<double> adjusted(const std::vector<double>& p) {
  std::vector<double> known;
  std::copy_if(p.begin(), p.end(), std::back_inserter(known),
               [](double value) { return !std::isnan(value); });
  const std::vector<double> holm = holm_adjusted(known);
  std::vector<double> all;
  auto next = holm.begin();
  for (const double value : p) all.push_back(std::isnan(value) ? kNone : *next++);
  return all;
}

// Returns the means of the known values of several cells, replicate by replicate.
std::vector<double> mean_of_cells(const Groups& cells) {
  std::vector<double> means;
  for (std::size_t replicate = 0; replicate < cells.front().size(); ++replicate)
    means.push_back(mean_where(
        cells.size(), [&](std::size_t i) { return !std::isnan(cells[i][replicate]); },
        [&](std::size_t i) { return cells[i][replicate]; }));
  return means;
}

// The values of a group of cells, whose noise is independent of each other.
struct IndependentValues {
  Groups cells;
  bool is_merged = false;  // true if several cells had the same noise
};

// values_of: values of a cell. shared: the axes with common noise that the group does not have in common.
template <class ValuesOf>
IndependentValues independent(const SweepResult& result, const CellGroup& group,
                              const std::vector<std::size_t>& shared, ValuesOf&& values_of) {
  std::map<std::size_t, Groups> of_noise;  // by the first cell on the shared axes
  for (const std::size_t cell : group.cells) {
    std::vector<std::size_t> indices = result.axis_indices(cell);
    for (const std::size_t axis : shared) indices[axis] = 0;
    of_noise[result.cell_at(indices)].push_back(values_of(cell));
  }
  IndependentValues all;
  for (const auto& [first, cells] : of_noise) {
    all.cells.push_back(cells.size() == 1 ? cells.front() : mean_of_cells(cells));
    all.is_merged |= cells.size() > 1;
  }
  return all;
}

// Returns the axes with common noise over which a row of the table pools.
std::vector<std::size_t> pooled(const std::vector<std::size_t>& common_noise,
                                const std::vector<std::size_t>& kept) {
  std::vector<std::size_t> axes = common_noise;
  std::erase_if(axes,
                [&](std::size_t axis) { return std::find(kept.begin(), kept.end(), axis) != kept.end(); });
  return axes;
}

const Column& measure_column(const SweepResult& result, const std::string& measure) {
  return *std::find_if(result.measures.begin(), result.measures.end(),
                       [&](const Column& column) { return column.name == measure; });
}

// Returns the cell with another place on one axis.
std::size_t moved(const SweepResult& result, std::size_t cell, std::size_t axis, std::size_t place) {
  std::vector<std::size_t> indices = result.axis_indices(cell);
  indices[axis] = place;
  return result.cell_at(indices);
}

}  // namespace

void add_mean_columns(Table& table, const std::vector<MeanDifference>& means, const std::string& unit,
                      const std::string& mean_meaning, const std::string& count) {
  std::vector<double> mean, low, high;
  std::vector<std::int64_t> counts;
  for (const MeanDifference& m : means) {
    mean.push_back(m.mean), low.push_back(m.low), high.push_back(m.high);
    counts.push_back(m.pairs);
  }
  table.add("mean", unit, mean_meaning, std::move(mean));
  table.add("low", unit, "lower end of its 95 % interval", std::move(low));
  table.add("high", unit, "upper end of its 95 % interval", std::move(high));
  table.columns.push_back({count, "1",
                           "number of " + count + " with a value; those with the same noise count as one",
                           counts_in_column(counts)});
}

Table sweep_means(const SweepResult& result, const std::string& measure, const TableAxes& axes) {
  const std::vector<double> values = finished_values(result, measure);
  const Column& column = measure_column(result, measure);
  const std::vector<CellGroup> groups = cell_groups(result, axes.by);
  const std::vector<std::size_t> shared = pooled(axes.common_noise, axes.by);
  const auto values_of = [&](std::size_t cell) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(result.run(cell, 0));
    return std::vector<double>(first, first + result.replicates);
  };
  std::vector<MeanDifference> means;
  for (const CellGroup& group : groups) {
    const IndependentValues all = independent(result, group, shared, values_of);
    means.push_back(is_event(column) && !all.is_merged ? share_of(all.cells) : student_mean(all.cells));
  }
  Table table{"mean_" + measure, "mean of " + measure, axes_of(result, axes.by, groups)};
  add_mean_columns(table, means, column.units, "mean: " + column.long_name, "runs");
  return table;
}

Table sweep_differences(const SweepResult& result, const std::string& measure, std::size_t between,
                        const TableAxes& axes) {
  const std::vector<double> values = finished_values(result, measure);
  const Column& column = measure_column(result, measure);
  std::vector<std::size_t> kept = axes.by;
  kept.push_back(between);
  std::vector<CellGroup> groups = cell_groups(result, kept);
  std::erase_if(groups, [](const CellGroup& group) { return group.indices.back() == 0; });
  const std::vector<std::size_t> shared = pooled(axes.common_noise, kept);
  const auto differences_of = [&](std::size_t cell) {
    const std::size_t first = moved(result, cell, between, 0);
    std::vector<double> differences;
    for (int replicate = 0; replicate < result.replicates; ++replicate)
      differences.push_back(values[result.run(cell, replicate)] - values[result.run(first, replicate)]);
    return differences;
  };
  std::vector<MeanDifference> means;
  std::vector<double> p;
  for (const CellGroup& group : groups) {
    const IndependentValues all = independent(result, group, shared, differences_of);
    const Difference difference = is_event(column) && !all.is_merged ? difference_of_events(all.cells)
                                                                     : difference_of_numbers(all.cells);
    means.push_back(difference.mean), p.push_back(difference.p);
  }
  Table table{"difference_" + measure,
              "difference of " + measure + " from the first value of " + result.axes[between].name,
              axes_of(result, kept, groups)};
  add_mean_columns(table, means, column.units, "mean difference: " + column.long_name, "pairs");
  table.add("p", "1", "p value of the null hypothesis that there is no difference", p);
  table.add("adjusted_p", "1", "p value after Holm's adjustment over the rows", adjusted(p));
  return table;
}

}  // namespace remote_touch
