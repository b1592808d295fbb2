// Minima and maxima that keep NaN. std::max(0.0, NaN) is 0, so a claim about such a maximum would pass
// without a value.
#pragma once

#include <cmath>
#include <span>

namespace remote_touch {

// Returns the larger value, and NaN if one of them is NaN.
inline double max_or_nan(double a, double b) {
  return std::isnan(a) || a > b ? a : b;
}
// Returns the smaller value, and NaN if one of them is NaN.
inline double min_or_nan(double a, double b) {
  return std::isnan(a) || a < b ? a : b;
}

// Returns the largest value; NaN if one of them is NaN or there is none.
inline double max_of(std::span<const double> values) {
  double max = values.empty() ? std::nan("") : values[0];
  for (const double v : values) max = max_or_nan(max, v);
  return max;
}
// Returns the smallest value; NaN if one of them is NaN or there is none.
inline double min_of(std::span<const double> values) {
  double min = values.empty() ? std::nan("") : values[0];
  for (const double v : values) min = min_or_nan(min, v);
  return min;
}

}  // namespace remote_touch
