// How much of a measurement is kept where noise may explain it.
#pragma once

#include <algorithm>

namespace remote_touch {

// Of the difference of two heights, each with that standard error; contact radii.
inline double error_of_two(double error) {
  return std::max(1.5 * error, 0.003);
}

// What of a measurement is not its standard error: nearly all of a large one, nothing of a small one.
inline double surely(double x, double error) {
  const double square = x * x;
  return square > 0 ? square / (square + 4 * error * error) * x : 0;
}

}  // namespace remote_touch
