// The arithmetic mean, and higher moments.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace remote_touch {

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

}  // namespace remote_touch
