// Which runs of a sweep a page shows when none are named.
#pragma once

#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// At most `max` runs whose measure is above the threshold, from cells where most runs are so and that have a
// neighbour where they are not: the failures nearest to the limit, evenly spread over the grid. Where no cell
// has such a neighbour, any cells with such a run; without any, the runs with the smallest and the largest
// value. A neighbour is the next cell along an axis that has finished runs. Rising; empty only if no run is
// done.
std::vector<std::size_t> runs_near_limit(const SweepResult& result, const std::vector<double>& measure,
                                         double threshold, std::size_t max);

}  // namespace remote_touch
