// Axis-aligned boxes around positions.
#pragma once

#include <Eigen/Geometry>

#include "core/geometry/vector.h"

namespace remote_touch {

// A default box is empty: its min() is above its max(). It grows by extend().
using BoundingBox = Eigen::AlignedBox3d;

// Returns the smallest box that contains all positions of a range. It is empty if there are none.
template <class Positions>
BoundingBox bounding_box(const Positions& positions) {
  BoundingBox box;
  for (const Vec3& p : positions) box.extend(p);
  return box;
}

}  // namespace remote_touch
