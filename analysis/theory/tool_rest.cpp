#include "analysis/theory/tool_rest.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

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
  return std::asin(w_m / std::hypot(a_m, b_m)) - std::atan2(b_m, a_m);
}

RestingWrench bar_in_slot(double a_m, double b_m, double w_m, const EvenSpring& spring, double angle_rad) {
  const double beyond = std::max(0.0, std::abs(angle_rad) - stop_angle_rad(a_m, b_m, w_m));
  return {{0, 0}, -std::copysign(turning_stiffness(spring) * beyond, angle_rad)};
}

}  // namespace remote_touch
