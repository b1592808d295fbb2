// The number of ticks between two calls of a renderer or of a simulated hand.
#pragma once

#include <algorithm>
#include <cmath>

namespace remote_touch {

// Returns the number of ticks from before_s to now_s, rounded, and at least 1. It is also 1 if the time does
// not advance, decreases or is NaN.
inline double elapsed_ticks(double before_s, double now_s, double haptic_rate_hz) {
  return std::max(1.0, std::floor((now_s - before_s) * haptic_rate_hz + 0.5));
}

}  // namespace remote_touch
