// The largest allowed distance of a scene and a hand from the origin of the world.
#pragma once

#include <string>

#include "core/geometry/point_cloud.h"

namespace remote_touch {

// The limit along each axis. The method has absolute tolerances down to 1e-9 m. The spacing of doubles is
// 1e-13 m at this limit, but 1e-10 m at 1e6 m.
inline constexpr double kMaxCoordinate_m = 1000;

inline bool is_near_origin(const Vec3& p_W) {
  return p_W.cwiseAbs().maxCoeff() <= kMaxCoordinate_m;
}

// Returns true if there are measured points and all of them are beyond the limit. A few points beyond it do
// no harm.
inline bool is_far_from_origin(const PointCloud& cloud) {
  bool any = false;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    if (is_near_origin(cloud.point(i))) return false;
    any = true;
  }
  return any;
}

// Returns the error message. what: the subject of the message, such as the scene.
inline std::string far_from_origin(const std::string& what) {
  return what + " more than " + std::to_string(static_cast<int>(kMaxCoordinate_m)) +
         " m from the origin along an axis: expected a scene and a hand near the origin";
}

}  // namespace remote_touch
