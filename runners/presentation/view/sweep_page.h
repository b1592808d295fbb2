// A page that shows a sweep: its map, and some of its runs, which are run again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runners/presentation/view/view_page.h"

namespace remote_touch {

inline constexpr std::size_t kRunsOfSweepPage = 6;  // maximum if no cells are named

// cells: texts that cell_of() reads. The page shows the first failed run of each, or its first finished run
// if none failed. Empty: see default_runs(), with the measure that the sweep refines, else popped_through,
// else its first measure. Throws InputError if the file is not a finished sweep, if the sweep does not have a
// cell or has not run it, and as ShownRun and view_page() do.
ViewPage sweep_page(const std::filesystem::path& file, const std::vector<std::string>& cells,
                    const ViewOptions& options);

}  // namespace remote_touch
