// Orders of points: along a space-filling curve, and in compact runs.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"

namespace remote_touch {

// The order of the points of a cloud along a space-filling curve: most points follow a neighbour.

// Returns the indices of the measured points along a Morton curve through the cloud's bounding box. Points in
// the same cell of the curve keep the order of the cloud.
std::vector<std::uint32_t> morton_order(const PointCloud& cloud);

// An order of points in which runs of points are compact: their boxes are nearly cubes.

// Returns the indices of the points in such an order. Each run of 8, 64, 512 or 4096 that begins at a
// multiple of its length is one part of a halving of the cloud, across its longest side each time. So all
// runs but the last are full. pre: the points are finite.
std::vector<std::uint32_t> compact_order(std::span<const Vec3> points);

}  // namespace remote_touch
