// The trilinear field in one cell of a tool's grid, m. Positions are relative to the cell's first node, in
// units of the cell's edge.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/geometry/vector.h"

namespace remote_touch {

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

}  // namespace remote_touch
