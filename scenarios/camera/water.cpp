#include "scenarios/camera/water.h"

#include <algorithm>

namespace remote_touch {

namespace {

constexpr double kNoLightLeft = 64;  // exp(-64) = 1.6e-28
constexpr int kSquarings = 10;
constexpr double kDepthLoss = 0.25;  // factor on beta
constexpr double kFar_m = 1e6;       // replaces infinity, because 0 times infinity is NaN

}  // namespace

// exp(-x) = exp(-x / 1024)^1024, whose inner argument is small enough for eight terms of the series.
double decay(double x) {
  if (x >= kNoLightLeft) return 0;
  const double small = x / (1 << kSquarings);
  double value = 1;
  for (int n = 8; n > 0; --n) value = 1 - small / n * value;
  for (int i = 0; i < kSquarings; ++i) value *= value;
  return value;
}

std::array<double, 3> Water::seen(std::uint32_t rgb, double distance_m) const {
  const double depth = turbidity_per_m_ * std::min(distance_m, kFar_m);
  std::array<double, 3> channels{};
  for (int i = 0; i < 3; ++i) {
    const double through = decay(kAttenuation[i] * depth), own = rgb >> (16 - 8 * i) & 0xFF;
    channels[static_cast<std::size_t>(i)] = own * through + kVeil[i] * (1 - through);
  }
  return channels;
}

double Water::lost(double dropout_probability, double distance_m) const {
  return 1 - (1 - dropout_probability) * decay(kDepthLoss * turbidity_per_m_ * std::min(distance_m, kFar_m));
}

double Water::depth_noise_factor(double distance_m) const {
  return 1 + turbidity_per_m_ * std::min(distance_m, kFar_m);
}

}  // namespace remote_touch
