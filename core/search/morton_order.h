// The points of a cloud along a space-filling curve: neighbours mostly follow each other.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/point_cloud.h"

namespace remote_touch {

// Numbers of the measured points along a Morton curve through the cloud's box; points at one place keep the
// order of the cloud.
std::vector<std::uint32_t> morton_order(const PointCloud& cloud);

}  // namespace remote_touch
