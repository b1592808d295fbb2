// The provenance of a result: program, build and command, as text attributes.
#pragma once

#include <string>

#include "analysis/storage/hdf5_file.h"
#include "runners/provenance/recipe.h"

namespace remote_touch {

std::string version();   // "0.2.0"
std::string cpu_name();  // as the system reports it; empty if it does not

// command: normalised by the caller (no output path, no thread count). config: resolved JSON. isa may be
// empty, for results that several machines made together; it is then left out. inputs: the text of
// input_hashes.h; empty if nothing was read, and then left out.
TextAttributes provenance(const std::string& config, const std::string& command, const std::string& isa,
                          const std::string& inputs = {});
// The same with the recipe as fields in addition to its command.
TextAttributes provenance(const std::string& config, const Recipe& recipe, const std::string& isa,
                          const std::string& inputs = {});

}  // namespace remote_touch
