// The cache of the tools' sphere trees on disk, in the folder of the tools' cache.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/dissertation/sphere_tree/tool_spheres.h"

namespace remote_touch {

// Version of the layout of the file, in its first line.
inline constexpr int kSpheresFormat = 1;

// Returns the key of the spheres, from the key of the tool in its cache, which has the build, and max_leaves.
std::string spheres_key(const std::string& tool_key, int max_leaves);

// These functions do for spheres what read_tool() and write_tool() do for tools.
std::optional<ToolSpheres> read_spheres(const std::filesystem::path& folder, const std::string& key);
bool write_spheres(const std::filesystem::path& folder, const std::string& key, const ToolSpheres& spheres);

}  // namespace remote_touch
