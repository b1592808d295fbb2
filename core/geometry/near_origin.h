// Largest distance of a scene and a hand from the origin of the world.
#pragma once

#include <string>

#include "core/geometry/point_cloud.h"

namespace remote_touch {

// The limit along each axis. Tolerances of the method are absolute, down to 1e-9 m: the numbers of double
// precision lie 1e-13 m apart here, but 1e-10 m apart at 1e6 m.
inline constexpr double kMaxCoordinate_m = 1000;

inline bool is_near_origin(const Vec3& p_W) {
  return p_W.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
}

// True if points were measured and all of them lie farther away. Single points there do no harm.
inline bool is_far_from_origin(const PointCloud& cloud) {
  bool any = false;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    if (is_near_origin(cloud.point(i))) return false;
    any = true;
  }
  return any;
}

// The text of the error.
inline std::string far_from_origin(const std::string& what) {
  return what + " farther than " + std::to_string(static_cast<int>(kMaxCoordinate_m)) +
         " m from the origin, along an axis: expected a scene and a hand near the origin";
}

}  // namespace remote_touch
