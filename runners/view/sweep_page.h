// A page that shows a sweep: its map, and some of its runs, which are run again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runners/view/view_page.h"

namespace remote_touch {

inline constexpr std::size_t kRunsOfSweepPage = 6;  // where no cells are named

// cells: as cell_of() reads them; of each its first run that failed, or its first. Empty: see
// runs_near_limit(), by the measure that the sweep refines, else popped_through, else its first measure.
// Throws InputError for a file that is not a finished sweep, a cell that it has not or has not run, and as
// ShownRun and view_page() do.
ViewPage sweep_page(const std::filesystem::path& file, const std::vector<std::string>& cells,
                    const ViewOptions& options);

}  // namespace remote_touch
