// A tool as a sphere tree, made from its mesh beforehand, 7.4: what the dissertation takes from the Sphere
// Tree Toolkit [118]. Leaves are balls inscribed in the tool, all grown by the same growth: about the least
// with which so many of them cover the surface.
#pragma once

#include <string>

#include "core/sphere_tree/sphere_tree.h"
#include "core/tool/voxels/voxel_tool.h"

namespace remote_touch {

struct ToolSpheres {
  SphereTree spheres;  // in the tool frame
  double inflation_m = 0;
  // How far the union of the leaves is from the mesh: the most that a leaf stands out of it, and the most
  // that the surface stands out of all leaves, both measured on dense samples. The first can be no more than
  // inflation_m; the leaves were grown until nothing was left of the second on these samples.
  double outside_m = 0, inside_m = 0;
};
std::string text(const ToolSpheres& spheres);

inline constexpr int kMinLeaves = 1, kMaxLeaves = 10000;

// pre: max_leaves in the range above. Fewer leaves are made where they do. Throws InputError for a tool
// without a node of its grid inside.
ToolSpheres make_tool_spheres(const VoxelTool& tool, int max_leaves);

}  // namespace remote_touch
