#include "runners/experiment/tool_files/tool_cache.h"

#include <cmath>

#include "core/mesh/triangle_mesh.h"
#include "runners/experiment/provenance/cache_file.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

const CacheKind kToolKind{"tool", kToolFormat};

static_assert(sizeof(Vec3) == 3 * sizeof(double));  // lists of vectors are lists of numbers

// Packs or unpacks every field, in the same order.
template <class Direction, class Stored>
void visit(Direction& pack, Stored& stored) {
  auto& tool = stored.tool;
  pack.list(tool.mesh.vertices);
  pack.list(tool.mesh.triangles);
  for (int i = 0; i < 3; ++i) pack.value(tool.grid.origin_T[i]), pack.value(tool.grid.cells[i]);
  pack.value(tool.grid.size_m);
  pack.list(tool.voxels);
  pack.list(tool.distance_m);
  pack.value(tool.volume_m3);
  for (int i = 0; i < 9; ++i) pack.value(tool.inertia_m2(i / 3, i % 3));
  pack.value(tool.reach_m);
  pack.text(stored.report);
}

// Returns false for a tool that no program that makes tools can have written, even if the hash of the file is
// right.
bool is_sound(const VoxelTool& tool) {
  std::size_t cells = 1, nodes = 1;
  for (const int along : tool.grid.cells)
    if (along < 1 || __builtin_mul_overflow(cells, static_cast<std::size_t>(along), &cells) ||
        __builtin_mul_overflow(nodes, static_cast<std::size_t>(along) + 1, &nodes))
      return false;
  return tool.voxels.size() == cells && tool.distance_m.size() == nodes && has_its_vertices(tool.mesh) &&
         tool.grid.origin_T.allFinite() && tool.grid.size_m > 0 && std::isfinite(tool.grid.size_m);
}

}  // namespace

std::string sha256_of_mesh(const TriangleMesh& mesh) {
  CacheWriter pack;
  pack.list(mesh.vertices);
  pack.list(mesh.triangles);
  return pack.hex();
}

std::string tool_key(const std::string& mesh_sha256, const VoxelToolSettings& settings) {
  CacheWriter pack;
  pack.text(build_for_keys());
  pack.text(mesh_sha256);
  pack.value(settings.voxel_m), pack.value(settings.size_m), pack.value(settings.repair);
  if (settings.outer_field) pack.text("outer field");
  return pack.hex();
}

std::optional<StoredTool> read_tool(const fs::path& folder, const std::string& key) {
  StoredTool stored;
  if (!read_cache_file(folder, kToolKind, key, [&](Unpacker& unpack) { visit(unpack, stored); })) return {};
  if (!is_sound(stored.tool)) return {};
  return stored;
}

bool write_tool(const fs::path& folder, const std::string& key, const StoredTool& stored) {
  return write_cache_file(folder, kToolKind, key, [&](CacheWriter& pack) { visit(pack, stored); });
}

}  // namespace remote_touch
