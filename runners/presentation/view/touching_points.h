// Points of a frame that touch the proxy or the tool in each tick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dissertation/tool/dynamics/tool_pose.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/geometry/point_cloud.h"

namespace remote_touch {

// Indices of the points that touch, ascending, for each tick. Empty for a tick whose position is not finite.
using TouchingPoints = std::vector<std::vector<std::uint32_t>>;

// Returns the points whose regions are within radius_m of the proxy's centre. With r2 these are the points
// that contact_count counts, (4.1), (5.2).
TouchingPoints touching_proxy(std::span<const Vec3> centres_W, double radius_m, const PointCloud& cloud);

inline constexpr double kTouchingTool_m = 1e-4;  // points up to this distance from the tool, or in it, touch
TouchingPoints touching_tool(const VoxelTool& tool, std::span<const ToolPose> poses, const PointCloud& cloud);

}  // namespace remote_touch
