// The contact point of a ball: the point on the sphere of radius r_c around the proxy that faces the surface,
// according to the renderer's normal. rendered_contact.h defines the contact point of every renderer, by the
// true normal.
#pragma once

#include "analysis/trace/trace.h"

namespace remote_touch {

// P - r_c n, world frame.
inline Vec3 contact_point(const Trace& trace, std::size_t i, double contact_radius_m) {
  return trace.proxy_position_m[i] - contact_radius_m * trace.normal[i];
}

// True if the surface holds the proxy back: the HIP is more than 1.01 r_c away from the proxy.
inline bool pressing(const Trace& trace, std::size_t i, double contact_radius_m) {
  return (trace.hip_position_m[i] - trace.proxy_position_m[i]).norm() > 1.01 * contact_radius_m;
}

}  // namespace remote_touch
