// Shrinkage: the part of a measurement that is kept if noise may explain it.
#pragma once

#include <algorithm>

namespace remote_touch {

// Returns the standard error of the difference of two heights that each have this standard error, rounded up
// and at least 0.003; contact radii.
inline double error_of_two(double error) {
  return std::max(1.5 * error, 0.003);
}

// Returns the part of a measurement that its standard error does not explain: nearly all of a large
// measurement, nearly nothing of a small one.
inline double shrunk(double x, double error) {
  const double square = x * x;
  return square > 0 ? square / (square + 4 * error * error) * x : 0;
}

}  // namespace remote_touch
