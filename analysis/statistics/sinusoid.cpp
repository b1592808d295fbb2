#include "analysis/statistics/sinusoid.h"

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace remote_touch {

Sinusoid sinusoid_in(const std::vector<double>& time_s, const std::vector<double>& values, double hz) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {kNaN, kNaN};
  double with_cosine = 0, with_sine = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double angle_rad = 2 * std::numbers::pi * hz * time_s[i];
    with_cosine += values[i] * std::cos(angle_rad);
    with_sine += values[i] * std::sin(angle_rad);
  }
  const double half_count = 0.5 * static_cast<double>(values.size());
  return {std::hypot(with_cosine, with_sine) / half_count, std::atan2(-with_sine, with_cosine)};
}

double lag_s(const Sinusoid& first, const Sinusoid& second, double hz) {
  const double turn_rad = 2 * std::numbers::pi;
  return std::remainder(first.phase_rad - second.phase_rad, turn_rad) / (turn_rad * hz);
}

}  // namespace remote_touch
