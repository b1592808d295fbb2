// Tools that were made before, on disk: a run of a sweep must not make its tool anew.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/tool/voxels/voxel_tool.h"

namespace remote_touch {

// The folder REMOTE_TOUCH_CACHE; else remote-touch in XDG_CACHE_HOME, or in ~/.cache. Empty: there is none.
std::filesystem::path tool_cache_folder();

// Raise it with every change to what make_voxel_tool() or the generated tools give: it is part of the key.
inline constexpr int kToolFormat = 2;

// The name of the tool's file, from all that it depends on: a SHA-256 of the mesh (or of what it is read
// from) and the settings, to the last bit.
std::string tool_key(const std::string& mesh_sha256, const VoxelToolSettings& settings);
std::string sha256_of_mesh(const TriangleMesh& mesh);

// What is stored under a key: all of the tool, bit for bit, and what was reported when it was made.
struct StoredTool {
  VoxelTool tool;
  std::string report;
};

// Empty where there is no such file, or it is damaged, cut off, or of another key: its SHA-256 is verified.
std::optional<StoredTool> read_tool(const std::filesystem::path& folder, const std::string& key);

// Writes to a name of its own and renames, so that others see the whole file or none; makes the folder. A
// folder that cannot be written is no error, and makes the tool no less: false then.
bool write_tool(const std::filesystem::path& folder, const std::string& key, const StoredTool& stored);

}  // namespace remote_touch
