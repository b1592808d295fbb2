// A tool as a sphere tree, made from its mesh in advance, 7.4: the dissertation uses the Sphere Tree Toolkit
// [118] for this. Leaves are balls inscribed in the tool, all enlarged by the same inflation_m. It is about
// the smallest with which max_leaves of them cover the surface.
#pragma once

#include <string>

#include "core/dissertation/sphere_tree/sphere_tree.h"
#include "core/dissertation/tool/shape/voxel_tool.h"

namespace remote_touch {

struct ToolSpheres {
  SphereTree spheres;  // tree in the tool frame
  double inflation_m = 0;
  // Deviation of the union of the leaves from the mesh, measured on dense samples. outside_m: largest
  // distance between the mesh and a position of a leaf outside it, at most inflation_m. surface_outside_m:
  // largest distance between the leaves and a position of the surface outside them; 0 but for rounding,
  // because the leaves were enlarged until they contained these samples.
  double outside_m = 0, surface_outside_m = 0;
};
std::string text(const ToolSpheres& spheres);

inline constexpr int kMinLeaves = 1, kMaxLeaves = 10000;

// Makes at most max_leaves leaves, or fewer if these suffice. pre: kMinLeaves <= max_leaves <= kMaxLeaves.
// Throws InputError if no node of the tool's grid is inside the tool.
ToolSpheres make_tool_spheres(const VoxelTool& tool, int max_leaves);

}  // namespace remote_touch
