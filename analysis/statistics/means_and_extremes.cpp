#include "analysis/statistics/means_and_extremes.h"

#include <numeric>

namespace remote_touch {

double mean(const std::vector<double>& values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

Moments moments_of(const std::vector<double>& values) {
  Moments m;
  double sum = 0, squares = 0, cubes = 0;
  for (const double value : values)
    if (!std::isnan(value)) sum += value, ++m.count;
  if (m.count == 0) return m;
  m.mean = sum / m.count;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    const double d = value - m.mean;
    squares += d * d, cubes += d * d * d;
  }
  if (m.count > 1) m.variance = squares / (m.count - 1);
  m.third = cubes / m.count;
  return m;
}

}  // namespace remote_touch
