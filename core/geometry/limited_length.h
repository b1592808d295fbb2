#pragma once

#include "core/geometry/vector.h"

namespace remote_touch {

// Returns the vector, shortened to max_length if it is longer.
inline Vec3 limited_length(const Vec3& v, double max_length) {
  const double length = v.norm();
  return length > max_length ? Vec3(v * (max_length / length)) : v;
}

}  // namespace remote_touch
