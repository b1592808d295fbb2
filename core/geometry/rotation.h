// Rotation vectors: the direction is the axis, the length the angle in radians. Computed with +, -, *, / and
// square roots alone, so that the bits do not depend on which sine the C library picks for a machine.
#pragma once

#include <utility>

#include "core/geometry/vector.h"

namespace remote_touch {

inline constexpr double kRadiansPerDegree = 0.017453292519943295;

// Sine and cosine, within 2e-16; pre: |angle| < 1e6.
std::pair<double, double> sin_cos(double angle);

// A unit quaternion, within rounding.
Eigen::Quaterniond rotation(const Vec3& vector);
// The shortest vector of a rotation, of length 0 to pi.
Vec3 rotation_vector(const Eigen::Quaterniond& rotation);

}  // namespace remote_touch
