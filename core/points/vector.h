// Positions, directions and rigid transforms: Eigen in double precision, metres. A name carries its frame:
// p_W is a position in the world frame W, X_WC transforms camera coordinates C to W.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <utility>

namespace remote_touch {

using Vec3 = Eigen::Vector3d;
using RigidTransform = Eigen::Isometry3d;

// An axis-aligned box around positions. A default box is empty: its min() is above its max(). It grows by
// extend().
using BoundingBox = Eigen::AlignedBox3d;

// Returns the smallest box that contains all positions of a range. It is empty if there are none.
template <class Positions>
BoundingBox bounding_box(const Positions& positions) {
  BoundingBox box;
  for (const Vec3& p : positions) box.extend(p);
  return box;
}

// Returns the vector, shortened to max_length if it is longer.
inline Vec3 limited_length(const Vec3& v, double max_length) {
  const double length = v.norm();
  return length > max_length ? Vec3(v * (max_length / length)) : v;
}

// Rotation vectors: the direction is the axis, the length is the angle in radians. The functions use only +,
// -, *, / and square roots, so that the bits do not depend on which sine the C library selects for a machine.

inline constexpr double kRadiansPerDegree = 0.017453292519943295;

// Returns sine and cosine, with errors below 2e-16.
std::pair<double, double> sin_cos(double angle);

// Returns the rotation as a unit quaternion, up to rounding.
Eigen::Quaterniond rotation(const Vec3& vector);
// Returns the shortest rotation vector of a rotation; its length is 0 to pi.
Vec3 rotation_vector(const Eigen::Quaterniond& rotation);

// Returns the angle between two vectors of any length, 0 to pi, with an error below 2e-15. pre: neither is
// zero. Unlike acos() and atan2(), it has the same bits with every C library. Half of the angle has the sine
// |u - v| / 2 and the cosine |u + v| / 2 for unit vectors u and v, which is accurate for all angles (Kahan
// 2006, "How futile are mindless assessments of roundoff in floating-point computation?").
inline double angle_between(const Vec3& a, const Vec3& b) {
  const Vec3 u = a.normalized(), v = b.normalized();
  return rotation_vector({0.5 * (u + v).norm(), 0.5 * (u - v).norm(), 0, 0}).x();
}

}  // namespace remote_touch
