// Files for readers that want one: below TMPDIR, which scripts/fuzz puts into memory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace remote_touch::fuzz {

// The file of that name in a folder of this process, with these bytes. The folder is removed at the end.
std::filesystem::path scratch_file(const std::string& name, std::string_view bytes);

}  // namespace remote_touch::fuzz
