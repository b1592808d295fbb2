#include "analysis/theory/lift_noise.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

namespace {

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
