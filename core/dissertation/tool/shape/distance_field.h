// The signed distance to a mesh at the nodes of a grid.
#pragma once

#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/mesh/triangle_tree.h"

namespace remote_touch {

// Returns the distance at every node, metres, positive outside. Nodes within kExactField_m of the surface
// have the distance to the nearest triangle. Only a few triangles are compared for nodes farther away: those
// nearest to the corners of a cube of 4 x 4 x 4 cells around the node. The result is never too small. It is
// too large only if the corners have different nearest triangles: by less than a voxel, and mostly not at
// all.
inline constexpr double kExactField_m = 3e-3;
std::vector<float> distance_field(const TriangleTree& tree, const VoxelGrid& grid,
                                  const std::vector<std::uint8_t>& inside_nodes);

}  // namespace remote_touch
