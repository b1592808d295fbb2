#include "analysis/statistics/proportion.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

std::pair<double, double> wilson_interval(std::int64_t events, std::int64_t runs, double z) {
  if (runs <= 0) return {0, 1};
  const auto n = static_cast<double>(runs);
  const double p = static_cast<double>(events) / n, z2 = z * z;
  const double middle = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = z / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  // The lower end is exactly 0 if there is no event, and the upper end exactly 1 if every run is one.
  return {events <= 0 ? 0 : std::max(0.0, middle - half), events >= runs ? 1 : std::min(1.0, middle + half)};
}

}  // namespace remote_touch
