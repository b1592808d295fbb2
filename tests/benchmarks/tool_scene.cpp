#include "tests/benchmarks/tool_scene.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch::benchmarks {

namespace {

constexpr double kAmplitude_m = 5e-4, kWave_per_m = 50;
constexpr std::size_t kPressed = 20;  // least number of points in the tool in contact

// Positions are compared, not numbers, because the finder keeps its points in an order of its own.
using Places = std::set<std::array<double, 3>>;

Vec3 surface_point(double x, double z) {
  return {x, kAmplitude_m * std::sin(kWave_per_m * x) * std::cos(0.7 * kWave_per_m * z), z};
}

Vec3 surface_normal(double x, double z) {
  const double slope = kAmplitude_m * kWave_per_m, a = kWave_per_m * x, b = 0.7 * kWave_per_m * z;
  return Vec3(-slope * std::cos(a) * std::cos(b), 1, 0.7 * slope * std::sin(a) * std::sin(b)).normalized();
}

// The pose is lowered by steps of a tenth of a millimetre until enough points are in the tool.
ToolPose pressed(const VoxelTool& tool, const PointCloud& cloud) {
  ToolPose pose{{1e-4, tool.reach_m, 2e-4}, rotation({0.02, 0.4, -0.03})};
  while (naive_list(tool, cloud, pose).size() < kPressed && pose.p_W.y() > -tool.reach_m)
    pose.p_W.y() -= 1e-4;
  return pose;
}

}  // namespace

std::shared_ptr<const VoxelTool> generated_tool(const std::string& name, bool outer_field) {
  const GeneratedTool* found = find_generated_tool(name);
  if (!found) std::abort();
  ToolReport report;
  VoxelToolSettings settings;
  settings.outer_field = outer_field;
  return std::make_shared<const VoxelTool>(make_voxel_tool(found->make(), settings, report));
}

ToolScene tool_scene(const std::string& name, std::shared_ptr<const VoxelTool> tool, int side,
                     double spacing_m) {
  ToolScene scene{name, std::move(tool), {}, {}, {}};
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const double x = (i - 0.5 * (side - 1)) * spacing_m, z = (j - 0.5 * (side - 1)) * spacing_m;
      scene.cloud.append(surface_point(x, z), surface_normal(x, z));
    }
  scene.in_contact = scene.separated = pressed(*scene.tool, scene.cloud);
  scene.separated.p_W.y() += 0.3;
  return scene;
}

std::vector<std::uint32_t> naive_list(const VoxelTool& tool, const PointCloud& cloud, const ToolPose& pose) {
  const VoxelGrid& grid = tool.grid;
  std::vector<std::uint32_t> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p_T = pose.q_WT.conjugate() * (cloud.point(i) - pose.p_W);
    const Vec3 u = (p_T - grid.origin_T) / grid.size_m;
    if (!(u.minCoeff() >= 0 && u.x() < grid.cells[0] && u.y() < grid.cells[1] && u.z() < grid.cells[2]))
      continue;
    const auto column = static_cast<std::size_t>(u.x()), row = static_cast<std::size_t>(u.y()),
               layer = static_cast<std::size_t>(u.z());
    const auto columns = static_cast<std::size_t>(grid.cells[0]),
               rows = static_cast<std::size_t>(grid.cells[1]);
    if (tool.voxels[(layer * rows + row) * columns + column] != Voxel::free)
      found.push_back(static_cast<std::uint32_t>(i));
  }
  return found;
}

bool list_right(const TouchFinder& finder, const ToolScene& scene, const ToolPose& pose) {
  Places found, expected;
  for (const std::uint32_t i : finder.in_tool(pose)) {
    const Vec3 p = finder.cloud().point(i);
    found.insert({p.x(), p.y(), p.z()});
  }
  for (const std::uint32_t i : naive_list(*scene.tool, scene.cloud, pose))
    expected.insert({scene.cloud.x[i], scene.cloud.y[i], scene.cloud.z[i]});
  return found == expected;
}

ToolPose shaken(ToolPose pose, int call) {
  pose.p_W.x() += 1e-6 * (call % 64);
  return pose;
}

ToolPose device_at(const ToolScene& scene, int tick) {
  constexpr double kWay_m = 1e-4;  // way of the device in one tick
  const int half = kSlideTicks / 2, t = tick % kSlideTicks;
  ToolPose device = scene.in_contact;
  device.p_W += Vec3(kWay_m * ((t < half ? t : kSlideTicks - t) - half / 2), -0.01, 0);
  return device;
}

}  // namespace remote_touch::benchmarks
