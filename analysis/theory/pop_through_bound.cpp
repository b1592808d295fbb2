#include "analysis/theory/pop_through_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/statistics/curve_fits.h"

namespace remote_touch {

double critical_acceleration(const Lift& lift) {
  return lift.r1_m * lift.frame_rate_hz * lift.frame_rate_hz;
}

double bound_acceleration(const Lift& lift, double thickness_m, double normal_error) {
  const double f = lift.frame_rate_hz;
  const double gap_m = lift.r1_m + thickness_m - lift.start_velocity_m_per_s * normal_error / f;
  const double bound = gap_m * f * f / (1 + (lift.updates - 1) * normal_error);
  return bound < 0 ? 0 : bound;  // NaN stays NaN
}

double PrintedFit::at(double sigma_m) const {
  return polynomial(coefficients, powers, sigma_m);
}

double PrintedFit::digits_band(double sigma_m) const {
  return polynomial(half_digits, powers, sigma_m);
}

const PrintedFit& printed_thickness() {
  static const PrintedFit fit{
      {4, 3, 2, 1, 0}, {5.5e4, -6.7e3, 63, 1, -4.1e-5}, {0.05e4, 0.05e3, 0.5, 0.05, 0.05e-5}};
  return fit;
}

const PrintedFit& printed_normal_error() {
  static const PrintedFit fit{
      {5, 4, 3, 2, 1}, {2.9e10, -6.4e8, 4.8e6, -1.2e4, 16}, {0.05e10, 0.05e8, 0.05e6, 0.05e4, 0.5}};
  return fit;
}

double survival_probability(const Lift& lift, const NoiseEffect& noise, double acceleration) {
  const double f = lift.frame_rate_hz, upright = 1 - noise.normal_error;
  double probability = 1, estimate = lift.start_velocity_m_per_s;
  for (int j = 1; j <= lift.updates; ++j) {
    const double velocity = lift.start_velocity_m_per_s + j * acceleration / f;
    const double margin = lift.r1_m + noise.thickness_m + (estimate * upright - velocity) / f;
    const auto square = [](double x) { return x * x; };
    const double variance =
        square(noise.margin_sd_m) + square(noise.thickness_sd_m) +
        (square(estimate) - square(lift.start_velocity_m_per_s)) * square(noise.normal_error_sd / f);
    if (std::isnan(margin) || std::isnan(variance)) return std::numeric_limits<double>::quiet_NaN();
    // Zero variance: the probability is a step from 0 to 1, and the rounding of (4.14) does not affect it.
    probability *= variance > 0 ? 0.5 * std::erfc(-margin / std::sqrt(2 * variance)) : margin > 0 ? 1 : 0;
    estimate += noise.gain * (velocity - estimate);
  }
  return probability;
}

double scatter_bound(const Lift& lift, const NoiseEffect& noise) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constexpr int kMaxDoublings = 60;
  double low = 0, high = 10 * critical_acceleration(lift);
  const double at_rest = survival_probability(lift, noise, low);
  if (std::isnan(at_rest)) return kNone;
  if (at_rest < 0.5) return 0;
  int doublings = 0;
  while (survival_probability(lift, noise, high) >= 0.5 && doublings++ < kMaxDoublings) high *= 2;
  if (!(survival_probability(lift, noise, high) < 0.5)) return kNone;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (survival_probability(lift, noise, middle) >= 0.5 ? low : high) = middle;
  }
  return low;
}

}  // namespace remote_touch
