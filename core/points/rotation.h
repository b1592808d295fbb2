// Rotation vectors: the direction is the axis, the length is the angle in radians. The functions use only +,
// -, *, / and square roots, so that the bits do not depend on which sine the C library selects for a machine.
#pragma once

#include <utility>

#include "core/points/vector.h"

namespace remote_touch {

inline constexpr double kRadiansPerDegree = 0.017453292519943295;

// Returns sine and cosine, with errors below 2e-16.
std::pair<double, double> sin_cos(double angle);

// Returns the rotation as a unit quaternion, up to rounding.
Eigen::Quaterniond rotation(const Vec3& vector);
// Returns the shortest rotation vector of a rotation; its length is 0 to pi.
Vec3 rotation_vector(const Eigen::Quaterniond& rotation);

// The angle between two directions.

// Returns the angle between two vectors of any length, 0 to pi, with an error below 2e-15. pre: neither is
// zero. Unlike acos() and atan2(), it has the same bits with every C library. Half of the angle has the sine
// |u - v| / 2 and the cosine |u + v| / 2 for unit vectors u and v, which is accurate for all angles (Kahan
// 2006, "How futile are mindless assessments of roundoff in floating-point computation?").
inline double angle_between(const Vec3& a, const Vec3& b) {
  const Vec3 u = a.normalized(), v = b.normalized();
  return rotation_vector({0.5 * (u + v).norm(), 0.5 * (u - v).norm(), 0, 0}).x();
}

}  // namespace remote_touch
