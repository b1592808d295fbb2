#include "runners/experiment/tool_files/tool_loading.h"

#include <filesystem>

#include "analysis/storage/digest.h"
#include "core/dissertation/tool/shape/generated_tools.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "runners/experiment/provenance/cache_file.h"
#include "runners/experiment/tool_files/spheres_cache.h"
#include "runners/experiment/tool_files/tool_cache.h"

namespace remote_touch {

namespace fs = std::filesystem;

Parameters parameters(ToolSettings& s) {
  return {
      {"tool_mesh", &s.mesh, 0, 0,
       "tool: " + names_of_built_in_meshes() + "; or a closed mesh, OBJ, PLY or STL"},
      {"tool_size_m", &s.size_m, 0, 10, "longest side of the tool's bounding box; 0: the mesh is in metres"},
      {"tool_voxel_m", &s.voxel_m, 1e-5, 0.1, "size of the tool's voxels, 6.2.2"},
      {"tool_repair", &s.repair, 0, 0,
       "repair a mesh that is not closed: weld vertices, orient faces, fill holes"},
  };
}

std::string validate(const ToolSettings& s) {
  if (std::string problem = mesh_name_problem("tool_mesh", s.mesh); !problem.empty()) return problem;
  if (s.size_m > 0 && s.size_m < 2 * s.voxel_m)
    return "tool_size_m = " + std::to_string(s.size_m) +
           ": expected two voxels (tool_voxel_m = " + std::to_string(s.voxel_m) + ") or more, or 0";
  return {};
}

std::vector<RecordingPart> input_files(const ToolSettings& s) {
  return mesh_files_of(s.mesh);
}

namespace {

struct KeyedTool {
  std::string key;  // key in the cache
  StoredTool stored;
};

KeyedTool built_or_cached(const ToolSettings& s) {
  const VoxelToolSettings settings{s.voxel_m, s.size_m, s.repair, s.outer_field};
  const GeneratedTool* built_in = find_generated_tool(s.mesh);
  const fs::path file = built_in != nullptr ? "" : find_mesh_file("renderer.tool_mesh", s.mesh);
  TriangleMesh mesh;
  if (built_in != nullptr) mesh = built_in->make();
  // The key of a mesh file comes from its bytes and not from its mesh, because reading the mesh takes longer
  // than reading its tool from the cache.
  const std::string source =
      built_in != nullptr ? sha256_of_mesh(mesh)
                          : sha256_of_file(file) + file.extension().string() + " " + mesh_reader_version();
  const fs::path folder = cache_folder();
  const std::string key = tool_key(source, settings);
  if (std::optional<StoredTool> stored = read_tool(folder, key)) return {key, *std::move(stored)};
  if (built_in == nullptr) mesh = read_mesh(file);
  ToolReport made;
  StoredTool stored;
  stored.tool = make_voxel_tool(std::move(mesh), settings, made, "renderer.tool_mesh = " + s.mesh);
  stored.report = text(made);
  write_tool(folder, key, stored);
  return {key, std::move(stored)};
}

}  // namespace

std::shared_ptr<const VoxelTool> load_tool(const ToolSettings& s, std::string* report) {
  KeyedTool made = built_or_cached(s);
  if (report != nullptr) *report = made.stored.report;
  return std::make_shared<const VoxelTool>(std::move(made.stored.tool));
}

ToolOfSpheres load_tool_of_spheres(const ToolSettings& s, int max_leaves, std::string* report) {
  KeyedTool made = built_or_cached(s);
  const auto tool = std::make_shared<const VoxelTool>(std::move(made.stored.tool));
  const fs::path folder = cache_folder();
  const std::string key = spheres_key(made.key, max_leaves);
  std::optional<ToolSpheres> spheres = read_spheres(folder, key);
  if (!spheres) {
    spheres = make_tool_spheres(*tool, max_leaves);
    write_spheres(folder, key, *spheres);
  }
  if (report != nullptr) *report = made.stored.report + "\n" + text(*spheres);
  return {tool, std::make_shared<const ToolSpheres>(*std::move(spheres))};
}

}  // namespace remote_touch
