// Meshes and tools: files of each kind, headers, and what the cache keeps of a tool.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "analysis/storage/digest.h"
#include "analysis/storage/other_processes.h"
#include "core/mesh/triangle_mesh.h"
#include "runners/experiment/mesh_files/loaded_tool.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "tests/fuzz/shared/fuzz_target.h"
#include "tests/fuzz/shared/lasting_child.h"

namespace remote_touch::fuzz::meshes {
namespace {

// Mesh files of each kind, read in a child process with limits.

void read_as_mesh(const std::string& name, std::string_view bytes) {
  const auto file = scratch_file(name, bytes);
  accepts(bytes, [&] {
    const TriangleMesh mesh = read_mesh(file, run_in_child());
    require(has_its_vertices(mesh), "a corner is a vertex");
  });
}

const Registered of_obj("mesh_obj", [](std::string_view bytes) { read_as_mesh("mesh.obj", bytes); });
const Registered of_ply("mesh_ply", [](std::string_view bytes) { read_as_mesh("mesh.ply", bytes); });
const Registered of_stl("mesh_stl", [](std::string_view bytes) { read_as_mesh("mesh.stl", bytes); });

// Headers of PLY files, which are checked before a library reads the file.

void read_header(std::string_view bytes) {
  const std::string problem = ply_problem(scratch_file("header.ply", bytes));
  if (!problem.empty()) accepts(bytes, [&] { throw InputError("header.ply", problem); });
}

const Registered of_header("ply_header", read_header);

// --- files of the cache ---

constexpr const char* kCacheKey = "key";

// Returns the folder of KEY.KIND. If the first byte is 'r', the rest is the whole file; otherwise the rest is
// its fields, after the first line and the key, and with the hash that makes them valid.
std::filesystem::path cache_folder(const std::string& kind, int version, std::string_view bytes) {
  ::unsetenv("REMOTE_TOUCH_CACHE_MB");  // a limit that the user has set would remove the files
  const std::string name = "cache/" + std::string(kCacheKey) + "." + kind;
  const std::string_view rest = bytes.substr(std::min<std::size_t>(1, bytes.size()));
  if (bytes.starts_with('r')) return scratch_file(name, rest).parent_path();
  MemoryPacker key;
  key.text(kCacheKey);
  std::string file = "remote-touch-" + kind + "/" + std::to_string(version) + "\n" + key.take();
  file += rest;
  Sha256 hash;
  hash.add(file.data(), file.size());
  return scratch_file(name, file + hash.hex()).parent_path();
}

// Requires that write() leaves the cache file as it was read.
template <class Write>
void require_written_as_read(const std::filesystem::path& folder, const std::string& kind, Write write) {
  const auto bytes = [&] {
    std::ifstream in(folder / (std::string(kCacheKey) + "." + kind), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  const std::string before = bytes();
  write();
  require(bytes() == before, "a cache file is written as it was read");
}

// Sphere trees of tools in the cache. A file that is read is written as it was.

void read_cached_spheres(std::string_view bytes) {
  const auto folder = cache_folder("spheres", kSpheresFormat, bytes);
  const auto spheres = read_spheres(folder, kCacheKey);
  if (!spheres) return;
  const SphereTree& tree = spheres->spheres;
  require(!tree.empty(), "a tool has spheres");
  for (std::size_t i = 0; i < tree.level(0).size(); ++i) tree.run(i);
  require_written_as_read(folder, "spheres", [&] { write_spheres(folder, kCacheKey, *spheres); });
}

const Registered of_spheres("spheres_cache", read_cached_spheres);

// Tools in the cache. A file that is read is sound, and is written as it was.

void read_cached_tool(std::string_view bytes) {
  const auto folder = cache_folder("tool", kToolFormat, bytes);
  const auto stored = read_tool(folder, kCacheKey);
  if (!stored) return;
  const VoxelTool& tool = stored->tool;
  require(has_its_vertices(tool.mesh), "a corner is a vertex");
  for (const int cells : tool.grid.cells) require(cells > 0, "a grid has cells");
  sample_field(tool, tool.grid.origin_T);
  require_written_as_read(folder, "tool", [&] { write_tool(folder, kCacheKey, *stored); });
}

const Registered of_tool("tool_cache", read_cached_tool);

}  // namespace
}  // namespace remote_touch::fuzz::meshes
