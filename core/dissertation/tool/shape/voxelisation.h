// A mesh as voxels of three values, 6.2.2.
#pragma once

#include "core/dissertation/tool/shape/triangle_mesh.h"
#include "core/dissertation/tool/shape/triangle_tree.h"
#include "core/dissertation/tool/shape/voxel_tool.h"

namespace remote_touch {

// A grid around the mesh with a margin of kFieldMargin_m on every side. It is placed so that the sides of the
// mesh's box, and so the faces of a box, run between cells rather than through their centres, which would be
// neither inside nor outside. pre: vertices finite, at least one.
VoxelGrid grid_around(const TriangleMesh& mesh, double voxel_m);

// Returns the number of cells of grid_around(); a double, so that it cannot overflow.
double cells_around(const TriangleMesh& mesh, double voxel_m);

// 1 for the cells that the surface passes through or touches (separating axes, Akenine-Moeller 2001). The
// test has a tolerance of 1e-9 voxels, towards 1.
std::vector<std::uint8_t> crossed_cells(const TriangleMesh& mesh, const VoxelGrid& grid);

// 1 for the nodes that a closed mesh winds around at least once: inside the union of parts that overlap, but
// not in a hollow. Computed along lines in x through the nodes, in integers, so that a line through an edge
// or a corner is counted correctly; for this y and z are rounded to less than a millionth of a voxel.
struct InsideNodes {
  std::vector<std::uint8_t> inside;
  bool negative = false;  // some part is inside out, and not a hollow in another
};
InsideNodes inside_nodes(const TriangleMesh& mesh, const VoxelGrid& grid);

// The same for a mesh with gaps: where the generalised winding number is above 1/2. Far from the surface only
// every fourth node is evaluated.
std::vector<std::uint8_t> inside_nodes_of_open(const TriangleTree& tree, const VoxelGrid& grid,
                                               const std::vector<std::uint8_t>& crossed);

// The voxels of the field: a cell is solid where the field in its centre is negative; the shell is the solid
// cells that touch a free one, even if only at a corner, so that no step of half a voxel leads from outside
// into the interior. The shell lies inside the surface: a slab of thickness h has an interior of h - 2w,
// 6.2.4.
std::vector<Voxel> voxels_of(const VoxelGrid& grid, const std::vector<float>& distance_m);

}  // namespace remote_touch
