// The signed distance to a mesh at the nodes of a grid, and the trilinear field between the nodes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/kernels/tool_kernels.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"
#include "core/mesh/voxel_tool.h"
#include "core/points/vector.h"

namespace remote_touch {

// The trilinear field in one cell of a tool's grid, m. Positions are relative to the cell's first node, in
// units of the cell's edge.
class CellField {
 public:
  CellField(const VoxelGrid& grid, const std::vector<float>& nodes, const std::array<int, 3>& cell) {
    const auto row = static_cast<std::size_t>(grid.cells[0]) + 1,
               layer = row * (static_cast<std::size_t>(grid.cells[1]) + 1);
    const float* n = nodes.data() + static_cast<std::size_t>(cell[0]) +
                     row * static_cast<std::size_t>(cell[1]) + layer * static_cast<std::size_t>(cell[2]);
    const std::array<double, 8> v{n[0],     n[1],         n[row],         n[row + 1],
                                  n[layer], n[layer + 1], n[layer + row], n[layer + row + 1]};
    c_ = v[0], x_ = v[1] - v[0], y_ = v[2] - v[0], z_ = v[4] - v[0];
    xy_ = v[3] - v[1] - v[2] + v[0], xz_ = v[5] - v[1] - v[4] + v[0], yz_ = v[6] - v[2] - v[4] + v[0];
    xyz_ = v[7] - v[6] - v[5] - v[3] + v[4] + v[2] + v[1] - v[0];
  }

  double operator()(const Vec3& p) const {
    const double at_z0 = c_ + p.x() * x_ + p.y() * (y_ + p.x() * xy_);
    return at_z0 + p.z() * (z_ + p.x() * xz_ + p.y() * (yz_ + p.x() * xyz_));
  }
  // Returns an upper bound of the magnitude of the second derivative in any direction, anywhere in the cell,
  // m per squared edge. The mixed derivatives are linear, so their largest values are at the ends of the
  // cell.
  double max_bend() const {
    const auto largest = [&](double at_0) { return std::max(std::abs(at_0), std::abs(at_0 + xyz_)); };
    return std::sqrt(2.0) * Vec3(largest(xy_), largest(xz_), largest(yz_)).norm();
  }

 private:
  double c_, x_, y_, z_, xy_, xz_, yz_, xyz_;
};

// Returns the distance at every node, metres, positive outside. Nodes within kExactField_m of the surface
// have the distance to the nearest triangle. Only a few triangles are compared for nodes farther away: those
// nearest to the corners of a cube of 4 x 4 x 4 cells around the node. The result is never too small. It is
// too large only if the corners have different nearest triangles: by less than a voxel, and mostly not at
// all.
inline constexpr double kExactField_m = 3e-3;
std::vector<float> distance_field(const TriangleTree& tree, const VoxelGrid& grid,
                                  const std::vector<std::uint8_t>& inside_nodes);

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

// Returns the lowered distance of every node. distance_m: signed distance of every node; the result is
// nowhere above it. The trilinear field of the result is nowhere above 0 in or on a closed mesh, except for a
// nanometre of rounding. pre: the grid encloses the mesh.
std::vector<float> outer_field(const TriangleMesh& mesh, const VoxelGrid& grid,
                               const std::vector<float>& distance_m);

// Returns an upper bound of the length of the trilinear field's gradient where the field is within_m or less.
double max_slope(const VoxelGrid& grid, const std::vector<float>& distance_m,
                 double within_m = kExactField_m);

// Bounds of the slope of a trilinear field around a position: the range of its gradient in blocks of cells.
// They show with one table access that a point which slides along a flat face of a tool stays outside.
class SlopeBlocks {
 public:
  static constexpr int kShift = 2, kSize = 1 << kShift;  // cells along a block
  static constexpr int kAround = 2;  // cells on each side of a block that its range also covers

  SlopeBlocks(const VoxelGrid& grid, const std::vector<float>& distance_m);

  // Returns a lower bound, 0 or less, of the change of the field between `at` and any position on the path
  // from `at` to `at + along` (both in cells from the grid's origin). Returns minus infinity if the path is
  // longer than kAround cells along an axis, or starts outside the grid.
  double min_change_m(const Vec3& at, const Vec3& along) const;
  // The ranges, for kernels.
  SlopeTable table() const {
    return {ranges_.data()->data(), {blocks_[0], blocks_[1], blocks_[2]}, kShift, kAround};
  }

 private:
  using Range = std::array<float, 6>;  // least and largest change per cell along x, y and z, m
  Range range_around(const VoxelGrid& grid, const std::vector<float>& distance_m,
                     const std::array<int, 3>& block) const;

  std::array<int, 3> cells_, blocks_;
  std::vector<Range> ranges_;
};

}  // namespace remote_touch
