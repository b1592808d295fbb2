// Parts of a sweep's grid, for statements about more than one cell.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/column.h"

namespace remote_touch {

// A box of cells: `ranges` has the range of indices [first, second) on each axis.
struct Region {
  std::string label;  // ranges on the split axes: "noise_sigma_m 0 to 0.005, velocity_estimate true"
  std::vector<std::pair<std::size_t, std::size_t>> ranges = {};
  bool contains(const std::vector<std::size_t>& indices) const;
};

// Region 0 is the whole. Then follow the parts, the last axis running fastest: numeric axes of 6 values or
// more are split into three parts of equal length, axes of 2 to 4 values into single values; others are not
// split. Axes are split in their order; one whose split would give more than 36 parts stays whole. No parts
// if no axis is split.
std::vector<Region> regions_of(const std::vector<Column>& axes);

}  // namespace remote_touch
