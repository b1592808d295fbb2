#include "analysis/theory/exact_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

namespace {

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

}  // namespace

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
  const auto [lowest, highest] =
      std::minmax_element(points.begin(), points.end(),
                          [](const NoisyPoint& a, const NoisyPoint& b) { return a.height_m < b.height_m; });
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

}  // namespace remote_touch
