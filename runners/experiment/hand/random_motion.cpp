#include "runners/experiment/hand/random_motion.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/rotation.h"
#include "core/numeric/noise.h"

namespace remote_touch {

namespace {

// The sines' shares of the extent, and their relative rates. The ratios of the rates are irrational: the
// golden and the silver ratio.
constexpr double kFraction[] = {0.5, 0.3, 0.2};
constexpr double kRate[] = {1, 1.618033988749895, 2.414213562373095};
// The rates of the axes differ too, so that no two stay in phase: they are powers of two, with tenths and
// twelfths as exponents.
constexpr double kAxisRate[] = {
    1, 1.0717734625362931, 0.9438743126816935, 1.1486983549970351, 0.8705505632961241, 1.2311444133449163};
constexpr double kTwoPi = 6.283185307179586;

// Returns the rate of the first sine of x, rad/s, at which the largest speeds of all sines add up to the
// allowed speed.
double rate_of_first_sine(const RandomMotion::Settings& s) {
  double of_all = 0;
  for (int i = 0; i < 3; ++i) of_all += kFraction[i] * kRate[i];
  const Vec3 of_axes = of_all * s.extent_m.cwiseProduct(Vec3(kAxisRate[0], kAxisRate[1], kAxisRate[2]));
  return s.speed_m_per_s / of_axes.norm();
}

}  // namespace

Parameters parameters(RandomMotion::Settings& s) {
  return {
      {"centre_m", &s.centre_m, -100, 100, "centre of the box that the device stays in"},
      {"extent_m", &s.extent_m, 0, 100, "half size of the box"},
      {"max_rotation_deg", &s.max_rotation_deg, 0, 180, "maximum rotation"},
      {"speed_m_per_s", &s.speed_m_per_s, 0, 100, "maximum speed"},
      {"seed", &s.seed, 0, 18446744073709551615.0, "seed of the motion"},
      {"duration_s", &s.duration_s, 1e-3, 1e5, "duration of the motion; the device then stops"},
  };
}

std::string validate(const RandomMotion::Settings& s) {
  if (!(s.extent_m.norm() > 0)) return "extent_m = 0, 0, 0: expected above 0 along one axis or more";
  return rate_of_first_sine(s) * s.duration_s < 1e5
             ? ""
             : "extent_m is too small for speed_m_per_s and duration_s: expected fewer than 15000 oscillations";
}

RandomMotion::RandomMotion(const Settings& settings, const Scenario&)
    : settings_(settings), rate_(rate_of_first_sine(settings)) {
  const NoiseStream stream = noise_stream({settings.seed}, NoiseUse::motion, 0);
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const auto random = uniforms(stream, static_cast<std::uint32_t>(axis));
    for (std::size_t i = 0; i < kSines; ++i) phase_[axis][i] = kTwoPi * random[i];
  }
}

double RandomMotion::coordinate(int axis, double time_s) const {
  double sum = 0;
  for (int i = 0; i < kSines; ++i) {
    const double phase = phase_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(i)];
    sum += kFraction[i] * sin_cos(kRate[i] * kAxisRate[axis] * rate_ * time_s + phase).first;
  }
  return sum;
}

DeviceState RandomMotion::at(double time_s) const {
  const double t = std::clamp(time_s, 0.0, settings_.duration_s);
  Vec3 position, angles;
  for (int axis = 0; axis < 3; ++axis) {
    position[axis] = settings_.centre_m[axis] + settings_.extent_m[axis] * coordinate(axis, t);
    angles[axis] = coordinate(axis + 3, t);
  }
  // The rotation vector lies in a cube, whose corners are farther from the centre than its faces by the root
  // of three. The division keeps the rotation below max_rotation_deg.
  constexpr double root_of_three = 1.7320508075688772;
  return {position, rotation(settings_.max_rotation_deg * kRadiansPerDegree / root_of_three * angles)};
}

}  // namespace remote_touch
