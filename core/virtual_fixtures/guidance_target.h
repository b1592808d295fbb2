// What a guidance virtual fixture is made of: the place of the points of a class, and the plane that they lie
// in, 7.3.2.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/cloud/point_cloud.h"
#include "core/geometry/vector.h"

namespace remote_touch {

// Of one fixture in one frame; world frame.
struct GuidanceTarget {
  std::size_t points = 0;      // that were picked; 0: the frame shows no target
  Vec3 mean_W = Vec3::Zero();  // of their places, weighted by their shares
  // Unit normal of the plane of weighted total least squares through them, towards the sensor. Zero for
  // fewer than three points, or where they do not lie in a plane: spread along it at most kFlat times as far
  // as in the plane's shorter direction, and in that more than kLine times as far as in the longer.
  Vec3 normal_W = Vec3::Zero();
  double strength = 1;  // of its rule when the frame was captured, 0 to 1
  static constexpr double kFlat = 0.25, kLine = 1e-3;

  bool is_visible() const { return points > 0; }
  bool is_flat() const { return !normal_W.isZero(0); }
};

// From how far each point counts, 0 to 1, as FixtureRule::shares(); none that is not finite does. The sensor
// is where the image was taken from, else in the origin.
GuidanceTarget guidance_target(const PointCloud& cloud, const std::vector<double>& weights);

}  // namespace remote_touch
