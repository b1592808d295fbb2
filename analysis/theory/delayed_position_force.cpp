#include "analysis/theory/delayed_position_force.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

namespace remote_touch {

namespace {

using Polynomial = std::vector<double>;  // coefficients, lowest power first

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Polynomial product(const Polynomial& a, const Polynomial& b) {
  Polynomial result(a.size() + b.size() - 1, 0.0);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = 0; j < b.size(); ++j) result[i + j] += a[i] * b[j];
  return result;
}

template <typename Number>
Number value(const Polynomial& p, Number x) {
  Number sum = 0;
  for (std::size_t i = p.size(); i-- > 0;) sum = sum * x + p[i];
  return sum;
}

// |p(j u)|^2 as a polynomial in y = u^2.
Polynomial squared_magnitude(const Polynomial& p) {
  Polynomial real, imaginary;  // p(j u) = real(y) + j u imaginary(y)
  for (std::size_t i = 0; i < p.size(); ++i) (i % 2 ? imaginary : real).push_back(i / 2 % 2 ? -p[i] : p[i]);
  Polynomial result = product(real, real);
  result.resize(p.size(), 0.0);
  const Polynomial odd = product(imaginary, imaginary);
  for (std::size_t i = 0; i < odd.size(); ++i) result[i + 1] += odd[i];
  return result;
}

double bisected(const Polynomial& p, double low, double high) {
  const bool rises = value(p, low) < 0;
  for (int i = 0; i < 200 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    ((value(p, middle) < 0) == rises ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// All roots between 0 and the bound at which the sign changes, in order. Between two roots of the derivative
// there is at most one.
std::vector<double> sign_changes(const Polynomial& p, double bound) {
  if (p.size() < 2) return {};
  Polynomial derivative;
  for (std::size_t i = 1; i < p.size(); ++i) derivative.push_back(static_cast<double>(i) * p[i]);
  std::vector<double> ends = sign_changes(derivative, bound);
  ends.push_back(bound);
  std::vector<double> roots;
  double low = 0;
  for (const double high : ends) {
    if ((value(p, low) < 0) != (value(p, high) < 0)) roots.push_back(bisected(p, low, high));
    low = high;
  }
  return roots;
}

struct Loop {
  Polynomial p, q;  // in s / scale
  double scale_per_s;
};

// s is measured in units of about the geometric mean of the roots of P, which keeps the coefficients near
// one.
Loop scaled(const PositionForceLoop& l) {
  const double w = 2 * std::numbers::pi * l.slave_natural_frequency_hz;
  const double ks = l.slave_mass_kg * w * w, bs = 2 * l.slave_damping_ratio * l.slave_mass_kg * w;
  const double K = l.environment_stiffness_N_per_m, B = l.environment_damping_Ns_per_m;
  Loop loop;
  loop.p = product({l.stiffness_N_per_m, l.damping_Ns_per_m, l.mass_kg}, {ks + K, bs + B, l.slave_mass_kg});
  loop.q = product({l.feedback_gain * ks, l.feedback_gain * bs}, {K, B});
  const double lead = loop.p.back();
  loop.scale_per_s = std::pow((loop.p[0] + loop.q[0]) / lead, 0.25);
  if (!(loop.scale_per_s > 0)) loop.scale_per_s = w;
  for (Polynomial* polynomial : {&loop.p, &loop.q})
    for (std::size_t i = 0; i < polynomial->size(); ++i)
      (*polynomial)[i] *= std::pow(loop.scale_per_s, static_cast<double>(i) - 4) / lead;
  return loop;
}

// Routh and Hurwitz for s^4 + a3 s^3 + a2 s^2 + a1 s + a0. A hand without a spring, and without feedback,
// drifts: a0 = 0 is accepted, because the root 0 does not depend on the delay.
bool is_stable_without_delay(const Loop& loop) {
  Polynomial a = loop.p;
  for (std::size_t i = 0; i < loop.q.size(); ++i) a[i] += loop.q[i];
  return a[0] >= 0 && a[1] > 0 && a[3] > 0 && (a[3] * a[2] - a[1]) * a[1] > a[3] * a[3] * a[0];
}

}  // namespace

DelayOnset delay_onset(const PositionForceLoop& parameters) {
  const Loop loop = scaled(parameters);
  DelayOnset onset{kInfinity, std::numeric_limits<double>::quiet_NaN()};
  if (!is_stable_without_delay(loop)) return {0, onset.frequency_hz};
  Polynomial difference = squared_magnitude(loop.p);
  const Polynomial feedback = squared_magnitude(loop.q);
  for (std::size_t i = 0; i < feedback.size(); ++i) difference[i] -= feedback[i];
  double largest = 0;
  for (const double c : difference) largest = std::max(largest, std::abs(c));
  const double bound = 1 + largest / std::abs(difference.back());  // Cauchy
  for (const double y : sign_changes(difference, bound)) {
    const double u = std::sqrt(y);
    if (!(u > 0)) continue;
    const std::complex<double> s(0, u);
    double angle = std::arg(-value(loop.q, s) / value(loop.p, s));
    if (angle < 0) angle += 2 * std::numbers::pi;
    const double round_trip_s = angle / (u * loop.scale_per_s);
    if (round_trip_s < onset.round_trip_s)
      onset = {round_trip_s, u * loop.scale_per_s / (2 * std::numbers::pi)};
  }
  return onset;
}

double max_environment_stiffness(const PositionForceLoop& loop, double round_trip_s) {
  const auto is_stable = [&](double stiffness) {
    PositionForceLoop tried = loop;
    tried.environment_stiffness_N_per_m = stiffness;
    return delay_onset(tried).round_trip_s > round_trip_s;
  };
  double low = 0, high = 1e-3;
  while (is_stable(high)) {
    low = high, high *= 1.01;
    if (high > 1e9) return kInfinity;
  }
  while (high - low > 1e-10 * high) {
    const double middle = 0.5 * (low + high);
    (is_stable(middle) ? low : high) = middle;
  }
  return low;
}

double held_round_trip(double round_trip_s, double tick_s, int holds) {
  return round_trip_s + 0.5 * holds * tick_s;
}

}  // namespace remote_touch
