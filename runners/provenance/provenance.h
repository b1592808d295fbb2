// Where a result came from: program, build and command, as text attributes.
#pragma once

#include <string>

#include "analysis/storage/hdf5_file.h"
#include "runners/provenance/recipe.h"

namespace remote_touch {

std::string version();   // "0.2.0"
std::string cpu_name();  // as the system tells it; empty where it does not

// command: normalised by the caller (no output path, no thread count). config: resolved JSON.
// isa may be empty: then it is left out, for results that several machines made together. inputs: as
// input_hashes.h has them; empty where nothing was read, and then left out.
TextAttributes provenance(const std::string& config, const std::string& command, const std::string& isa,
                          const std::string& inputs = {});
// With the recipe as fields beside its command.
TextAttributes provenance(const std::string& config, const Recipe& recipe, const std::string& isa,
                          const std::string& inputs = {});

}  // namespace remote_touch
