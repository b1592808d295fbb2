// A page that shows one or two stored traces: the scene, the hand, the proxy or tool and the force in 3-D,
// and the columns as plots.
#pragma once

#include <filesystem>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "runners/presentation/pages/view_page.h"
#include "scenarios/files/text_file.h"

namespace remote_touch {

// Returns the claims of the figure whose experiment was run, which a page shows beside the run: `run fig4.12`
// belongs to figure 4.12. claims: the claims.json of `remote-touch figure`; empty: none. The result is a list
// of objects with claim, paper, measured, unit, criterion and verdict. It is empty for a run of another
// experiment, or with other settings. Throws InputError if the file is not a list of claims.
Json shown_claims(const std::filesystem::path& claims, const TextAttributes& run);

// traces: one, or two to compare. Frames are made again from the stored configurations. Throws InputError,
// naming the file, for a file that is no trace or of a live run, and as ShownRun and view_page() do.
ViewPage trace_page(const std::vector<std::filesystem::path>& traces, const ViewOptions& options);

}  // namespace remote_touch
