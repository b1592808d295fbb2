// Quantiles and medians that are values of the sample, without interpolation.
#pragma once

#include <span>

namespace remote_touch {

// The value that the given fraction of all lie below: of n sorted values, number floor(fraction * n) from 0.
// Changes the order of the values. pre: not empty, none is NaN, 0 <= fraction < 1.
double quantile_in_place(std::span<double> values, double fraction);

// The same for fraction 0.5: of an even number of values, the upper one of the two in the middle.
inline double median_in_place(std::span<double> values) {
  return quantile_in_place(values, 0.5);
}

}  // namespace remote_touch
