// The claims of an experiment's figure, which a page shows beside a run of that experiment.
#pragma once

#include <filesystem>

#include "analysis/storage/hdf5_file.h"
#include "scenarios/text_files/text_file.h"

namespace remote_touch {

// Returns the claims of the figure whose experiment was run: `run fig4.12` belongs to figure 4.12. claims:
// the claims.json of `remote-touch figure`; empty: none. The result is a list of objects with claim, paper,
// measured, unit, criterion and verdict. It is empty for a run of another experiment, or with other settings.
// Throws InputError if the file is not a list of claims.
Json shown_claims(const std::filesystem::path& claims, const TextAttributes& run);

}  // namespace remote_touch
