// The surface of a tool as points with normals: the pointshell of W. McNeely, K. Puterbaugh and J. Troy, "Six
// degree-of-freedom haptic rendering using voxel sampling", SIGGRAPH 1999.
#pragma once

#include <vector>

#include "core/dissertation/tool/shape/voxel_tool.h"

namespace remote_touch {

struct Pointshell {
  std::vector<Vec3> p_T, n_T;  // n_T: unit, into the tool

  std::size_t size() const { return p_T.size(); }
};

// Returns one point for each cube of the tool frame, of side spacing_m, that contains voxels of the shell.
// The point is the middle of that voxel which is nearest to the middle of the cube, moved onto the surface
// along the gradient of the field; no point if the gradient is zero. The source uses the middle of the cube.
Pointshell make_pointshell(const VoxelTool& tool, double spacing_m);

}  // namespace remote_touch
