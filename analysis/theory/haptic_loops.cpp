#include "analysis/theory/haptic_loops.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

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

double held_round_trip(double round_trip_s, double tick_s, int holds) {
  return round_trip_s + 0.5 * holds * tick_s;
}

namespace {

// Returns the matrix that maps position, velocity and held force to their values one tick later: the
// exponential of the motion, by its series for a sixteenth of the tick and four squarings.
Eigen::Matrix3d motion_of(const SampledWall& wall, double stiffness_N_per_m) {
  constexpr int kSquarings = 4, kTerms = 16;
  const double m = wall.mass_kg;
  Eigen::Matrix3d rate;
  rate << 0, 1, 0, -wall.spring_share * stiffness_N_per_m / m, -wall.damping_Ns_per_m / m, 1 / m, 0, 0, 0;
  rate *= wall.tick_s / (1 << kSquarings);
  Eigen::Matrix3d motion = Eigen::Matrix3d::Identity(), term = motion;
  for (int i = 1; i <= kTerms; ++i) term = (term * rate / i).eval(), motion += term;
  for (int i = 0; i < kSquarings; ++i) motion = (motion * motion).eval();
  return motion;
}

// The state is x, x', the positions of the last n ticks and the commands of the last d ticks, newest first.
bool is_stable(const SampledWall& wall, double stiffness_N_per_m) {
  constexpr double kRounding = 1e-12;
  const int n = wall.velocity_ticks, d = wall.delay_ticks, size = 2 + n + d;
  const double damper_N_per_m = wall.wall_damping_Ns_per_m / (n * wall.tick_s);
  Eigen::RowVectorXd command = Eigen::RowVectorXd::Zero(size);
  command[0] = -stiffness_N_per_m - damper_N_per_m, command[1 + n] = damper_N_per_m;
  const Eigen::MatrixXd now = Eigen::MatrixXd::Identity(size, size);
  const Eigen::RowVectorXd force = d == 0 ? command : Eigen::RowVectorXd(now.row(size - 1));
  const Eigen::Matrix3d motion = motion_of(wall, stiffness_N_per_m);
  Eigen::MatrixXd next = Eigen::MatrixXd::Zero(size, size);
  for (int i = 0; i < 2; ++i)
    next.row(i) = motion(i, 0) * now.row(0) + motion(i, 1) * now.row(1) + motion(i, 2) * force;
  next.row(2) = now.row(0);
  for (int i = 3; i < 2 + n; ++i) next.row(i) = now.row(i - 1);
  if (d > 0) next.row(2 + n) = command;
  for (int i = 3 + n; i < size; ++i) next.row(i) = now.row(i - 1);
  return Eigen::EigenSolver<Eigen::MatrixXd>(next, false).eigenvalues().cwiseAbs().maxCoeff() <=
         1 + kRounding;
}

}  // namespace

double wall_law_N_per_m(const SampledWall& wall) {
  return (wall.damping_Ns_per_m + wall.wall_damping_Ns_per_m) / ((0.5 + wall.delay_ticks) * wall.tick_s);
}

double exact_wall_limit_N_per_m(const SampledWall& wall) {
  constexpr double kStep = 1.02, kPrecision = 1e-9;
  const double law = wall_law_N_per_m(wall);
  double low = 0, high = 0.01 * law;
  while (is_stable(wall, high)) {
    low = high, high *= kStep;
    if (high > 100 * law) return std::numeric_limits<double>::infinity();
  }
  if (low == 0) return 0;
  while (high - low > kPrecision * high) {
    const double middle = 0.5 * (low + high);
    (is_stable(wall, middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace remote_touch
