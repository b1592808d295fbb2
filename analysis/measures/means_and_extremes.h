// Means and higher moments, and extremes that keep NaN.
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace remote_touch {

// The arithmetic mean, and higher moments.

// Adds the numbers in the order of the list. Returns NaN for an empty list.
double mean(const std::vector<double>& values);

// Returns the mean of value(i) over each i below `count` for which qualifies(i) is true; NaN if there is
// none. If the values are true or false, it is the fraction that is true. The NaN is not computed as 0 / 0,
// because the sign of that NaN depends on the machine.
template <class Qualifies, class Value>
double mean_where(std::size_t count, Qualifies&& qualifies, Value&& value) {
  double sum = 0, number = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (qualifies(i)) sum += value(i), ++number;
  return number == 0 ? std::numeric_limits<double>::quiet_NaN() : sum / number;
}

// Moments of the numbers that are not NaN. variance: with count - 1; third: mean of the cubed deviations.
struct Moments {
  double count = 0, mean = 0, variance = 0, third = 0;
};
Moments moments_of(const std::vector<double>& values);

// Minima and maxima that keep NaN. std::max(0.0, NaN) is 0, so a claim about such a maximum would pass
// without a value.

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

// Returns value(i) for each i below `count` for which qualifies(i) is true.
template <class Qualifies, class Value>
std::vector<double> values_where(std::size_t count, Qualifies&& qualifies, Value&& value) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i)
    if (qualifies(i)) values.push_back(value(i));
  return values;
}
// Returns the largest of these values; NaN if one of them is NaN or no i qualifies.
template <class Qualifies, class Value>
double max_where(std::size_t count, Qualifies&& qualifies, Value&& value) {
  return max_of(values_where(count, qualifies, value));
}
// Returns the smallest of these values; NaN if one of them is NaN or no i qualifies.
template <class Qualifies, class Value>
double min_where(std::size_t count, Qualifies&& qualifies, Value&& value) {
  return min_of(values_where(count, qualifies, value));
}

}  // namespace remote_touch
