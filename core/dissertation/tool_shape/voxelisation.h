// A mesh as voxels of three values, 6.2.2.
#pragma once

#include "core/dissertation/tool_shape/voxel_tool.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"

namespace remote_touch {

// Returns a grid around the mesh with a margin of kFieldMargin_m or more on every side. The number of cells
// along an axis is odd or even, so that the sides of the mesh's box lie near planes between cells. A side
// through the centres of cells would be bad, because these would be neither inside nor outside. pre: vertices
// finite, at least one.
VoxelGrid grid_around(const TriangleMesh& mesh, double voxel_m);

// Returns the number of cells of grid_around(); a double, so that it cannot overflow.
double cells_around(const TriangleMesh& mesh, double voxel_m);

// Returns 1 for the cells that the surface passes through or touches (separating axes, Akenine-Moeller 2001),
// else 0. The test has a tolerance of 1e-9 voxels, towards 1.
std::vector<std::uint8_t> crossed_cells(const TriangleMesh& mesh, const VoxelGrid& grid);

// The nodes inside a closed mesh. `inside` is 1 for the nodes that the mesh winds around at least once: those
// in the union of parts that overlap, but not those in a hollow. Lines in x through the nodes are crossed
// with the mesh, in integers, so that a line through an edge or a corner is counted correctly. The integers
// round y and z by less than a millionth of a voxel, or by more if the grid has more than 1023 cells along y
// or z.
struct InsideNodes {
  std::vector<std::uint8_t> inside;
  bool negative = false;  // some part is inside out, and not a hollow in another
};
InsideNodes inside_nodes(const TriangleMesh& mesh, const VoxelGrid& grid);

// Returns the nodes inside a mesh with gaps: those where the generalised winding number is above 1/2. Only
// every fourth node along each axis is evaluated far from the surface. crossed: the result of
// crossed_cells().
std::vector<std::uint8_t> inside_nodes_of_open(const TriangleTree& tree, const VoxelGrid& grid,
                                               const std::vector<std::uint8_t>& crossed);

// Returns the voxels of the field. A cell is solid if the field in its centre is negative. The shell consists
// of the solid cells that touch a free one, even if only at a corner, so that no step of half a voxel leads
// from outside into the interior. The shell lies inside the surface, so a slab of thickness h has an interior
// of h - 2w, where w is the size of a voxel, 6.2.4.
std::vector<Voxel> voxels_of(const VoxelGrid& grid, const std::vector<float>& distance_m);

}  // namespace remote_touch
