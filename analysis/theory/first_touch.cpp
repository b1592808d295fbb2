#include "analysis/theory/first_touch.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

// Returns the distance from the proxy's centre to the plane if the nearest points are this far from the
// centre.
double plane_distance_m(const FirstTouch& touch, double point_distance_m) {
  const double b = touch.nearest_beside_m;
  return std::sqrt(point_distance_m * point_distance_m - b * b);
}

double resting_m(const FirstTouch& touch) {
  return plane_distance_m(touch, 0.5 * (touch.r1_m + touch.r2_m));
}

}  // namespace

double max_first_touch_velocity(const FirstTouch& touch) {
  return plane_distance_m(touch, touch.r1_m) * touch.frame_rate_hz;
}

double max_touched_velocity(const FirstTouch& touch) {
  return resting_m(touch) * touch.frame_rate_hz;
}

double lost_at_first_touch(const FirstTouch& touch, double velocity_m_per_s) {
  const double moved_m = velocity_m_per_s / touch.frame_rate_hz;
  const double touching_m = plane_distance_m(touch, touch.r1_m);
  const double first_m = std::max(0.0, moved_m - touching_m);
  const double second_m = std::max(0.0, moved_m + touching_m - 2 * resting_m(touch));
  return std::min(1.0, (first_m + second_m) / moved_m);
}

}  // namespace remote_touch
