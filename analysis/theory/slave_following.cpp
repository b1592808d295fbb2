#include "analysis/theory/slave_following.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace remote_touch {

namespace {

double angular(double hz) {
  return 2 * std::numbers::pi * hz;
}

// The distance by which a command that began to move with the speed 1 some time ago is ahead of the slave.
double lag_s(double time_s, double w) {
  return time_s > 0 ? time_s * std::exp(-w * time_s) : 0;
}
double lag_rate(double time_s, double w) {
  return time_s > 0 ? (1 - w * time_s) * std::exp(-w * time_s) : 0;
}

// Distance of the slave from where it touches.
double height_m(const Approach& a, double time_s) {
  const double w = angular(a.natural_frequency_hz), stop_s = a.way_m / a.speed_m_per_s;
  return a.gap_m +
         a.speed_m_per_s * (std::max(0.0, stop_s - time_s) + lag_s(time_s, w) - lag_s(time_s - stop_s, w));
}

double closing_speed_m_per_s(const Approach& a, double time_s) {
  const double w = angular(a.natural_frequency_hz), stop_s = a.way_m / a.speed_m_per_s;
  return a.speed_m_per_s * ((time_s < stop_s ? 1 : 0) - lag_rate(time_s, w) + lag_rate(time_s - stop_s, w));
}

}  // namespace

double following_error_m(const FollowedShake& shake) {
  const double u = angular(shake.hz), w = angular(shake.natural_frequency_hz);
  const std::complex<double> s(0, u), followed = (2.0 * w * s + w * w) / ((s + w) * (s + w));
  return shake.amplitude_m * std::abs(1.0 - followed * std::exp(-s * shake.age_s));
}

std::optional<Impact> first_impact(const Approach& a) {
  const double w = angular(a.natural_frequency_hz), step_s = 1 / (1000 * w);
  // The lag is largest 1 / w after the stop, and all but gone 50 / w after it.
  const double end_s = a.way_m / a.speed_m_per_s + 50 / w;
  double below_s = step_s;
  while (below_s < end_s && height_m(a, below_s) > 0) below_s += step_s;
  if (height_m(a, below_s) > 0) return {};
  double above_s = below_s - step_s;
  while (below_s - above_s > 1e-9) {
    const double middle_s = (above_s + below_s) / 2;
    (height_m(a, middle_s) > 0 ? above_s : below_s) = middle_s;
  }
  return Impact{below_s, closing_speed_m_per_s(a, below_s)};
}

double impact_force_N(double push_N, double stiffness_N_per_m, double mass_kg, double speed_m_per_s) {
  return push_N + std::sqrt(push_N * push_N + stiffness_N_per_m * mass_kg * speed_m_per_s * speed_m_per_s);
}

}  // namespace remote_touch
