// Checks the header of a PLY file: whether it ends, and whether the file is long enough for its counts.
#pragma once

#include <filesystem>
#include <string>

namespace remote_touch {

// The problem in one line; empty if there is none.
std::string ply_problem(const std::filesystem::path& file);

}  // namespace remote_touch
