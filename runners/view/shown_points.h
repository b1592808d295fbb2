// Which points of a frame a page shows: all that touch and all near the proxy, and some of the others around
// the action.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/cloud/point_cloud.h"
#include "core/geometry/bounding_box.h"

namespace remote_touch {

struct ShownPointsRule {
  BoundingBox box_W;           // points outside are left out
  double near_m = 0;           // points so near to a position of the proxy are all shown
  std::size_t max_others = 0;  // of the others in the box at most about so many
};

struct ShownPoints {
  std::vector<std::uint32_t> numbers;  // of points in the cloud, ascending
  // Of each: 0 for those that touch and those near the proxy; others are left out from the largest rank on.
  std::vector<std::uint32_t> rank;
  std::size_t measured = 0, in_box = 0, others = 0;  // of how many
};

// Others with a smaller rank are shown.
std::uint32_t rank_limit(std::size_t others, std::size_t max_others);

// always: numbers of points that are shown wherever they are, ascending. Others are thinned by their numbers,
// so that a page shows the same places of an image in every frame.
ShownPoints shown_points(const PointCloud& cloud, std::span<const std::uint32_t> always,
                         std::span<const Vec3> proxies_W, const ShownPointsRule& rule);

}  // namespace remote_touch
