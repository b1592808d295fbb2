// The order of the points of a cloud along a space-filling curve: most points follow a neighbour.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/point_cloud.h"

namespace remote_touch {

// Returns the indices of the measured points along a Morton curve through the cloud's bounding box. Points in
// the same cell of the curve keep the order of the cloud.
std::vector<std::uint32_t> morton_order(const PointCloud& cloud);

}  // namespace remote_touch
