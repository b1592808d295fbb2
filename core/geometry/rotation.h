// Rotation vectors: the direction is the axis, the length is the angle in radians. The functions use only +,
// -, *, / and square roots, so that the bits do not depend on which sine the C library selects for a machine.
#pragma once

#include <utility>

#include "core/geometry/vector.h"

namespace remote_touch {

inline constexpr double kRadiansPerDegree = 0.017453292519943295;

// Returns sine and cosine, with errors below 2e-16. pre: |angle| < 1e6.
std::pair<double, double> sin_cos(double angle);

// Returns the rotation as a unit quaternion, up to rounding.
Eigen::Quaterniond rotation(const Vec3& vector);
// Returns the shortest rotation vector of a rotation; its length is 0 to pi.
Vec3 rotation_vector(const Eigen::Quaterniond& rotation);

}  // namespace remote_touch
