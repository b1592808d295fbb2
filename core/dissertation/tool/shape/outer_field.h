// The distance field of a tool, lowered so that it is nowhere positive in the tool.
//
// The trilinear field between the nodes is not the distance: at sharp edges, and in parts thinner than a
// voxel, it is positive at positions inside the tool. Lowering the nodes of each cell corrects this. The
// amount is the largest value that the field has on the surface in that cell: zero where the surface is flat,
// part of a voxel at its edges.
//
// This is enough because a trilinear field is harmonic within a cell, and also within a face and along an
// edge of the cell. So its largest value on the solid part of a cell is either on the surface of the mesh or
// at a node inside, where it is negative.
#pragma once

#include <vector>

#include "core/dissertation/tool/shape/distance_field.h"
#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// Returns the lowered distance of every node. distance_m: signed distance of every node; the result is
// nowhere above it. The trilinear field of the result is nowhere above 0 in or on a closed mesh, except for a
// nanometre of rounding. pre: the grid encloses the mesh.
std::vector<float> outer_field(const TriangleMesh& mesh, const VoxelGrid& grid,
                               const std::vector<float>& distance_m);

// Returns an upper bound of the length of the trilinear field's gradient where the field is within_m or less.
double max_slope(const VoxelGrid& grid, const std::vector<float>& distance_m,
                 double within_m = kExactField_m);

}  // namespace remote_touch
