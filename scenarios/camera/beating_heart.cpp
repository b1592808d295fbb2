#include "scenarios/camera/beating_heart.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {
namespace {

// The closest point x to q on an ellipsoid with semi-axes e obeys q - x = s x / e^2 for some s (Lagrange),
// with x in the octant of q. With s = tau - e_min^2 and g = e^2 - e_min^2, x = e^2 q / (tau + g), and tau >=
// 0 is the root of sum (e q / (tau + g))^2 = 1, whose left side falls and is convex.
struct ClosestPoint {
  Vec3 scaled;  // e |q|
  Vec3 gap;     // g
  int shortest;

  // x / e at tau, in the first octant.
  Vec3 unit(double tau) const {
    return {scaled.x() / (tau + gap.x()), scaled.y() / (tau + gap.y()), scaled.z() / (tau + gap.z())};
  }
  double excess(double tau) const { return unit(tau).squaredNorm() - 1; }
  double root(double low) const;
};

// pre: excess(low) > 0 and low > 0.
double ClosestPoint::root(double low) const {
  // Lower bound: where one term alone is 1, the sum is at least 1. Upper bound: at tau = |scaled| the sum
  // would be 1 without gaps, so that it is at most 1.
  low = std::max({low, scaled.x() - gap.x(), scaled.y() - gap.y(), scaled.z() - gap.z()});
  double high = std::max(low, scaled.norm());
  // Each step halves the logarithm of high / low: 12 steps reduce the range of all doubles to a factor of 2.
  for (int i = 0; i < 12 && high > 2 * low; ++i) {
    const double between = std::sqrt(low) * std::sqrt(high);
    (excess(between) > 0 ? low : high) = between;
  }
  // Newton's method on a convex function that falls cannot pass the root if it starts left of it. A start
  // within a factor of 2 of the root gives all digits after seven steps.
  double tau = low;
  for (int i = 0; i < 10; ++i) {
    const Vec3 x = unit(tau);
    const double slope = 2 * (x.x() * x.x() / (tau + gap.x()) + x.y() * x.y() / (tau + gap.y()) +
                              x.z() * x.z() / (tau + gap.z()));
    tau += std::max(0.0, (x.squaredNorm() - 1) / slope);
  }
  return tau;
}

// Ends of the phases of a ventricle, as fractions of a beat: it contracts, stays contracted, relaxes, and
// rests until the beat ends. The atrium is ahead of the ventricles by kAtriumLeads.
constexpr double kContracted = 0.3, kRelaxes = 0.35, kRelaxed = 0.75;
constexpr double kAtriumLeads = 0.18;

// Vertical semi-axis of the left ventricle, which ends at the organ's top. amplitude_m is the largest
// decrease of this semi-axis.
constexpr double kTopSemiAxis_m = 0.032;

// Reds that differ a little (hues 3 to 11 degrees) for the organ, and hue 190 for the drape on the table.
constexpr std::uint32_t kLeftVentricle = 0xB23A30, kRightVentricle = 0xC4553C, kAtrium = 0x9A2F2A;
constexpr std::uint32_t kTable = 0x3A6E78;

// Rises from 0 to 1 with zero velocity and zero acceleration at both ends.
double smooth_step(double u) {
  u = std::clamp(u, 0.0, 1.0);
  return u * u * u * (10 - u * (15 - 6 * u));
}

// A turn of 16.3 degrees about y.
Eigen::Matrix3d turned() {
  Eigen::Matrix3d axes;
  axes << 0.96, 0, 0.28,  //
      0, 1, 0,            //
      -0.28, 0, 0.96;
  return axes;
}

}  // namespace

Ellipsoid::Ellipsoid(const Vec3& centre_m, const Vec3& semi_axes_m, const Eigen::Matrix3d& axes)
    : centre_(centre_m), semi_axes_(semi_axes_m), axes_(axes) {
  for (int i = 0; i < 3; ++i) to_unit_ball_.row(i) = axes_.col(i).transpose() / semi_axes_[i];
}

Vec3 Ellipsoid::closest(const Vec3& p) const {
  const Vec3 q = axes_.transpose() * (p - centre_);
  ClosestPoint problem;
  semi_axes_.minCoeff(&problem.shortest);
  const double shortest = semi_axes_[problem.shortest];
  problem.scaled = semi_axes_.cwiseProduct(q.cwiseAbs());
  for (int i = 0; i < 3; ++i) problem.gap[i] = (semi_axes_[i] - shortest) * (semi_axes_[i] + shortest);

  // The root goes to 0 if p is deep enough inside and near the plane through the centre that is perpendicular
  // to the shortest axis. There the surface above and the surface below that plane are equally close, and the
  // coordinate along the shortest axis follows from the other two.
  const double min = 1e-20 * shortest * shortest;
  Vec3 unit;
  if (problem.excess(min) > 0) {
    unit = problem.unit(problem.root(min));
  } else {
    unit = problem.unit(min);
    unit[problem.shortest] = 0;
    unit[problem.shortest] = std::sqrt(1 - unit.squaredNorm());
  }
  Vec3 x;
  for (int i = 0; i < 3; ++i) x[i] = std::copysign(semi_axes_[i] * unit[i], q[i]);
  return centre_ + axes_ * x;
}

double Ellipsoid::signed_distance(const Vec3& p) const {
  const double distance = (p - closest(p)).norm();
  return level(p) < 1 ? -distance : distance;
}

// The chord is computed in coordinates in which the ellipsoid is the unit ball. half is computed from the
// point of the line that is nearest to the centre, so that it is as exact for a far origin as for a near one.
Ellipsoid::Chord Ellipsoid::chord(const Vec3& origin, const Vec3& direction) const {
  // Most rays of a camera miss even the ball around the solid. This test needs no rotation and no division.
  const Vec3 displacement = centre_ - origin;
  const double radius = 1.001 * semi_axes_.maxCoeff(), along = displacement.dot(direction);
  if ((displacement.squaredNorm() - radius * radius) * direction.squaredNorm() > along * along)
    return {0, std::numeric_limits<double>::quiet_NaN()};
  const Vec3 o = to_unit_ball_ * (origin - centre_), d = to_unit_ball_ * direction;
  const double squared = d.squaredNorm(), middle = -o.dot(d) / squared;
  const double left = 1 - (o + middle * d).squaredNorm();
  return {middle, left >= 0 ? std::sqrt(left / squared) : std::numeric_limits<double>::quiet_NaN()};
}

double Ellipsoid::cast(const Vec3& origin, const Vec3& direction) const {
  const Chord line = chord(origin, direction);
  return line.middle + line.half >= 0 ? std::max(0.0, line.middle - line.half)
                                      : std::numeric_limits<double>::infinity();
}

double Ellipsoid::height(double x, double z) const {
  const Chord line = chord({x, centre_.y(), z}, {0, 1, 0});
  return std::isnan(line.half) ? -std::numeric_limits<double>::infinity()
                               : centre_.y() + line.middle + line.half;
}

Parameters parameters(BeatingHeart::Settings& s) {
  const Parameters own = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the camera per second, f_c"},
      {"rate_per_min", &s.rate_per_min, 1, 600, "beats per minute"},
      {"amplitude_m", &s.amplitude_m, 0, 0.015,
       "amplitude of the motion of the organ's top in each beat; 0: no motion"},
  };
  return appended(own, parameters(s.camera));
}

BeatingHeart::BeatingHeart(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings), camera_(settings.camera, key, kernels) {}

int BeatingHeart::frame_count() const {
  return settings_.amplitude_m > 0 || camera_.noisy() ? std::numeric_limits<int>::max() : 1;
}

double BeatingHeart::contraction(double beats) {
  const double phase = beats - std::floor(beats);
  return phase < kRelaxes ? smooth_step(phase / kContracted)
                          : 1 - smooth_step((phase - kRelaxes) / (kRelaxed - kRelaxes));
}

std::array<BeatingHeart::Lobe, 3> BeatingHeart::lobes(double time_s) const {
  const double beats = time_s * settings_.rate_per_min / 60;
  const double max = settings_.amplitude_m / kTopSemiAxis_m;
  const double ventricles = 1 - max * contraction(beats);
  const double atrium = 1 - max * contraction(beats + kAtriumLeads);
  return {{
      {Ellipsoid({0, 0.028, 0}, ventricles * Vec3(0.040, kTopSemiAxis_m, 0.034)), kLeftVentricle},
      {Ellipsoid({0.004, 0.020, 0.024}, ventricles * Vec3(0.036, 0.026, 0.026), turned()), kRightVentricle},
      {Ellipsoid({-0.035, 0.022, -0.004}, atrium * Vec3(0.020, 0.022, 0.024)), kAtrium},
  }};
}

double BeatingHeart::surface_height(double x, double z, double time_s) const {
  double height = 0;
  for (const Lobe& lobe : lobes(time_s)) height = std::max(height, lobe.solid.height(x, z));
  return height;
}

double BeatingHeart::signed_distance(const Vec3& p_W, double time_s) const {
  double distance = p_W.y();
  for (const Lobe& lobe : lobes(time_s)) distance = std::min(distance, lobe.solid.signed_distance(p_W));
  return distance;
}

PointCloud BeatingHeart::cloud(int frame) const {
  const auto now = lobes(captured_s(frame));
  const auto cast = [&now](const Vec3& origin_W, const Vec3& ray_W) {
    RayHit hit;
    if (ray_W.y() < 0) hit = {-origin_W.y() / ray_W.y(), kTable};
    for (const Lobe& lobe : now) {
      const double t = lobe.solid.cast(origin_W, ray_W);
      if (t < hit.t) hit = {t, lobe.colour};
    }
    return hit;
  };
  return camera_.measured(camera_.view(cast, /*coloured=*/true), frame);
}

}  // namespace remote_touch
