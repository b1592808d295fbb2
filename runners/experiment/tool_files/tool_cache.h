// The cache of tools on disk, so that the runs of a sweep do not make their tool again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/dissertation/tool/shape/voxel_tool.h"

namespace remote_touch {

// Version of the layout of the file, in its first line.
inline constexpr int kToolFormat = 2;

// Returns the key of the tool in the cache: a hash of all that the tool depends on. This is the build of the
// program, a SHA-256 of the mesh (or of the file from which it is read), and the settings, to the last bit.
std::string tool_key(const std::string& mesh_sha256, const VoxelToolSettings& settings);
std::string sha256_of_mesh(const TriangleMesh& mesh);

// The content that is stored under a key: the tool, bit for bit, and the report from when it was made.
struct StoredTool {
  VoxelTool tool;
  std::string report;
};

// Returns nothing if there is no such file, or if it is damaged, cut off, or of another key. The SHA-256 of
// the file is verified.
std::optional<StoredTool> read_tool(const std::filesystem::path& folder, const std::string& key);

// Writes the file under a temporary name and renames it, so that other processes see the whole file or none.
// Creates the folder. Returns false if the file cannot be written, which is not an error.
bool write_tool(const std::filesystem::path& folder, const std::string& key, const StoredTool& stored);

}  // namespace remote_touch
