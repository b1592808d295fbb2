// Positions, directions and rigid transforms: Eigen in double precision, metres. A name carries its frame:
// p_W is a position in the world frame W, X_WC transforms camera coordinates C to W.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace remote_touch {

using Vec3 = Eigen::Vector3d;
using RigidTransform = Eigen::Isometry3d;

// Axis-aligned boxes around positions.

// A default box is empty: its min() is above its max(). It grows by extend().
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

}  // namespace remote_touch
