#include "core/points/vector.h"

#include <cmath>

namespace remote_touch {

std::pair<double, double> sin_cos(double angle) {
  assert(!(std::abs(angle) >= 1e6));
  // A quarter turn (pi / 2) is split into two parts. The first part has few bits, so its product with an
  // integer below 2^20 is exact.
  constexpr double quarter = 1.5707963267341256, rest = 6.0771005065061922e-11;
  const double turns = std::round(angle / (quarter + rest));
  const double x = (angle - turns * quarter) - turns * rest, xx = x * x;
  double s = 0, c = 0;
  for (int n = 20; n >= 2; n -= 2) {  // 0.79^20 / 20! is 4e-21
    c = (1 - c) * xx / (n * (n - 1));
    s = (1 - s) * xx / (n * (n + 1));
  }
  s = x * (1 - s), c = 1 - c;
  switch (static_cast<int>(turns) & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

Eigen::Quaterniond rotation(const Vec3& vector) {
  const double angle = vector.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  const auto [s, c] = sin_cos(0.5 * angle);
  const Vec3 axis = vector / angle * s;
  return Eigen::Quaterniond(c, axis.x(), axis.y(), axis.z()).normalized();
}

Vec3 rotation_vector(const Eigen::Quaterniond& rotation) {
  const Vec3 axis = rotation.w() < 0 ? Vec3(-rotation.vec()) : Vec3(rotation.vec());
  const double sine = axis.norm();
  if (sine == 0) return Vec3::Zero();
  // Tangents of a quarter, an eighth and a sixteenth of the angle; the last is at most 0.2.
  double t = sine / (1 + std::abs(rotation.w()));
  for (int halving = 0; halving < 2; ++halving) t /= 1 + std::sqrt(1 + t * t);
  double series = 0;
  for (int n = 25; n >= 1; n -= 2) series = 1.0 / n - t * t * series;
  return axis * (16 * t * series / sine);
}

}  // namespace remote_touch
