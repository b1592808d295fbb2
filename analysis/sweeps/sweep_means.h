// Means of the measures of a sweep and differences between the values of one of its axes, with 95 %
// intervals.
#pragma once

#include <string>
#include <vector>

#include "analysis/statistics/paired_test.h"
#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// The axes of a table. Those with common noise have the same noise at all their values, so that their runs
// are not independent: where they are pooled, the runs of one replicate count as one, with their mean.
struct TableAxes {
  std::vector<std::size_t> by;            // increasing
  std::vector<std::size_t> common_noise;  // increasing
};

// Returns a table with a row for each combination of the axes `by`: their values, `mean`, `low`, `high` and
// `runs`. Runs that are not finished or whose measure is NaN are left out. The interval is Wilson's if the
// measure is an event (is_event()) and no common noise is pooled. Else it is that of student_mean() with a
// group for each cell; it is NaN if no group has two numbers.
Table sweep_means(const SweepResult& result, const std::string& measure, const TableAxes& axes);

// Returns a table of the differences of the measure at each value of the axis `between` from that at its
// first value. It has a row for each such value and each combination of the axes `by`: the values, `mean`,
// `low`, `high`, `pairs`, `p` and `adjusted_p`. A pair is two finished runs of one replicate whose cells
// differ on the axis `between` only; with common noise they differ in nothing else. If the measure is an
// event and no common noise is pooled, the interval is that of paired_difference_interval() and p that of
// sign_test(). Else they are those of student_mean(), with all pairs of the row as one group, and
// mean_test(). adjusted_p: after Holm, over the rows with pairs; both are NaN in the others. pre: `by` does
// not contain `between`.
Table sweep_differences(const SweepResult& result, const std::string& measure, std::size_t between,
                        const TableAxes& axes);

// Adds the columns mean, low, high and `count`, "runs" or "pairs". mean_meaning: the long name of the means.
void add_mean_columns(Table& table, const std::vector<MeanDifference>& means, const std::string& unit,
                      const std::string& mean_meaning, const std::string& count);

}  // namespace remote_touch
