// Minima and maxima that keep NaN. std::max(0.0, NaN) is 0, so a claim about such a maximum would pass
// without a value.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

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
