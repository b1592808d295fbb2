// What the figure of an experiment claims, beside a run of that experiment.
#pragma once

#include <filesystem>

#include "analysis/storage/hdf5_file.h"
#include "scenarios/text_files/json_text.h"

namespace remote_touch {

// Those of the figure whose experiment was run: `run fig4.12` is that of figure 4.12. claims: the claims.json
// of `remote-touch figure`; empty: none. A list of objects with claim, paper, measured, unit, criterion and
// verdict; empty for a run of another experiment, or with other settings. Throws InputError for a file that
// is none.
Json shown_claims(const std::filesystem::path& claims, const TextAttributes& run);

}  // namespace remote_touch
