// Random unions of forbidden regions, paths of a hand through them, and reference results by plain loops over
// all points. This file uses neither the kernels nor the searches nor the renderer.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch::spheres {

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return low + (high - low) * (random_() / 4294967296.0); }
  Vec3 in_cube(double half_width) {
    const double x = between(-half_width, half_width), y = between(-half_width, half_width);
    return {x, y, between(-half_width, half_width)};
  }
  Vec3 direction() {
    Vec3 d = in_cube(1);
    while (d.norm() > 1 || d.norm() < 0.1) d = in_cube(1);
    return d.normalized();
  }

 private:
  std::mt19937 random_;
};

// 20 to 300 points within half_width of the origin along each axis, radii of 0 to 0.03 m, every fourth 0.
inline PointCloud random_union(unsigned seed, double half_width) {
  Draw draw(seed);
  PointCloud cloud;
  const int count = static_cast<int>(draw.between(20, 301));
  for (int i = 0; i < count; ++i) {
    cloud.append(draw.in_cube(half_width));
    const double radius = draw.between(0, 0.03);
    cloud.fixture_radius_m.push_back(i % 4 == 0 ? 0 : radius);
  }
  return cloud;
}

// r_n of (5.5) at the nearest region.
inline double nearest_region(const PointCloud& cloud, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < cloud.size(); ++i)
    nearest = std::min(nearest, (p - cloud.point(i)).norm() - cloud.fixture_radius_m[i]);
  return nearest;
}

// Segments of kSegment ticks: the hand jumps, sways through the cloud for kMoving of them, and rests.
class HandPath {
 public:
  static constexpr int kSegment = 400, kMoving = 250;
  HandPath(unsigned seed, double half_width) : draw_(seed), half_width_(half_width) {}

  // Returns the hand's position. Call it with 0, 1, 2, ... in order. The first position is outside.
  Vec3 at(int tick) {
    if (tick == 0) return {half_width_ + 0.1, 0, 0};
    const int within = tick % kSegment;
    if (within == 1) {
      middle_ = draw_.in_cube(half_width_), phase_ = draw_.in_cube(3.14), sway_ = draw_.in_cube(half_width_);
      rad_per_s_ = Vec3::Constant(4) + draw_.in_cube(3);
    }
    const double time_s = 0.001 * std::min(within == 0 ? kSegment : within, kMoving);
    const Vec3 angle = time_s * rad_per_s_ + phase_;
    return middle_ + (sway_.array() * angle.array().sin()).matrix();
  }

 private:
  Draw draw_;
  double half_width_;
  Vec3 middle_ = Vec3::Zero(), phase_ = Vec3::Zero(), sway_ = Vec3::Zero(), rad_per_s_ = Vec3::Zero();
};

// Returns the points whose regions are within reach of p. They suffice for many queries near p.
inline PointCloud close_to(const PointCloud& cloud, const Vec3& p, double reach) {
  PointCloud close;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if ((p - cloud.point(i)).norm() - cloud.fixture_radius_m[i] <= reach) {
      close.append(cloud.point(i));
      close.fixture_radius_m.push_back(cloud.fixture_radius_m[i]);
    }
  return close;
}

// Moves x out of the regions that contain it, one after the other, straight to the margin. Returns nullopt if
// x is not outside all of them after 12 rounds.
inline std::optional<Vec3> brought_out(const PointCloud& cloud, Vec3 x, double margin) {
  for (int round = 0; round < 12; ++round) {
    bool out = true;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3 away = x - cloud.point(i);
      const double allowed = cloud.fixture_radius_m[i] + margin, distance = away.norm();
      if (distance >= allowed * (1 - 1e-12) || distance == 0) continue;
      x = cloud.point(i) + away * (allowed / distance), out = false;
    }
    if (out) return x;
  }
  return std::nullopt;
}

// Result of a random search around p for an allowed position (r_n >= margin) near the HIP: the position and
// its distance to the HIP. Each try moves p in a random direction by one of several lengths, brings it out of
// the regions and drops it if it is farther than radius from p.
struct Better {
  Vec3 x;
  double distance;
};
inline Better nearest_to_hip_around(const PointCloud& cloud, const Vec3& p, const Vec3& hip, double margin,
                                    double radius, int directions, Draw& draw) {
  const PointCloud close = close_to(cloud, p, margin + 3 * radius);
  Better best{p, std::numeric_limits<double>::infinity()};
  for (int k = 0; k < directions; ++k) {
    const Vec3 displacement = draw.direction();
    for (const double fraction : {1.0, 0.5, 0.2, 0.05, 0.01}) {
      const std::optional<Vec3> x = brought_out(close, p + fraction * radius * displacement, margin);
      if (!x || (*x - p).norm() > radius || !((hip - *x).norm() < best.distance)) continue;
      best = {*x, (hip - *x).norm()};
    }
  }
  return best;
}

}  // namespace remote_touch::spheres
