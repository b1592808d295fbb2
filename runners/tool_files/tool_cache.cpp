#include "runners/tool_files/tool_cache.h"

#include <charconv>
#include <cmath>
#include <cstdlib>

#include "core/parameters/input_error.h"
#include "core/tool/mesh/mesh_corners.h"
#include "runners/tool_files/cache_file.h"

namespace remote_touch {

namespace fs = std::filesystem;

namespace {

const CacheKind kToolKind{"tool", kToolFormat};

static_assert(sizeof(Vec3) == 3 * sizeof(double));  // lists of vectors are lists of numbers

// Every field, in order, for both directions.
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

// What a program that makes tools cannot have written, whatever the hash says.
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

// Asked here and not in runners/cli: a cache is no input, no result depends on it, and whatever makes tools,
// a test too, is to find the same one.
fs::path tool_cache_folder() {
  const auto from = [](const char* variable) {
    const char* value = std::getenv(variable);
    return fs::path(value != nullptr ? value : "");
  };
  if (const fs::path own = from("REMOTE_TOUCH_CACHE"); !own.empty()) return own;
  if (const fs::path caches = from("XDG_CACHE_HOME"); !caches.empty()) return caches / "remote-touch";
  if (const fs::path home = from("HOME"); !home.empty()) return home / ".cache" / "remote-touch";
  return {};
}

std::uintmax_t max_cache_bytes() {
  constexpr double kDefault_MB = 512, kBytes_per_MB = 1e6, kMax_MB = 1e9;
  const char* const set = std::getenv("REMOTE_TOUCH_CACHE_MB");
  if (set == nullptr || *set == '\0') return static_cast<std::uintmax_t>(kDefault_MB * kBytes_per_MB);
  const std::string text = set;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= kMax_MB))
    throw InputError("REMOTE_TOUCH_CACHE_MB = " + text, "expected a number of megabytes");
  return static_cast<std::uintmax_t>(value * kBytes_per_MB);
}

std::string sha256_of_mesh(const TriangleMesh& mesh) {
  CacheWriter pack;
  pack.list(mesh.vertices);
  pack.list(mesh.triangles);
  return pack.hex();
}

std::string tool_key(const std::string& mesh_sha256, const VoxelToolSettings& settings) {
  CacheWriter pack;
  pack.value(kToolFormat);
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
