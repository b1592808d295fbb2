#include "analysis/sweeps/sweep_means.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

bool is_event(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isnan(value) || value == 0 || value == 1; });
}

using Groups = std::vector<std::vector<double>>;  // numbers of each cell

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
  double p = 1;
};

Difference difference_of_events(const Groups& cells) {
  std::int64_t plus = 0, minus = 0, pairs = 0;
  for (const std::vector<double>& values : cells)
    for (const double value : values)
      if (!std::isnan(value)) plus += value > 0 ? 1 : 0, minus += value < 0 ? 1 : 0, ++pairs;
  if (pairs == 0) return {{0, kNone, kNone, kNone}, 1};
  const auto [low, high] = paired_difference_interval(plus, minus, pairs);
  return {{pairs, static_cast<double>(plus - minus) / static_cast<double>(pairs), low, high},
          sign_test(plus, minus)};
}

Difference difference_of_numbers(const Groups& cells) {
  std::vector<double> all;
  for (const std::vector<double>& values : cells) all.insert(all.end(), values.begin(), values.end());
  return {student_mean(cells), mean_test(all)};
}

// Adds the columns of the means. count: what was counted, "runs" or "pairs".
void add_means(Table& table, const std::vector<MeanDifference>& means, const std::string& unit,
               const std::string& mean_meaning, const std::string& count) {
  std::vector<double> mean, low, high;
  std::vector<std::int32_t> counts;
  for (const MeanDifference& m : means) {
    mean.push_back(m.mean), low.push_back(m.low), high.push_back(m.high);
    counts.push_back(static_cast<std::int32_t>(m.pairs));
  }
  table.add("mean", unit, mean_meaning, std::move(mean));
  table.add("low", unit, "lower end of its 95 % interval", std::move(low));
  table.add("high", unit, "upper end of its 95 % interval", std::move(high));
  table.add(count, "1", "number of " + count + " with a value", std::move(counts));
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

Table sweep_means(const SweepResult& result, const std::string& measure, const std::vector<std::size_t>& by) {
  const std::vector<double> values = finished_values(result, measure);
  const bool counts_events = is_event(values);
  const std::vector<CellGroup> groups = cell_groups(result, by);
  std::vector<MeanDifference> means;
  for (const CellGroup& group : groups) {
    Groups cells;
    for (const std::size_t cell : group.cells) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(result.run(cell, 0));
      cells.emplace_back(first, first + result.replicates);
    }
    means.push_back(counts_events ? share_of(cells) : student_mean(cells));
  }
  const Column& column = measure_column(result, measure);
  Table table{"mean_" + measure, "mean of " + measure, axes_of(result, by, groups)};
  add_means(table, means, column.units, "mean: " + column.long_name, "runs");
  return table;
}

Table sweep_differences(const SweepResult& result, const std::string& measure, std::size_t between,
                        const std::vector<std::size_t>& by) {
  const std::vector<double> values = finished_values(result, measure);
  const bool counts_events = is_event(values);
  std::vector<std::size_t> axes = by;
  axes.push_back(between);
  std::vector<CellGroup> groups = cell_groups(result, axes);
  std::erase_if(groups, [](const CellGroup& group) { return group.indices.back() == 0; });
  std::vector<MeanDifference> means;
  std::vector<double> p;
  for (const CellGroup& group : groups) {
    Groups cells;
    for (const std::size_t cell : group.cells) {
      const std::size_t first = moved(result, cell, between, 0);
      std::vector<double>& differences = cells.emplace_back();
      for (int replicate = 0; replicate < result.replicates; ++replicate)
        differences.push_back(values[result.run(cell, replicate)] - values[result.run(first, replicate)]);
    }
    const Difference difference = counts_events ? difference_of_events(cells) : difference_of_numbers(cells);
    means.push_back(difference.mean), p.push_back(difference.p);
  }
  const Column& column = measure_column(result, measure);
  Table table{"difference_" + measure,
              "difference of " + measure + " from the first value of " + result.axes[between].name,
              axes_of(result, axes, groups)};
  add_means(table, means, column.units, "mean difference: " + column.long_name, "pairs");
  std::vector<double> adjusted = holm_adjusted(p);
  table.add("p", "1", "p value of no difference", std::move(p));
  table.add("adjusted_p", "1", "p value after Holm's adjustment over the rows", std::move(adjusted));
  return table;
}

}  // namespace remote_touch
