#include "scenarios/camera/camera_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::camera_scene_test {
namespace {

using Profile = std::vector<std::array<double, 2>>;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLow = -0.03, kHigh = 0.05;

const Profile kBox{{0.14, 0}, {0.26, 0}, {0.26, 0.08}, {0.14, 0.08}};
const Profile kRamp{{-0.05, 0}, {0.1, 0}, {0.1, 0.06}};
const Profile kOdd{{0.01, -0.02}, {0.06, 0.0}, {0.07, 0.05}, {0.03, 0.07}, {-0.02, 0.04}};

// Returns true if a level ray crosses the edges an odd number of times, which is valid for any polygon.
bool within(const Profile& profile, double z, double y) {
  bool odd = false;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto &a = profile[i], &b = profile[(i + 1) % profile.size()];
    if ((a[1] > y) != (b[1] > y) && z < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) odd = !odd;
  }
  return odd;
}
bool within(const Profile& profile, const Vec3& p) {
  return p.x() > kLow && p.x() < kHigh && within(profile, p.z(), p.y());
}

// Returns points on the whole surface. No part of the surface is farther than spacing from one of them.
std::vector<Vec3> surface(const Profile& profile, double spacing) {
  std::vector<Vec3> points;
  const auto parts = [&](double length) { return static_cast<int>(std::ceil(length / spacing)); };
  const int along = parts(kHigh - kLow);
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const auto &a = profile[i], &b = profile[(i + 1) % profile.size()];
    const double dz = b[0] - a[0], dy = b[1] - a[1];
    const int across = parts(std::sqrt(dz * dz + dy * dy));
    for (int j = 0; j <= across; ++j)
      for (int k = 0; k <= along; ++k)
        points.emplace_back(kLow + (kHigh - kLow) * k / along, a[1] + dy * j / across,
                            a[0] + dz * j / across);
  }
  for (double z = -0.1; z < 0.3; z += spacing)
    for (double y = -0.1; y < 0.1; y += spacing)
      if (within(profile, z, y))
        for (const double x : {kLow, kHigh}) points.emplace_back(x, y, z);
  return points;
}

Vec3 middle(const Profile& profile) {
  Vec3 sum(0.5 * (kLow + kHigh), 0, 0);
  for (const auto& corner : profile)
    sum += Vec3(0, corner[1], corner[0]) / static_cast<double>(profile.size());
  return sum;
}

class ExtrusionTest : public testing::TestWithParam<Profile> {
 protected:
  const Profile& profile() const { return GetParam(); }
  const Extrusion solid_{GetParam(), kLow, kHigh};
};

TEST_P(ExtrusionTest, SignedDistanceIsToTheNearestSampleOfTheSurface) {
  const double spacing = 0.001;
  const std::vector<Vec3> samples = surface(profile(), spacing);
  const PointCloud at = scenes::random_cloud(300, 0.1, 1);
  int inside = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    // Every other point is drawn near the middle, where the inside is.
    const Vec3 p = middle(profile()) + (i % 2 == 0 ? 1.0 : 0.3) * at.point(i);
    double squared = kInfinity;
    for (const Vec3& s : samples) squared = std::min(squared, (s - p).squaredNorm());
    const double got = solid_.signed_distance(p), nearest = std::sqrt(squared);
    EXPECT_EQ(got < 0, within(profile(), p)) << p.transpose();
    // A sample lies within spacing of the foot and, on a face, at a right angle to the foot's line.
    EXPECT_LE(std::abs(got), nearest + 1e-15) << p.transpose();
    EXPECT_GE(std::sqrt(got * got + spacing * spacing), nearest - 1e-15) << p.transpose();
    inside += got < 0;
  }
  EXPECT_GT(inside, 50);
  EXPECT_LT(inside, 250);
}

// Returns the first t at which the ray enters the solid, by small steps and bisection; infinite if there is
// none.
double walked_cast(const Extrusion& solid, const Vec3& origin, const Vec3& direction, double end) {
  const auto inside = [&](double t) { return solid.signed_distance(origin + t * direction) <= 0; };
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    double high = end * i / kSteps, low = end * (i - 1) / kSteps;
    if (!inside(high)) continue;
    if (i == 0) return 0;
    for (int k = 0; k < 60; ++k) (inside(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    return high;
  }
  return kInfinity;
}

TEST_P(ExtrusionTest, CastMeetsTheSurfaceWhereAWalkDoes) {
  const PointCloud from = scenes::random_cloud(600, 0.25, 2), displacement = scenes::random_cloud(600, 1, 3);
  int hits = 0, misses = 0, inside = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 origin = middle(profile()) + (i % 5 == 0 ? 0.1 : 1.0) * from.point(i);
    // Some directions point to the solid, others are random. Their lengths differ, because t is in units of
    // the direction.
    const Vec3 towards = middle(profile()) + 0.05 * displacement.point(i) - origin;
    const Vec3 direction = (i % 2 == 0 ? towards : displacement.point(i)) * (1 + static_cast<double>(i % 7));
    const double end = 1 / direction.norm();  // 1 m, beyond everything here
    const double got = solid_.cast(origin, direction);
    const double walked = walked_cast(solid_, origin, direction, end);
    if (got < kInfinity) {
      const double there = solid_.signed_distance(origin + got * direction);
      if (got > 0) {
        EXPECT_LT(std::abs(there), 1e-12) << i;
      }
      if (got == 0) {
        EXPECT_LE(there, 0) << i;
      }
      for (int k = 0; k < 100; ++k)
        EXPECT_GT(solid_.signed_distance(origin + got * k / 100 * direction), got > 0 ? 0 : -kInfinity);
      // The walk may step over a corner shorter than its steps, and then finds nothing.
      if (walked < kInfinity) {
        EXPECT_NEAR(got * direction.norm(), walked * direction.norm(), 1e-10) << i;
      }
      if (walked < kInfinity) ++hits;
      inside += got == 0;
    } else {
      EXPECT_EQ(walked, kInfinity) << i;
      ++misses;
    }
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(misses, 100);
  EXPECT_GT(inside, 50);
}

TEST_P(ExtrusionTest, HeightIsTheUpperOutline) {
  for (double z = -0.1005; z < 0.3; z += 0.003) {
    double top = -kInfinity;
    for (std::size_t i = 0; i < profile().size(); ++i) {
      const auto &a = profile()[i], &b = profile()[(i + 1) % profile().size()];
      if ((z - a[0]) * (z - b[0]) < 0) top = std::max(top, a[1] + (z - a[0]) / (b[0] - a[0]) * (b[1] - a[1]));
    }
    // height() casts a ray from 1 km above, so its result has the rounding error of that distance.
    if (top > -kInfinity)
      EXPECT_NEAR(solid_.height(0.01, z), top, 1e-12) << z;
    else
      EXPECT_EQ(solid_.height(0.01, z), -kInfinity) << z;
    EXPECT_EQ(solid_.height(kLow - 1e-6, z), -kInfinity);
    EXPECT_EQ(solid_.height(kHigh + 1e-6, z), -kInfinity);
  }
}

INSTANTIATE_TEST_SUITE_P(Profiles, ExtrusionTest, testing::Values(kBox, kRamp, kOdd),
                         [](const auto& profile) {
                           return profile.param == kBox ? "box" : profile.param == kRamp ? "ramp" : "odd";
                         });

TEST(Extrusion, ABoxHasTheValuesComputedByHand) {
  const Extrusion box(kBox, kLow, kHigh);
  EXPECT_NEAR(box.signed_distance({0, 0.1, 0.2}), 0.02, 1e-16);
  EXPECT_NEAR(box.signed_distance({0.08, 0.12, 0.2}), 0.05, 1e-16);     // an edge: 3-4-5
  EXPECT_NEAR(box.signed_distance({0.07, 0.09, 0.28}), 0.03, 1e-16);    // a corner: 2-1-2
  EXPECT_NEAR(box.signed_distance({0.045, 0.04, 0.2}), -0.005, 1e-16);  // nearest to a cap
  EXPECT_NEAR(box.cast({0, 0.5, 0.2}, {0, -2, 0}), 0.21, 1e-15);        // t is in units of the direction
  EXPECT_EQ(box.cast({0, 0.5, 0.2}, {0, 1, 0}), kInfinity);             // behind
  EXPECT_EQ(box.cast({0, 0.1, 0.2}, {1, 0, 0}), kInfinity);             // level, above the top
  EXPECT_NEAR(box.cast({-1, 0.04, 0.2}, {1, 0, 0}), 0.97, 1e-15);       // through a cap
}

}  // namespace
}  // namespace remote_touch::camera_scene_test
