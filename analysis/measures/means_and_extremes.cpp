#include "analysis/measures/means_and_extremes.h"

#include <algorithm>
#include <numeric>

namespace remote_touch {

double mean(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Moments moments_of(const std::vector<double>& values) {
  Moments m;
  // Deviations from the first number: those of equal numbers are exactly 0.
  const auto is_finite = [](double value) { return std::isfinite(value); };
  const auto first = std::find_if(values.begin(), values.end(), is_finite);
  const double origin = first == values.end() ? 0 : *first;
  double sum = 0, squares = 0, cubes = 0;
  for (const double value : values)
    if (!std::isnan(value)) sum += value - origin, ++m.count;
  if (m.count == 0) return m;
  const double shift = sum / m.count;
  m.mean = origin + shift;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    const double d = value - origin - shift;
    squares += d * d, cubes += d * d * d;
  }
  if (m.count > 1) m.variance = squares / (m.count - 1);
  m.third = cubes / m.count;
  return m;
}

}  // namespace remote_touch
