// Where a result came from: program, build and command, as text attributes.
#pragma once

#include <string>

#include "analysis/hdf5_file.h"

namespace remote_touch {

std::string version();  // "0.1.0"

// command: normalised by the caller (no output path, no thread count). config: resolved JSON.
// isa may be empty: then it is left out, for results that several machines made together.
TextAttributes provenance(const std::string& config, const std::string& command, const std::string& isa);

}  // namespace remote_touch
