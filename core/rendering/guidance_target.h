// The target of a guidance virtual fixture: the mean position of the points of a class, and the plane that
// they lie in, 7.3.2.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// The target of one fixture in one frame; world frame.
struct GuidanceTarget {
  std::size_t points = 0;      // number of points that the rule selects; 0: no target in the frame
  Vec3 mean_W = Vec3::Zero();  // weighted mean of their positions
  // Unit normal of the plane that fits them by weighted total least squares, towards the sensor. It is zero
  // for fewer than three points. It is also zero if they do not form a plane: if their standard deviation
  // along the normal is above kFlat times that along the plane's shorter axis, or if the latter is at most
  // kLine times that along the longer axis.
  Vec3 normal_W = Vec3::Zero();
  double strength = 1;  // strength of its rule when the frame was captured, 0 to 1
  static constexpr double kFlat = 0.25, kLine = 1e-3;

  bool operator==(const GuidanceTarget&) const = default;
  bool is_visible() const { return points > 0; }
  bool is_flat() const { return !normal_W.isZero(0); }
};

// Returns the target. weights: weight of each point, 0 to 1, as FixtureRule::weights() returns it. Points
// that are not finite are ignored. The sensor is assumed at the camera of the cloud's image; at the origin if
// the cloud has no image.
GuidanceTarget guidance_target(const PointCloud& cloud, const std::vector<double>& weights);

}  // namespace remote_touch
