#include "analysis/theory/tool_jump.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

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
