// A page that shows one or two stored traces: the scene, the hand, the proxy or tool and the force in 3-D,
// and the columns as plots.
#pragma once

#include <filesystem>
#include <vector>

#include "runners/presentation/view/view_page.h"

namespace remote_touch {

// traces: one, or two to compare. Frames are made again from the stored configurations. Throws InputError,
// naming the file, for a file that is no trace or of a live run, and as ShownRun and view_page() do.
ViewPage trace_page(const std::vector<std::filesystem::path>& traces, const ViewOptions& options);

}  // namespace remote_touch
