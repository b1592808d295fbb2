// Two handwheels among forbidden regions as a camera sees them, 7.5.1, and tools of spheres that meet them,
// for the benchmarks of chapter 7. The camera is at the origin and faces along z.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/point_cloud.h"

namespace remote_touch::benchmarks {

inline constexpr double kRegion_m = 0.04;
inline constexpr double kWheelAway_m = 0.9, kWheelAside_m = 0.09, kRing_m = 0.045;

// The image has 640 x 480 pixels, with the wheels nearer_m nearer than usual. A wall without regions is
// behind them.
PointCloud frame_of_wheels(double nearer_m = 0);

struct SphereTool {
  std::shared_ptr<const VoxelTool> body;
  std::shared_ptr<const SphereTree> leaves;
  double reach_m;
};
SphereTool generated_sphere_tool(const std::string& name, int max_leaves);

// Pose of the device on its way around the first wheel at 0.1 m/s. It turns on the way, 10 mm inside the
// regions.
ToolPose device_around_wheel(int tick);
inline constexpr int kRoundTicks = 2828;

}  // namespace remote_touch::benchmarks
