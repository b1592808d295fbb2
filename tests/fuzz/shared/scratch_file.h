// Files for readers that need one. They are below TMPDIR, which scripts/fuzz puts into memory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace remote_touch::fuzz {

// Writes a file of that name with these bytes in a folder of this process, and returns its path. The folder
// is removed at the end.
std::filesystem::path scratch_file(const std::string& name, std::string_view bytes);

}  // namespace remote_touch::fuzz
