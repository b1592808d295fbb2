// Quantiles and medians that are values of the sample, without interpolation.
#pragma once

#include <span>

namespace remote_touch {

// Returns the quantile: the value with index floor(fraction * n), counted from 0, among the n sorted values.
// Changes the order of the values. pre: none is NaN.
double quantile_in_place(std::span<double> values, double fraction);

// The same for fraction 0.5. If the number of values is even, the result is the upper one of the two in the
// middle.
inline double median_in_place(std::span<double> values) {
  return quantile_in_place(values, 0.5);
}

}  // namespace remote_touch
