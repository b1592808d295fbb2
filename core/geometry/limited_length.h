#pragma once

#include "core/geometry/vector.h"

namespace remote_touch {

// The vector, or where it is longer than max_length one of that length in its direction.
inline Vec3 limited_length(const Vec3& v, double max_length) {
  const double length = v.norm();
  return length > max_length ? Vec3(v * (max_length / length)) : v;
}

}  // namespace remote_touch
