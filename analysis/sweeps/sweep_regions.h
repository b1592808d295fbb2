// Parts of a sweep's grid, for statements about more than one cell.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "analysis/columns/column.h"

namespace remote_touch {

// A box of cells: on each axis the values [first, second).
struct Region {
  std::string label;  // of the axes that are split: "noise_sigma_m 0 to 0.005, velocity_estimate true"
  std::vector<std::pair<std::size_t, std::size_t>> places = {};
  bool contains(const std::vector<std::size_t>& place) const;
};

// Region 0 is the whole. Then come the parts, last axis running first: numeric axes of 6 values or more in
// three parts of equal length, axes of 2 to 4 values in their single values, all others whole. In the order
// of the axes, one whose split would make more than 36 parts stays whole. No parts when no axis is split.
std::vector<Region> regions_of(const std::vector<Column>& axes);

}  // namespace remote_touch
