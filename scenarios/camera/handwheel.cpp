#include "scenarios/camera/handwheel.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

namespace {

constexpr double kOnSurface_m = 1e-9;
// Limit of the steps of a ray. A ray that needs more passes very close to the surface and counts as a miss.
constexpr int kMaxSteps = 20000;
constexpr double kDifference_m = 1e-6;

// Directions of the spokes, 120 degrees apart, as (x, y).
constexpr double kSin60 = 0.86602540378443865;
constexpr double kSpokes[3][2] = {{0, 1}, {kSin60, -0.5}, {-kSin60, -0.5}};

// The functions below use coordinates relative to the wheel's centre. Each part is exact on both sides.

double across(const Vec3& q) {
  return std::sqrt(q.x() * q.x() + q.y() * q.y());
}

double to_ring(const Vec3& q, double ring_radius) {
  const double off = across(q) - ring_radius;
  return std::sqrt(off * off + q.z() * q.z()) - Handwheel::kTubeRadius_m;
}

// Distance to a spoke: a capsule from the centre to the middle of the ring's tube.
double to_spoke(const Vec3& q, const double (&displacement)[2], double ring_radius) {
  const double along = std::clamp(q.x() * displacement[0] + q.y() * displacement[1], 0.0, ring_radius);
  const double x = q.x() - along * displacement[0], y = q.y() - along * displacement[1];
  return std::sqrt(x * x + y * y + q.z() * q.z()) - Handwheel::kSpokeRadius_m;
}

// Distance to a cylinder about the axis, from z_low to z_high.
double to_cylinder(const Vec3& q, double radius, double z_low, double z_high) {
  const double beside = across(q) - radius, beyond = std::max(z_low - q.z(), q.z() - z_high);
  if (beside > 0 && beyond > 0) return std::sqrt(beside * beside + beyond * beyond);
  return std::max(beside, beyond);
}

}  // namespace

Handwheel::Handwheel(const Vec3& centre_m, double ring_radius_m)
    : centre_(centre_m), ring_radius_(ring_radius_m) {
  const double half = 0.5 * (centre_.z() + kHubHalfLength_m), wide = ring_radius_ + kTubeRadius_m;
  ball_centre_ = {centre_.x(), centre_.y(), half};
  ball_radius_ = 1.001 * std::sqrt(half * half + wide * wide);
}

double Handwheel::signed_distance(const Vec3& p) const {
  const Vec3 q = p - centre_;
  double distance = to_ring(q, ring_radius_);
  for (const auto& displacement : kSpokes)
    distance = std::min(distance, to_spoke(q, displacement, ring_radius_));
  distance = std::min(distance, to_cylinder(q, kHubRadius_m, -kHubHalfLength_m, kHubHalfLength_m));
  return std::min(distance, to_cylinder(q, kStemRadius_m, -centre_.z(), 0));
}

// Sphere tracing: no surface is nearer than the distance, so the ray can advance by that distance.
double Handwheel::cast(const Vec3& origin, const Vec3& direction) const {
  // Most rays of a camera miss even the ball around the wheel.
  const double length = direction.norm();
  const double middle = (ball_centre_ - origin).dot(direction) / (length * length);
  const double left =
      ball_radius_ * ball_radius_ - (origin + middle * direction - ball_centre_).squaredNorm();
  if (!(left >= 0)) return std::numeric_limits<double>::infinity();
  const double half = std::sqrt(left) / length;
  double t = std::max(0.0, middle - half);
  for (int step = 0; step < kMaxSteps && t <= middle + half; ++step) {
    const double distance = signed_distance(origin + t * direction);
    if (distance <= kOnSurface_m) return t;
    t += distance / length;
  }
  return std::numeric_limits<double>::infinity();
}

Vec3 Handwheel::normal(const Vec3& p) const {
  Vec3 slope;
  for (int i = 0; i < 3; ++i) {
    const Vec3 step = kDifference_m * Vec3::Unit(i);
    slope[i] = signed_distance(p + step) - signed_distance(p - step);
  }
  return slope.normalized();
}

}  // namespace remote_touch
