// Where the proxy touches: the point of its contact radius that faces the surface.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// P - r_c n, world frame.
inline Vec3 contact_point(const Trace& trace, std::size_t i, double contact_radius_m) {
  return trace.proxy_position_m[i] - contact_radius_m * trace.normal[i];
}

// The HIP is held back from where it wants to be.
inline bool pressing(const Trace& trace, std::size_t i, double contact_radius_m) {
  return (trace.hip_position_m[i] - trace.proxy_position_m[i]).norm() > 1.01 * contact_radius_m;
}

}  // namespace remote_touch
