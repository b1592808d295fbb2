// Axis-aligned boxes around positions.
#pragma once

#include <Eigen/Geometry>

#include "core/geometry/vector.h"

namespace remote_touch {

// Starts empty (its min() is above its max()) and grows by extend().
using BoundingBox = Eigen::AlignedBox3d;

// Around every position of a range; empty for none.
template <class Positions>
BoundingBox bounding_box(const Positions& positions) {
  BoundingBox box;
  for (const Vec3& p : positions) box.extend(p);
  return box;
}

}  // namespace remote_touch
