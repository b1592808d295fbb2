#include "runners/presentation/view/touching_points.h"

#include <algorithm>

#include "core/geometry/vector.h"

namespace remote_touch {

namespace {

bool is_known(const ToolPose& pose) {
  return pose.p_W.allFinite() && pose.q_WT.coeffs().allFinite();
}

double distance_m(const VoxelTool& tool, const ToolPose& pose, const Vec3& p_W) {
  return sample_field(tool, pose.q_WT.conjugate() * (p_W - pose.p_W)).distance_m;
}

// Returns the points that can touch in any of the poses. The distance of a point changes by no more than the
// tool moves. Returns none if no pose is finite.
std::vector<std::uint32_t> candidates(const VoxelTool& tool, std::span<const ToolPose> poses,
                                      const PointCloud& cloud) {
  // The pose from which the tool moves least: near the middle.
  auto middle =
      std::find_if(poses.begin() + static_cast<std::ptrdiff_t>(poses.size() / 2), poses.end(), is_known);
  if (middle == poses.end()) middle = std::find_if(poses.begin(), poses.end(), is_known);
  std::vector<std::uint32_t> found;
  if (middle == poses.end()) return found;
  double motion_m = 0;
  for (const ToolPose& pose : poses)
    if (is_known(pose))
      motion_m = std::max(motion_m, max_point_displacement_m(displacement(*middle, pose), tool.reach_m));
  // Outside the distance field the distance is known only to within a voxel.
  const double max_m = motion_m + kTouchingTool_m + tool.grid.size_m, far_m = tool.reach_m + max_m;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 p = cloud.point(i);
    if ((p - middle->p_W).squaredNorm() > far_m * far_m) continue;
    if (distance_m(tool, *middle, p) <= max_m) found.push_back(static_cast<std::uint32_t>(i));
  }
  return found;
}

}  // namespace

TouchingPoints touching_proxy(std::span<const Vec3> centres_W, double radius_m, const PointCloud& cloud) {
  BoundingBox box;
  for (const Vec3& centre : centres_W)
    if (centre.allFinite()) box.extend(centre);
  const auto region_m = [&](std::size_t i) {
    return cloud.fixture_radius_m.empty() ? 0 : cloud.fixture_radius_m[i];
  };
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < cloud.size() && !box.isEmpty(); ++i)
    if (cloud.is_measured(i) && box.exteriorDistance(cloud.point(i)) <= radius_m + region_m(i) + 1e-9)
      near.push_back(static_cast<std::uint32_t>(i));
  TouchingPoints touching;
  for (const Vec3& centre : centres_W) {
    std::vector<std::uint32_t>& now = touching.emplace_back();
    for (const std::uint32_t i : near)
      if ((centre - cloud.point(i)).norm() - region_m(i) <= radius_m) now.push_back(i);
  }
  return touching;
}

TouchingPoints touching_tool(const VoxelTool& tool, std::span<const ToolPose> poses,
                             const PointCloud& cloud) {
  const std::vector<std::uint32_t> near = candidates(tool, poses, cloud);
  TouchingPoints touching;
  for (const ToolPose& pose : poses) {
    std::vector<std::uint32_t>& now = touching.emplace_back();
    if (is_known(pose))
      for (const std::uint32_t i : near)
        if (distance_m(tool, pose, cloud.point(i)) <= kTouchingTool_m) now.push_back(i);
  }
  return touching;
}

}  // namespace remote_touch
