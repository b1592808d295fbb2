// The tool "husky" lying on a gently curved surface, for the benchmarks of the 6-DOF method.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/touch_finder.h"
#include "core/mesh/voxel_tool.h"
#include "core/rendering/frames_and_outputs.h"

namespace remote_touch::benchmarks {

// outer_field is for the continuous rule.
std::shared_ptr<const VoxelTool> generated_tool(const std::string& name, bool outer_field = false);

struct ToolScene {
  std::string name;
  std::shared_ptr<const VoxelTool> tool;
  PointCloud cloud;  // unorganised, with normals, around the origin of x and z
  // The pose of the tool on its side at the surface, pressed on so that some points are in shell voxels, and
  // the pose out of reach of all points.
  ToolPose in_contact, separated;
};

// The cloud has side x side points. The device of a tick is pressed below the surface.
ToolScene tool_scene(const std::string& name, std::shared_ptr<const VoxelTool> tool, int side,
                     double spacing_m);

// Numbers of the points in shell or interior voxels, by a plain loop over all of them.
std::vector<std::uint32_t> naive_list(const VoxelTool& tool, const PointCloud& cloud, const ToolPose& pose);
// True if the finder's list of the scene's points is that of naive_list().
bool list_right(const TouchFinder& finder, const ToolScene& scene, const ToolPose& pose);

// Returns the pose, which changes a little from call to call.
ToolPose shaken(ToolPose pose, int call);

// Pose of the device in a slide along x at 0.1 m/s, to and fro, a centimetre below the pose of contact.
ToolPose device_at(const ToolScene& scene, int tick);
inline constexpr int kSlideTicks = 600;  // there and back

}  // namespace remote_touch::benchmarks
