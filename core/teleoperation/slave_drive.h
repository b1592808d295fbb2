// The parts of the drive that a ball and a tool share.
#pragma once

#include <numbers>

#include "core/geometry/vector.h"
#include "core/teleoperation/slave.h"

namespace remote_touch {

// Returns 2 pi natural_frequency_hz, 1/s.
inline double natural_rate_per_s(const SlaveSettings& s) {
  return 2 * std::numbers::pi * s.natural_frequency_hz;
}

// Returns the vector, shortened to max_length if it is longer; 0: no limit.
inline Vec3 cut(const Vec3& v, double max_length) {
  return max_length > 0 ? limited_length(v, max_length) : v;
}

}  // namespace remote_touch
