#include "runners/experiment/mesh_files/loaded_tool.h"

#include <cmath>
#include <type_traits>

#include "analysis/storage/digest.h"
#include "core/dissertation/tool_motion/sphere_tree_renderer.h"
#include "core/mesh/triangle_mesh.h"
#include "runners/experiment/mesh_files/mesh_file.h"
#include "runners/experiment/settings/cache_file.h"

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

const CacheKind kSpheresKind{"spheres", kSpheresFormat};

// A tree as lists. It can be built again from its leaves and the number of leaves of each node of the lowest
// level.
struct FlatTree {
  std::vector<double> leaves;  // x, y, z, radius
  std::vector<std::uint32_t> counts;
};

FlatTree flat(const SphereTree& tree) {
  FlatTree all;
  for (const Sphere& leaf : tree.leaves())
    all.leaves.insert(all.leaves.end(), {leaf.centre.x(), leaf.centre.y(), leaf.centre.z(), leaf.radius_m});
  if (!tree.empty())
    for (const SphereNode& node : tree.level(0)) all.counts.push_back(node.count);
  return all;
}

// Builds the tree. Returns false if the counts do not fit the number of leaves, or if there are none.
bool grow(const FlatTree& flat, SphereTree& tree) {
  std::size_t at = 0;
  for (const std::size_t count : flat.counts) {
    if (count == 0 || 4 * count > flat.leaves.size() - at) return false;
    std::vector<Sphere> node;
    for (std::size_t i = 0; i < count; ++i, at += 4)
      node.push_back({{flat.leaves[at], flat.leaves[at + 1], flat.leaves[at + 2]}, flat.leaves[at + 3]});
    tree.add(node);
  }
  if (tree.empty() || at != flat.leaves.size()) return false;
  tree.finish();
  return true;
}

// Packs or unpacks every field, in the same order.
template <class Direction, class Tree, class Spheres>
void visit(Direction& pack, Tree& tree, Spheres& spheres) {
  pack.list(tree.leaves), pack.list(tree.counts);
  pack.value(spheres.inflation_m), pack.value(spheres.outside_m), pack.value(spheres.surface_outside_m);
}

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

using Tool = std::shared_ptr<const VoxelTool>;

std::unique_ptr<Renderer> renderer_of(const ToolParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<ToolRenderer>(motion, tool, kernels);
}
std::unique_ptr<Renderer> renderer_of(const TrackedToolParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<TrackedToolRenderer>(motion, tool, kernels);
}

// The rules for comparison have settings of their own, none of which is live.
class ToolToCompare final : public ToolRenderer {
 public:
  using ToolRenderer::ToolRenderer;
  Parameters live_parameters() override { return {}; }
};
std::unique_ptr<Renderer> renderer_of(const ToolPenaltyParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<ToolToCompare>(tool_parameters(motion), tool, kernels,
                                         make_penalty_motion(motion, *tool));
}
std::unique_ptr<Renderer> renderer_of(const ToolGodObjectParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<ToolToCompare>(tool_parameters(motion), tool, kernels,
                                         std::make_unique<GodObjectMotion>(motion, *tool));
}
std::unique_ptr<Renderer> renderer_of(const InnerSphereParameters& motion, const Tool& tool,
                                      const Kernels& kernels) {
  return std::make_unique<ToolToCompare>(tool_parameters(motion), tool, kernels,
                                         std::make_unique<InnerSphereMotion>(motion, *tool));
}

template <class MotionSettings>
ToolSettings tool_for(ToolSettings tool, const MotionSettings& motion) {
  if constexpr (std::is_same_v<MotionSettings, TrackedToolParameters>) return tool_for(tool, motion.tool);
  if constexpr (std::is_same_v<MotionSettings, ToolParameters>)
    tool.outer_field = motion.contact_rule == ContactRule::continuous;
  if constexpr (std::is_same_v<MotionSettings, ToolGodObjectParameters>) tool.outer_field = true;
  return tool;
}

std::unique_ptr<Renderer> renderer_of(const ToolParameters& motion, const ToolOfSpheres& loaded,
                                      const Kernels& kernels) {
  const std::shared_ptr<const SphereTree> spheres(loaded.spheres, &loaded.spheres->spheres);
  return std::make_unique<SphereTreeRenderer>(motion, loaded.tool, spheres, kernels);
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

std::string spheres_key(const std::string& tool_key, int max_leaves) {
  CacheWriter pack;
  pack.text(tool_key);
  pack.value(max_leaves);
  return pack.hex();
}

std::optional<ToolSpheres> read_spheres(const fs::path& folder, const std::string& key) {
  ToolSpheres spheres;
  FlatTree tree;
  const auto take = [&](Unpacker& unpack) { visit(unpack, tree, spheres); };
  if (!read_cache_file(folder, kSpheresKind, key, take) || !grow(tree, spheres.spheres)) return {};
  return spheres;
}

bool write_spheres(const fs::path& folder, const std::string& key, const ToolSpheres& spheres) {
  const FlatTree tree = flat(spheres.spheres);
  return write_cache_file(folder, kSpheresKind, key, [&](CacheWriter& pack) { visit(pack, tree, spheres); });
}

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

std::vector<InputPart> input_files(const ToolSettings& s) {
  return mesh_files_of(s.mesh);
}

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

template <class MotionSettings>
ToolFromMesh<MotionSettings>::ToolFromMesh(const Settings& settings, double, const Kernels& kernels)
    : LoadedRenderer(
          renderer_of(settings.motion, load_tool(tool_for(settings.tool, settings.motion)), kernels)) {}

template class ToolFromMesh<ToolParameters>;
template class ToolFromMesh<TrackedToolParameters>;
template class ToolFromMesh<ToolPenaltyParameters>;
template class ToolFromMesh<ToolGodObjectParameters>;
template class ToolFromMesh<InnerSphereParameters>;

Parameters parameters(LoadedSpheres::Settings& s) {
  Parameters all = parameters(s.tool);
  all.push_back({"max_tool_leaves", &s.leaves, kMinLeaves, kMaxLeaves,
                 "maximum number of spheres of the tool, 7.4; fewer spheres are less accurate"});
  for (Parameter& p : region_parameters(s.motion)) all.push_back(std::move(p));
  return all;
}

std::string validate(const LoadedSpheres::Settings& s) {
  if (const std::string tool = validate(s.tool); !tool.empty()) return tool;
  // PairChoice drops the pairs that no motion of up to half the look-ahead can violate.
  if (2 * s.motion.max_step_m > s.motion.look_ahead_m)
    return "look_ahead_m = " + std::to_string(s.motion.look_ahead_m) + ": expected twice max_step_m or more";
  return validate(s.motion);
}

std::vector<InputPart> input_files(const LoadedSpheres::Settings& s) {
  return input_files(s.tool);
}

LoadedSpheres::LoadedSpheres(const Settings& settings, double, const Kernels& kernels)
    : LoadedRenderer(
          renderer_of(settings.motion, load_tool_of_spheres(settings.tool, settings.leaves), kernels)) {}

}  // namespace remote_touch
