#include "core/dissertation/tool/shape/slope_blocks.h"

#include <algorithm>
#include <limits>

namespace remote_touch {

SlopeBlocks::SlopeBlocks(const VoxelGrid& grid, const std::vector<float>& distance_m) : cells_(grid.cells) {
  for (int axis = 0; axis < 3; ++axis) blocks_[axis] = (cells_[axis] + kSize - 1) / kSize;
  ranges_.resize(std::size_t(blocks_[0]) * blocks_[1] * blocks_[2]);
#pragma omp parallel for schedule(dynamic)
  for (int k = 0; k < blocks_[2]; ++k)
    for (int j = 0; j < blocks_[1]; ++j)
      for (int i = 0; i < blocks_[0]; ++i)
        ranges_[i + blocks_[0] * (j + std::size_t(blocks_[1]) * k)] =
            range_around(grid, distance_m, {i, j, k});
}

// The derivative of a trilinear field along an axis lies between those along the four edges of the cell.
SlopeBlocks::Range SlopeBlocks::range_around(const VoxelGrid& grid, const std::vector<float>& distance_m,
                                             const std::array<int, 3>& block) const {
  const std::size_t row = grid.cells[0] + std::size_t(1), layer = row * (grid.cells[1] + std::size_t(1));
  const std::size_t next[3] = {1, row, layer};
  std::array<int, 3> first, last;  // nodes
  for (int axis = 0; axis < 3; ++axis) {
    first[axis] = std::max(kSize * block[axis] - kAround, 0);
    last[axis] = std::min(kSize * (block[axis] + 1) + kAround, cells_[axis]);
  }
  Range range;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    range[2 * axis] = std::numeric_limits<float>::max();
    range[2 * axis + 1] = std::numeric_limits<float>::lowest();
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i) {
        const std::size_t node = i + row * j + layer * k;
        const int at[3] = {i, j, k};
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (at[axis] == last[axis]) continue;
          const float change = distance_m[node + next[axis]] - distance_m[node];
          range[2 * axis] = std::min(range[2 * axis], change);
          range[2 * axis + 1] = std::max(range[2 * axis + 1], change);
        }
      }
  return range;
}

double SlopeBlocks::min_change_m(const Vec3& at, const Vec3& along) const {
  constexpr double kUnknown = -std::numeric_limits<double>::infinity();
  std::size_t block[3];
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_known =
        at[axis] >= 0 && at[axis] < cells_[axis] && std::abs(along[axis]) <= kAround;  // false for NaN
    if (!is_known) return kUnknown;
    block[axis] = static_cast<std::size_t>(at[axis]) / kSize;
  }
  const Range& range = ranges_[block[0] + blocks_[0] * (block[1] + std::size_t(blocks_[1]) * block[2])];
  double change_m = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double by = along[static_cast<int>(axis)];
    change_m += std::min(by * range[2 * axis], by * range[2 * axis + 1]);
  }
  return std::min(change_m, 0.0);
}

}  // namespace remote_touch
