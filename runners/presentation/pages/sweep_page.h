// A page that shows a sweep: its map, and some of its runs, which are run again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "runners/presentation/pages/view_page.h"

namespace remote_touch {

// Returns the runs of a sweep that a page shows if no cells are named: at most `max` runs whose measure is
// above the threshold, evenly spread over the grid, in ascending order. They are the failures nearest to the
// limit: the first failed run of each cell in which most runs failed and that has a neighbour in which most
// did not. A neighbour is the next cell along an axis that has finished runs. If no cell has such a
// neighbour, any cells with a failed run are used. If no run failed, returns the runs with the smallest and
// the largest value. Empty only if no run is done.
std::vector<std::size_t> default_runs(const SweepResult& result, const std::vector<double>& measure,
                                      double threshold, std::size_t max);

inline constexpr std::size_t kRunsOfSweepPage = 6;  // maximum if no cells are named

// cells: texts that cell_of() reads. The page shows the first failed run of each, or its first finished run
// if none failed. Empty: see default_runs(), with the measure that the sweep refines, else popped_through,
// else its first measure. Throws InputError if the file is not a finished sweep, if the sweep does not have a
// cell or has not run it, and as ShownRun and view_page() do.
ViewPage sweep_page(const std::filesystem::path& file, const std::vector<std::string>& cells,
                    const ViewOptions& options);

}  // namespace remote_touch
