#include "runners/presentation/result_pages.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>
#include <utility>

#include "core/parameters/parameter.h"
#include "runners/experiment/mesh_files/loaded_tool.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {

template <class Number>
Json PackedArrays::add(const std::vector<Number>& values) {
  constexpr const char* kKind = std::is_floating_point_v<Number> ? "f" : std::is_signed_v<Number> ? "i" : "u";
  bytes_.resize((bytes_.size() + 7) / 8 * 8);
  const std::size_t at = bytes_.size();
  bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number));
  return {{"at", at}, {"type", kKind + std::to_string(8 * sizeof(Number))}, {"length", values.size()}};
}
template Json PackedArrays::add(const std::vector<double>&);
template Json PackedArrays::add(const std::vector<float>&);
template Json PackedArrays::add(const std::vector<std::int32_t>&);
template Json PackedArrays::add(const std::vector<std::uint32_t>&);
template Json PackedArrays::add(const std::vector<std::uint16_t>&);
template Json PackedArrays::add(const std::vector<std::uint8_t>&);

Json json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

// A camera looks along its z axis, and its y axis points down.
Json sensor_json(const RigidTransform& X_WC) {
  return {{"position_m", json_of(Vec3(X_WC.translation()))},
          {"forward", json_of(Vec3(X_WC.linear().col(2)))},
          {"up", json_of(Vec3(-X_WC.linear().col(1)))}};
}

namespace {

constexpr const char* kLeaves = "max_tool_leaves";

ToolSettings tool_settings(const Json& renderer) {
  ToolSettings settings;
  const Parameters known = parameters(settings);
  Json of_tool = Json::object();
  for (const auto& item : renderer.items())
    if (std::any_of(known.begin(), known.end(), [&](const Parameter& p) { return p.name == item.key(); }))
      of_tool[item.key()] = item.value();
  read_parameters(of_tool, known, "renderer");
  return settings;
}

std::vector<float> centres_and_radii(std::span<const Sphere> spheres) {
  std::vector<float> list;
  for (const Sphere& one : spheres)
    for (const double number : {one.centre.x(), one.centre.y(), one.centre.z(), one.radius_m})
      list.push_back(static_cast<float>(number));
  return list;
}

constexpr double kFinestGrid = 65535;      // steps along the longest side
constexpr double kLeastStep_m = 1e-9;      // step for a mesh that is a single point
constexpr double kVisibleStep_m = 0.0002;  // a finer grid cannot be told from the mesh itself

// Numbers of a node along x, y and z, 16 bits each.
std::uint64_t node_of(const Vec3& p_O, const MeshOnGrid& grid) {
  std::uint64_t node = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double number = std::clamp((p_O[axis] - grid.low_O[axis]) / grid.step_m, 0.0, kFinestGrid);
    node = node << 16 | static_cast<std::uint64_t>(std::lround(number));
  }
  return node;
}

MeshOnGrid moved_to_grid(const PosedMesh& mesh, const Vec3& low_O, double step_m) {
  MeshOnGrid grid{low_O, step_m, {}, {}};
  std::unordered_map<std::uint64_t, std::uint32_t> vertex_at;
  std::vector<std::uint32_t> vertex_of;
  vertex_of.reserve(mesh.vertices_O.size());
  for (const Vec3& p_O : mesh.vertices_O) {
    const std::uint64_t node = node_of(p_O, grid);
    const auto [at, is_new] = vertex_at.try_emplace(node, static_cast<std::uint32_t>(vertex_at.size()));
    vertex_of.push_back(at->second);
    for (int shift = 32; is_new && shift >= 0; shift -= 16)
      grid.vertices.push_back(static_cast<std::uint16_t>(node >> shift));
  }
  for (const auto& [i, j, k] : mesh.triangles) {
    const std::uint32_t a = vertex_of[static_cast<std::size_t>(i)],
                        b = vertex_of[static_cast<std::size_t>(j)],
                        c = vertex_of[static_cast<std::size_t>(k)];
    if (a != b && b != c && c != a) grid.triangles.insert(grid.triangles.end(), {a, b, c});
  }
  return grid;
}

ShownPose shown_pose(const std::optional<RigidTransform>& X_WO) {
  ShownPose pose;
  pose.fill(std::numeric_limits<float>::quiet_NaN());
  if (!X_WO) return pose;
  const Eigen::Quaterniond q = Eigen::Quaterniond(X_WO->linear()).normalized();
  const Vec3 p = X_WO->translation();
  const double numbers[] = {p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()};
  std::transform(std::begin(numbers), std::end(numbers), pose.begin(),
                 [](double number) { return static_cast<float>(number); });
  return pose;
}

bool same_pose(const ShownPose& a, const ShownPose& b) {
  return a == b || (std::isnan(a[0]) && std::isnan(b[0]));
}

// Returns the largest part that each of the meshes may have, so that all together have at most `most`.
template <class Mesh, class SizeOf>
std::size_t limit_of_each(const std::vector<Mesh>& meshes, std::size_t most, SizeOf size_of) {
  std::vector<std::size_t> sizes;
  for (const Mesh& mesh : meshes) sizes.push_back(size_of(mesh));
  std::sort(sizes.begin(), sizes.end());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::size_t share = most / (sizes.size() - i);
    if (sizes[i] > share) return share;
    most -= sizes[i];
  }
  return std::numeric_limits<std::size_t>::max();
}

// Keeps every nth pose, beginning with the first, so that at most max_poses remain.
void thin(ShownMesh& mesh, std::size_t max_poses) {
  if (mesh.poses.size() <= max_poses) return;
  const std::size_t n = (mesh.poses.size() + max_poses - 1) / max_poses;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.poses.size(); i += n, ++kept)
    mesh.time_s[kept] = mesh.time_s[i], mesh.poses[kept] = mesh.poses[i];
  mesh.time_s.resize(kept), mesh.poses.resize(kept);
}

}  // namespace

ShownTool shown_tool(const Json& renderer) {
  const ToolSettings settings = tool_settings(renderer);
  if (!renderer.contains(kLeaves)) return {load_tool(settings), nullptr};
  ToolOfSpheres loaded = load_tool_of_spheres(settings, renderer[kLeaves].get<int>());
  return {std::move(loaded.tool), std::move(loaded.spheres)};
}

Json json_of(const ShownTool& tool, PackedArrays& numbers) {
  std::vector<float> vertices;
  std::vector<std::uint32_t> triangles;
  for (const Vec3& v : tool.tool->mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) vertices.push_back(static_cast<float>(v[axis]));
  for (const auto& triangle : tool.tool->mesh.triangles)
    for (const int corner : triangle) triangles.push_back(static_cast<std::uint32_t>(corner));
  Json json{{"vertices", numbers.add(vertices)}, {"triangles", numbers.add(triangles)}};
  if (tool.spheres) json["spheres"] = numbers.add(centres_and_radii(tool.spheres->spheres.leaves()));
  return json;
}

MeshOnGrid mesh_on_grid(const PosedMesh& mesh, std::size_t max_triangles) {
  BoundingBox box;
  for (const auto& triangle : mesh.triangles)
    for (const int corner : triangle) box.extend(mesh.vertices_O[static_cast<std::size_t>(corner)]);
  if (box.isEmpty()) return {};
  double step_m = std::max(box.sizes().maxCoeff() / kFinestGrid, kLeastStep_m);
  MeshOnGrid grid = moved_to_grid(mesh, box.min(), step_m);
  while (grid.triangles.size() > 3 * max_triangles) grid = moved_to_grid(mesh, box.min(), step_m *= 2);
  return grid;
}

std::vector<ShownMesh> shown_meshes(const Scenario& scenario, std::span<const double> time_s) {
  const std::vector<PosedMesh> meshes = scenario.true_meshes(time_s.front());
  const std::size_t max_triangles =
      limit_of_each(meshes, kMaxShownTriangles, [](const PosedMesh& mesh) { return mesh.triangles.size(); });
  std::vector<ShownMesh> shown;
  for (const PosedMesh& mesh : meshes)
    shown.push_back({mesh.name, mesh_on_grid(mesh, max_triangles), {}, {}});
  if (shown.empty()) return shown;
  for (const double t : time_s) {
    const std::vector<PosedMesh> now = scenario.true_meshes(t);
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const ShownPose pose = shown_pose(now[i].X_WO);
      if (!shown[i].poses.empty() && same_pose(shown[i].poses.back(), pose)) continue;
      shown[i].time_s.push_back(t), shown[i].poses.push_back(pose);
    }
  }
  const std::size_t max_poses =
      limit_of_each(shown, kMaxShownPoses, [](const ShownMesh& mesh) { return mesh.poses.size(); });
  for (ShownMesh& mesh : shown) thin(mesh, max_poses);
  return shown;
}

std::vector<ShownMesh> shown_meshes_of_live(const Scenario& scenario, double haptic_rate_hz) {
  constexpr double kMaxTimes = 2000;
  if (!scenario.truth_text().empty()) return {};  // a recording
  double end_s = 0;                               // from then on the scene rests
  for (const Phase& phase : scenario.phases())
    end_s = std::max(end_s, std::isfinite(phase.ends_s) ? phase.ends_s : phase.begins_s);
  const double steps = std::clamp(std::ceil(end_s * haptic_rate_hz), 1.0, kMaxTimes);
  std::vector<double> time_s;
  for (double i = 0; i <= steps; ++i) time_s.push_back(i / steps * end_s);
  return shown_meshes(scenario, time_s);
}

Json json_of(const ShownMesh& mesh, PackedArrays& numbers) {
  std::vector<float> poses;
  for (const ShownPose& pose : mesh.poses) poses.insert(poses.end(), pose.begin(), pose.end());
  return {{"name", mesh.name},
          {"low_m", json_of(mesh.mesh.low_O)},
          {"step_m", mesh.mesh.step_m},
          {"vertices", numbers.add(mesh.mesh.vertices)},
          {"triangles", numbers.add(mesh.mesh.triangles)},
          {"time_s", numbers.add(mesh.time_s)},
          {"poses", numbers.add(poses)}};
}

std::string note_on(const std::vector<ShownMesh>& meshes) {
  std::string note;
  for (const ShownMesh& mesh : meshes) {
    if (mesh.mesh.step_m <= kVisibleStep_m) continue;
    const std::string text = formatted("%.2g mm", 1000 * mesh.mesh.step_m);
    note += (note.empty() ? "" : "; ") +
            ("The mesh of " + mesh.name + " is drawn with vertices on a grid of ") + text +
            ": it has too many triangles for a page";
  }
  return note;
}

}  // namespace remote_touch
