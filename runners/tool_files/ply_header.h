// The header of a PLY file: whether it ends, and whether the file can hold what it counts.
#pragma once

#include <filesystem>
#include <string>

namespace remote_touch {

// Empty where nothing is wrong with it.
std::string ply_problem(const std::filesystem::path& file);

}  // namespace remote_touch
