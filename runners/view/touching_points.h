// Which points of a frame touch the proxy or the tool in each tick.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cloud/point_cloud.h"
#include "core/tool/dynamics/tool_pose.h"
#include "core/tool/voxels/voxel_tool.h"

namespace remote_touch {

// Of each tick the numbers of the points that touch, ascending. Where a position is not finite nothing
// touches.
using TouchingPoints = std::vector<std::vector<std::uint32_t>>;

// Those whose regions are within radius_m of the proxy's centre: what contact_count counts with r2, (4.1),
// (5.2).
TouchingPoints touching_proxy(std::span<const Vec3> centres_W, double radius_m, const PointCloud& cloud);

inline constexpr double kTouchingTool_m = 1e-4;  // this near to the tool's surface, or inside
TouchingPoints touching_tool(const VoxelTool& tool, std::span<const ToolPose> poses, const PointCloud& cloud);

}  // namespace remote_touch
