// The angle between two directions.
#pragma once

#include "core/geometry/rotation.h"

namespace remote_touch {

// Returns the angle between two vectors of any length, 0 to pi, with an error below 2e-15. pre: neither is
// zero. Unlike acos() and atan2(), it has the same bits with every C library. Half of the angle has the sine
// |u - v| / 2 and the cosine |u + v| / 2 for unit vectors u and v, which is accurate for all angles (Kahan
// 2006, "How futile are mindless assessments of roundoff in floating-point computation?").
inline double angle_between(const Vec3& a, const Vec3& b) {
  const Vec3 u = a.normalized(), v = b.normalized();
  return rotation_vector({0.5 * (u + v).norm(), 0.5 * (u - v).norm(), 0, 0}).x();
}

}  // namespace remote_touch
