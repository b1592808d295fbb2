// Selects the runs of a sweep that a page shows if no cells are named.
#pragma once

#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"

namespace remote_touch {

// Returns at most `max` runs whose measure is above the threshold, evenly spread over the grid, in ascending
// order. They are the failures nearest to the limit: the first failed run of each cell in which most runs
// failed and that has a neighbour in which most did not. A neighbour is the next cell along an axis that has
// finished runs. If no cell has such a neighbour, any cells with a failed run are used. If no run failed,
// returns the runs with the smallest and the largest value. Empty only if no run is done.
std::vector<std::size_t> default_runs(const SweepResult& result, const std::vector<double>& measure,
                                      double threshold, std::size_t max);

}  // namespace remote_touch
