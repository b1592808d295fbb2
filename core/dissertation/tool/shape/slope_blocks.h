// Bounds of the slope of a trilinear field around a position: the range of its gradient in blocks of cells.
// They show with one table access that a point which slides along a flat face of a tool stays outside.
#pragma once

#include <array>
#include <vector>

#include "core/dissertation/tool/shape/voxel_tool.h"
#include "core/kernels/tool_kernels.h"

namespace remote_touch {

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
