// Selects the points of a frame that a page shows: all that touch, all near the proxy, and some of the others
// around the action.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry/point_cloud.h"
#include "core/geometry/vector.h"

namespace remote_touch {

struct ShownPointsRule {
  BoundingBox box_W;              // points outside are left out
  double near_m = 0;              // all points in the box this near to a position of the proxy are shown
  std::size_t wanted_others = 0;  // about so many other points in the box are shown, or all if fewer
};

struct ShownPoints {
  std::vector<std::uint32_t> indices;  // indices of the points in the cloud, ascending
  // Rank of each point: 0 for points that touch and points near the proxy. Among the other points, those with
  // the largest ranks are left out first.
  std::vector<std::uint32_t> rank;
  std::size_t measured = 0, in_box = 0, others = 0;  // counts before any point is left out
};

// Returns the rank below which the other points are shown.
std::uint32_t rank_limit(std::size_t others, std::size_t wanted_others);

// always: indices, ascending, of points that are shown wherever they are. The other points are thinned by
// their indices, so that a page shows the same pixels of an image in every frame.
ShownPoints shown_points(const PointCloud& cloud, std::span<const std::uint32_t> always,
                         std::span<const Vec3> proxies_W, const ShownPointsRule& rule);

}  // namespace remote_touch
