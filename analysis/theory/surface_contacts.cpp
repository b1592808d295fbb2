#include "analysis/theory/surface_contacts.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/trace/curve_fits.h"
#include "analysis/trace/trace.h"

namespace remote_touch {

std::vector<double> ball_closing(const std::vector<double>& heights, double spacing, double radius) {
  const int count = static_cast<int>(heights.size()), reach = static_cast<int>(radius / spacing);
  std::vector<double> cap;  // half-height of the ball at an offset of k samples
  for (int k = 0; k <= reach; ++k)
    cap.push_back(std::sqrt(std::max(0.0, radius * radius - k * spacing * k * spacing)));

  const auto slide = [&](const std::vector<double>& from, double start, auto&& better, double sign) {
    std::vector<double> to(from.size(), start);
    for (int i = 0; i < count; ++i)
      for (int j = std::max(0, i - reach); j <= std::min(count - 1, i + reach); ++j)
        to[static_cast<std::size_t>(i)] =
            better(to[static_cast<std::size_t>(i)],
                   from[static_cast<std::size_t>(j)] + sign * cap[static_cast<std::size_t>(std::abs(i - j))]);
    return to;
  };
  const double infinite = std::numeric_limits<double>::infinity();
  // Dilation: the lowest centre that keeps the ball off every sample; erosion: the lowest underside of those
  // balls.
  const auto highest = [](double a, double b) { return std::max(a, b); };
  const auto lowest = [](double a, double b) { return std::min(a, b); };
  return slide(slide(heights, -infinite, highest, +1), infinite, lowest, -1);
}

namespace {

double turning_stiffness(const EvenSpring& spring) {
  return spring.stiffness_N_per_m * spring.gyration_radius_m * spring.gyration_radius_m;
}

// Probability that a standard normal number is larger than x.
double above(double x) {
  return 0.5 * std::erfc(x * std::sqrt(0.5));
}

// Returns the position at which a decreasing function passes one half, by bisection.
template <class Function>
double median(double low, double high, Function&& falling) {
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (falling(middle) > 0.5 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double plane_height(const Trace& trace, std::size_t i, const Vec3& normal) {
  return trace.proxy_position_m[i].dot(normal) - trace.signed_distance_m[i];
}

// Returns the normal that (4.3) used. If (4.3) moved nothing, it is the normal with which the tick before
// ended.
Vec3 normal_of_update(const Trace& trace, std::size_t first_tick) {
  const Vec3 frame_correction = trace.frame_correction_m[first_tick];
  return frame_correction.isZero(0) ? trace.normal[first_tick - 1] : Vec3(frame_correction.normalized());
}

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

bool counts(const LiftUpdate& update, SettledFrom settled) {
  return update.above_before && update.frame > settled.frame;
}

struct Sums {
  double sum = 0, squares = 0;
  std::size_t count = 0;
  void add(double value) {
    sum += value, squares += value * value;
    ++count;
  }
  double mean() const { return sum / static_cast<double>(count); }
  double variance() const {
    const double n = static_cast<double>(count);
    const double value = n > 1 ? (squares - sum * sum / n) / (n - 1) : kNotKnown;
    return value < 0 ? 0 : value;  // NaN stays NaN
  }
  double deviation() const { return std::sqrt(variance()); }
};

// Error of v_hat_j against v_{j-1}, which is v_j, the velocity of the update itself, without acceleration.
double velocity_error(const LiftUpdate& update) {
  return update.estimate_m_per_s - update.velocity_m_per_s;
}

// 1 - correlation of the velocity error at one update with that at the next.
double gain(const std::vector<std::vector<LiftUpdate>>& lifts, SettledFrom settled, double mean) {
  double product = 0, square = 0;
  for (const std::vector<LiftUpdate>& lift : lifts)
    for (std::size_t i = 1; i < lift.size(); ++i) {
      if (!counts(lift[i - 1], settled) || !counts(lift[i], settled)) continue;
      const double before = velocity_error(lift[i - 1]) - mean, after = velocity_error(lift[i]) - mean;
      product += before * after, square += before * before;
    }
  // Below this the errors are rounding, not noise.
  constexpr double kRounding = 1e-16;
  return square > kRounding ? std::clamp(1 - product / square, 0.0, 1.0) : 1;
}

}  // namespace

// The derivative of the energy k (h - height)^2 / 2 + k r^2 (phi - angle)^2 / 2 increases between flat and
// the angle of the hand, so bisection finds its zero.
RestingWrench block_on_line(double a_m, double b_m, const EvenSpring& spring, double height_m,
                            double angle_rad) {
  const double k = spring.stiffness_N_per_m, turning = turning_stiffness(spring);
  const double wanted = std::abs(angle_rad);
  const auto touching_m = [&](double phi) { return a_m * std::sin(phi) + b_m * std::cos(phi); };
  if (height_m >= touching_m(wanted)) return {};
  const auto slope = [&](double phi) {
    return k * (touching_m(phi) - height_m) * (a_m * std::cos(phi) - b_m * std::sin(phi)) +
           turning * (phi - wanted);
  };
  double low = 0, high = wanted;
  if (slope(0) >= 0) high = 0;  // it lies flat
  for (int i = 0; i < 100 && low < high; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) < 0 ? low : high) = middle;
  }
  const double torque_Nm = turning * (high - wanted);
  return {{0, k * (touching_m(high) - height_m)}, angle_rad < 0 ? -torque_Nm : torque_Nm};
}

// The middle of the ball must be at least a radius away from both lines. The nearest such position to the
// hand is over one line, or over the edge.
RestingWrench ball_in_groove(double radius_m, double slope_rad, const EvenSpring& spring,
                             const Eigen::Vector2d& place_m) {
  const double side = place_m.x() < 0 ? -1 : 1;
  const Eigen::Vector2d place(std::abs(place_m.x()), place_m.y());
  const Eigen::Vector2d normal(-std::sin(slope_rad), std::cos(slope_rad));
  const double missing_m = radius_m - normal.dot(place);
  if (missing_m <= 0) return {};
  Eigen::Vector2d rest = place + missing_m * normal;
  if (rest.x() < 0) rest = {0, radius_m / std::cos(slope_rad)};
  const Eigen::Vector2d force_N = spring.stiffness_N_per_m * (rest - place);
  return {{side * force_N.x(), force_N.y()}, 0};
}

double stop_angle_rad(double a_m, double b_m, double w_m) {
  assert(b_m < w_m && w_m < a_m);
  return std::asin(w_m / std::hypot(a_m, b_m)) - std::atan2(b_m, a_m);
}

RestingWrench bar_in_slot(double a_m, double b_m, double w_m, const EvenSpring& spring, double angle_rad) {
  const double beyond = std::max(0.0, std::abs(angle_rad) - stop_angle_rad(a_m, b_m, w_m));
  return {{0, 0}, -std::copysign(turning_stiffness(spring) * beyond, angle_rad)};
}

UnderPlate under_edge(double slope_rad, double half_m, double turn_rad) {
  return {half_m * std::tan(slope_rad + turn_rad), half_m * std::tan(std::max(0.0, turn_rad - slope_rad))};
}

// The lowest position is the corner (half, -half) of the plate. It is over the face that faces (cos 30, -sin
// 30), 120 degrees from the face that faces +z.
UnderPlate under_corner(double slope_rad, double half_m) {
  return {half_m * 0.5 * (1 + std::sqrt(3.0)) * std::tan(slope_rad), 0};
}

UnderPlate under_ball(double radius_m, double seen_m) {
  const double beside_m = std::min(radius_m, seen_m);
  return {radius_m - std::sqrt(radius_m * radius_m - beside_m * beside_m), 0};
}

double noisy_jump_m(double thickness_m, const std::vector<NoisyPoint>& points, double sigma_m) {
  assert(sigma_m > 0);
  constexpr double kReach = 10;  // standard deviations, beyond which there is no point
  const auto [lowest, highest] = std::ranges::minmax_element(
      points, [](const NoisyPoint& a, const NoisyPoint& b) { return a.height_m < b.height_m; });
  const auto any_above = [&](double x) {
    double none = 1;
    for (const NoisyPoint& p : points)
      none *= 1 - p.under_plate_probability * above((x - p.height_m) / sigma_m);
    return 1 - none;
  };
  const double bottom_m = median(highest->height_m - kReach * sigma_m, highest->height_m + kReach * sigma_m,
                                 [&](double x) { return any_above(x); });
  const auto any_in_plate = [&](double jump_m) {
    double none = 1;
    for (const NoisyPoint& p : points) {
      const double place = (bottom_m - p.height_m - jump_m) / sigma_m;
      none *= 1 - p.under_plate_probability * (above(place) - above(place + thickness_m / sigma_m));
    }
    return 1 - none;
  };
  // A jump of only the plate's thickness leaves some points in it. A jump beyond all points leaves none.
  return median(thickness_m, thickness_m + highest->height_m - lowest->height_m + 2 * kReach * sigma_m,
                any_in_plate);
}

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

std::vector<LiftUpdate> lift_updates(const Trace& trace, const Vec3& normal, double r1_m,
                                     double frame_rate_hz) {
  std::vector<LiftUpdate> updates;
  for (std::size_t i = 1; i < trace.length(); ++i) {
    if (!trace.frame_update(i)) continue;
    if (!updates.empty()) updates.back().above_after = trace.signed_distance_m[i - 1] > 0;
    LiftUpdate update;
    update.frame = trace.frame_index[i];
    update.velocity_m_per_s =
        (plane_height(trace, i, normal) - plane_height(trace, i - 1, normal)) * frame_rate_hz;
    update.estimate_m_per_s = trace.surface_velocity_m_per_s[i - 1];
    update.thickness_m = trace.signed_distance_m[i - 1] - r1_m;
    update.normal_error = 1 - normal.dot(normal_of_update(trace, i));
    update.frame_correction_m = trace.frame_correction_m[i].dot(normal);
    update.above_before = trace.signed_distance_m[i - 1] > 0;
    updates.push_back(update);
  }
  if (!updates.empty()) updates.back().above_after = trace.signed_distance_m.back() > 0;
  return updates;
}

NoiseEffect noise_effect(const std::vector<std::vector<LiftUpdate>>& lifts, SettledFrom settled, double r1_m,
                         double frame_rate_hz) {
  Sums thickness, normal_error, velocity, margin;
  for (const std::vector<LiftUpdate>& lift : lifts)
    for (const LiftUpdate& update : lift) {
      if (!counts(update, settled)) continue;
      thickness.add(update.thickness_m);
      normal_error.add(update.normal_error);
      velocity.add(velocity_error(update));
      margin.add(update.margin_m(r1_m, frame_rate_hz));
    }
  return {thickness.mean(),    thickness.deviation(),
          normal_error.mean(), normal_error.deviation(),
          velocity.mean(),     velocity.deviation(),
          margin.deviation(),  velocity.count > 1 ? gain(lifts, settled, velocity.mean()) : kNotKnown};
}

LiftMeans lift_means(const std::vector<LiftUpdate>& lift, SettledFrom settled) {
  Sums thickness, normal_error;
  for (const LiftUpdate& update : lift) {
    if (!counts(update, settled)) continue;
    thickness.add(update.thickness_m);
    normal_error.add(update.normal_error);
  }
  if (thickness.count == 0) return {kNotKnown, kNotKnown};
  return {thickness.mean(), normal_error.mean()};
}

}  // namespace remote_touch
