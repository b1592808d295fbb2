// How much of a measurement is kept where noise may explain it.
#pragma once

namespace remote_touch {

// What of a measurement is not its standard error: nearly all of a large one, nothing of a small one.
inline double surely(double x, double error) {
  const double square = x * x;
  return square > 0 ? square / (square + 4 * error * error) * x : 0;
}

}  // namespace remote_touch
