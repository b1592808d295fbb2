// The solids that cameras see: distances and ray casts of prisms and handwheels against a predicate of their
// inside, and ellipsoids against the conditions of a closest point.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "scenarios/simulated/camera_scenes.h"
#include "scenarios/simulated/depth_camera.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace remote_touch::solids_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Solid {
  std::string name;
  Vec3 middle;
  bool has_depth;  // the distance inside is that to the surface, else only a bound
  std::function<bool(const Vec3&)> inside;
  std::function<double(const Vec3&)> distance;
  std::function<double(const Vec3& origin, const Vec3& direction)> cast;
};
void PrintTo(const Solid& solid, std::ostream* out) {
  *out << solid.name;
}

using Profile = std::vector<std::array<double, 2>>;
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

Solid prism(const char* name, const Profile& profile) {
  Vec3 middle(0.5 * (kLow + kHigh), 0, 0);
  for (const auto& [z, y] : profile) middle += Vec3(0, y, z) / static_cast<double>(profile.size());
  const Extrusion solid(profile, kLow, kHigh);
  return {name,
          middle,
          true,
          [profile](const Vec3& p) { return within(profile, p); },
          [solid](const Vec3& p) { return solid.signed_distance(p); },
          [solid](const Vec3& origin, const Vec3& direction) { return solid.cast(origin, direction); }};
}

// The parts are tubes about a curve and cylinders: each has an inequality of its own.
bool inside_wheel(const Vec3& q, const Vec3& centre, double ring_m) {
  const double across = std::hypot(q.x(), q.y());
  const auto within = [&](double radius, double low, double high) {
    return across < radius && q.z() > low && q.z() < high;
  };
  bool any = (q - ring_m * Vec3(q.x(), q.y(), 0).normalized()).norm() < Handwheel::kTubeRadius_m ||
             within(Handwheel::kHubRadius_m, -Handwheel::kHubHalfLength_m, Handwheel::kHubHalfLength_m) ||
             within(Handwheel::kStemRadius_m, -centre.z(), 0);
  for (int i = 0; i < 3; ++i) {
    const double angle = std::numbers::pi / 2 + i * 2 * std::numbers::pi / 3;
    const Vec3 spoke(std::cos(angle), std::sin(angle), 0);
    any |= (q - std::clamp(q.dot(spoke), 0.0, ring_m) * spoke).norm() < Handwheel::kSpokeRadius_m;
  }
  return any;
}

Solid wheel(const char* name, const Vec3& centre, double ring_m) {
  const Handwheel solid(centre, ring_m);
  return {name,
          centre,
          false,
          [=](const Vec3& p) { return inside_wheel(p - centre, centre, ring_m); },
          [solid](const Vec3& p) { return solid.signed_distance(p); },
          [solid](const Vec3& origin, const Vec3& direction) { return solid.cast(origin, direction); }};
}

class SolidTest : public testing::TestWithParam<Solid> {
 protected:
  const Solid& solid_ = GetParam();
};

// The distance is right if its foot is on the surface, and the ball that it spans lies on one side.
TEST_P(SolidTest, TheDistanceEndsOnTheSurfaceAndNothingIsNearer) {
  constexpr double kStep_m = 1e-7;
  const PointCloud at = scenes::random_cloud(400, 0.1, 1), directions = scenes::random_cloud(200, 1, 4);
  int inside = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    // Every other point is drawn near the middle.
    const Vec3 p = solid_.middle + (i % 2 == 0 ? 1.0 : 0.3) * at.point(i);
    const double got = solid_.distance(p);
    ASSERT_EQ(got < 0, solid_.inside(p)) << p.transpose();
    inside += got < 0;
    if (std::abs(got) < 1e-5 || (got < 0 && !solid_.has_depth)) continue;
    Vec3 normal;
    for (int axis = 0; axis < 3; ++axis)
      normal[axis] = (solid_.distance(p + kStep_m * Vec3::Unit(axis)) -
                      solid_.distance(p - kStep_m * Vec3::Unit(axis))) /
                     (2 * kStep_m);
    const Vec3 foot = p - got * normal;
    bool is_at_surface = false;
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const Vec3 direction = directions.point(k).normalized();
      is_at_surface |= solid_.inside(foot + 1e-6 * direction) != (got < 0);
      EXPECT_EQ(solid_.inside(p + (1 - 1e-9) * std::abs(got) * direction), got < 0) << p.transpose();
    }
    EXPECT_TRUE(is_at_surface) << p.transpose();
  }
  EXPECT_GT(inside, 2);
  EXPECT_LT(inside, 350);
}

// Compares cast() with a march of small steps and bisection to the first position inside. The march may step
// over a sliver or a corner, and then hits within the next 10 mm or not at all.
TEST_P(SolidTest, CastMeetsTheSurfaceWhereAMarchDoes) {
  const PointCloud from = scenes::random_cloud(600, 0.25, 2), aim = scenes::random_cloud(600, 1, 3);
  int hits = 0, misses = 0, starts_inside = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 origin = solid_.middle + (i % 5 == 0 ? 0.1 : 1.0) * from.point(i);
    // Some directions point to the solid, others anywhere. Their lengths differ, because t is in units of
    // them.
    const Vec3 towards = solid_.middle + 0.05 * aim.point(i) - origin;
    const Vec3 direction = (i % 2 == 0 ? towards : aim.point(i)) * (1 + static_cast<double>(i % 7));
    const double length = direction.norm(), got = solid_.cast(origin, direction);
    if (solid_.inside(origin)) {
      EXPECT_EQ(got, 0) << i;
      ++starts_inside;
      continue;
    }
    double found = kInfinity, last = 0;
    for (int step = 1; step <= 2000 && found == kInfinity; ++step) {  // 1 m, beyond everything here
      const double t = step / 2000.0 / length;
      if (solid_.inside(origin + t * direction)) {
        found = t;
        for (int k = 0; k < 50; ++k)
          (solid_.inside(origin + 0.5 * (last + found) * direction) ? found : last) = 0.5 * (last + found);
      }
      last = std::min(t, found);
    }
    if (got == kInfinity) {
      EXPECT_EQ(found, kInfinity) << i;
      ++misses;
      continue;
    }
    EXPECT_GE(got, 0) << "not behind";
    EXPECT_LT(std::abs(solid_.distance(origin + got * direction)), 2e-9) << i;
    for (int k = 0; k < 100; ++k) EXPECT_FALSE(solid_.inside(origin + got * k / 100 * direction)) << i;
    if (found == kInfinity) continue;
    EXPECT_LE(got * length, found * length + 1e-9) << i;
    EXPECT_GE(got * length, found * length - 0.01) << i;
    ++hits;
  }
  EXPECT_GT(hits, 80);
  EXPECT_GT(misses, 80);
  EXPECT_GT(starts_inside, 2);
}

INSTANTIATE_TEST_SUITE_P(Solids, SolidTest,
                         testing::Values(prism("box", kBox), prism("ramp", kRamp), prism("odd", kOdd),
                                         wheel("wheel", {0.02, -0.03, 0.06}, 0.045),
                                         wheel("larger_wheel", {0, 0, 0.1}, 0.12)),
                         [](const auto& solid) { return solid.param.name; });

TEST(Extrusion, HeightIsTheUpperOutline) {
  for (const Profile& profile : {kBox, kRamp, kOdd}) {
    const Extrusion solid(profile, kLow, kHigh);
    for (double z = -0.1005; z < 0.3; z += 0.003) {
      double top = -kInfinity;
      for (std::size_t i = 0; i < profile.size(); ++i) {
        const auto &a = profile[i], &b = profile[(i + 1) % profile.size()];
        if ((z - a[0]) * (z - b[0]) < 0)
          top = std::max(top, a[1] + (z - a[0]) / (b[0] - a[0]) * (b[1] - a[1]));
      }
      // height() casts a ray from 1 km above, so its result has the rounding error of that distance.
      const double got = solid.height(0.01, z);
      EXPECT_TRUE(got == top || std::abs(got - top) < 1e-12) << z;
      EXPECT_EQ(solid.height(kLow - 1e-6, z), -kInfinity);
      EXPECT_EQ(solid.height(kHigh + 1e-6, z), -kInfinity);
    }
  }
}

struct Shape {
  const char* name;
  Vec3 semi_axes;
  Eigen::Matrix3d axes = meshes::rotated();
};
void PrintTo(const Shape& shape, std::ostream* out) {
  *out << shape.semi_axes.transpose();
}
const Vec3 kCentre(0.02, -0.05, 0.03);

// Round, nearly round, long, flat, and each axis the shortest once.
const Shape kShapes[] = {
    {"shortest_z", {0.04, 0.036, 0.032}},
    {"shortest_x", {0.02, 0.036, 0.032}},
    {"shortest_y", {0.04, 0.01, 0.032}},
    {"ball", {0.03, 0.03, 0.03}},
    {"longer_ball", {0.03, 0.03, 0.05}},
    {"flatter_ball", {0.05, 0.03, 0.05}},
    {"nearly_a_ball", {0.03, 0.03, 0.03001}},
    {"a_ball_but_for_rounding", {0.03, 0.03 * (1 + 1e-12), 0.03}},
    {"disk", {0.1, 0.1, 0.001}},
    {"needle", {1, 0.001, 0.001}},
    {"blade", {1, 0.03, 1e-4}},
};

class EllipsoidTest : public testing::TestWithParam<Shape> {
 protected:
  const Vec3& semi_axes() const { return GetParam().semi_axes; }
  Vec3 to_axes(const Vec3& p) const { return GetParam().axes.transpose() * (p - kCentre); }
  Vec3 from_axes(const Vec3& q) const { return kCentre + GetParam().axes * q; }
  double level(const Vec3& q) const { return q.cwiseQuotient(semi_axes()).squaredNorm(); }

  // Returns positions in random directions, in turn near the surface, deep inside and far away.
  std::vector<Vec3> places() const {
    std::vector<Vec3> places;
    const PointCloud at = scenes::random_cloud(4000, 1, 5);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Vec3 on = at.point(i).normalized().cwiseProduct(semi_axes());
      const double fractions[] = {1e-9, 0.1, 0.5, 0.9, 1 - 1e-9, 1 + 1e-9, 1.1, 2, 10, 1e4};
      places.push_back(from_axes(fractions[i % 10] * on));
    }
    return places;
  }

  const Ellipsoid solid_{kCentre, GetParam().semi_axes, GetParam().axes};
};

// A point is the closest if it is on the surface, the offset is along its normal, and no focal surface is
// passed.
TEST_P(EllipsoidTest, TheClosestPointObeysTheConditions) {
  const double shortest = semi_axes().minCoeff();
  for (const Vec3& p : places()) {
    const Vec3 x = to_axes(solid_.closest(p)), offset = to_axes(p) - x;
    ASSERT_NEAR(level(x), 1, 1e-11) << p.transpose();
    const Vec3 normal = x.cwiseQuotient(semi_axes()).cwiseQuotient(semi_axes()).normalized();
    const double along = offset.dot(normal);
    ASSERT_NEAR(solid_.signed_distance(p), along, 1e-9 * shortest + 1e-14 * offset.norm()) << p.transpose();
    // An error of the foot point changes the distance only in second order.
    ASSERT_LE(offset.cross(normal).norm(), 1e-6 * (shortest + offset.norm())) << p.transpose();
    ASSERT_GE(along, -shortest * (1 + 1e-12)) << "deeper than the ellipsoid is thick";
    ASSERT_EQ(solid_.signed_distance(p) < 0, level(to_axes(p)) < 1);
    for (int i = 0; i < 3; ++i) ASSERT_GE(x[i] * to_axes(p)[i], -1e-20) << "another octant";
  }
}

TEST_P(EllipsoidTest, DistanceOnTheAxesIsKnown) {
  const double shortest = semi_axes().minCoeff();
  EXPECT_NEAR(solid_.signed_distance(kCentre), -shortest, 1e-15);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      const double e = semi_axes()[axis];
      const auto at = [&](double q) {
        return solid_.signed_distance(from_axes(sign * q * Vec3::Unit(axis)));
      };
      for (const double beyond : {1e-12, 1e-3, 1.0, 1e3})
        EXPECT_NEAR(at(e + beyond), beyond, 1e-15 * (1 + beyond) * 4) << axis;
      // Inside, the axis' own end is the closest point up to the centre of the smallest radius of curvature
      // there.
      double smallest_radius = e;
      for (int i = 0; i < 3; ++i)
        if (i != axis) smallest_radius = std::min(smallest_radius, semi_axes()[i] * semi_axes()[i] / e);
      for (const double fraction : {1e-9, 0.3, 0.99})
        EXPECT_NEAR(at(e - fraction * smallest_radius), -fraction * smallest_radius, 1e-13)
            << axis << " " << fraction;
    }
}

// These positions are degenerate: some coordinates are zero or tiny, or the poles of the equation coincide.
TEST_P(EllipsoidTest, DegeneratePositionsHaveADistance) {
  const double values[] = {0, -0.0, 5e-324, -1e-200, 1e-30, 1e-18, -1e-12, 1e-6, 0.01, 0.03, 1, 1e6};
  const double shortest = semi_axes().minCoeff();
  for (const double x : values)
    for (const double y : values)
      for (const double z : values) {
        const Vec3 q(x, y, z);
        const Ellipsoid straight(Vec3::Zero(), semi_axes());
        const Vec3 foot = straight.closest(q);
        ASSERT_NEAR(level(foot), 1, 1e-11) << q.transpose();
        const double d = straight.signed_distance(q);
        ASSERT_GE(d, -shortest * (1 + 1e-12)) << q.transpose();
        // A small displacement changes the distance by no more than its own length.
        const double moved = straight.signed_distance(q + Vec3(1e-9, -1e-9, 1e-9));
        ASSERT_NEAR(moved, d, 1.8e-9 + 1e-9 * std::abs(d)) << q.transpose();
      }
}

TEST_P(EllipsoidTest, CastMeetsTheSurfaceFirstWhereTheEquationSays) {
  const std::vector<Vec3> from = places();
  const PointCloud displacement = scenes::random_cloud(static_cast<int>(from.size()), 1, 7);
  int hits = 0, misses = 0, starts_inside = 0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3 origin = from[i];
    if (i % 10 == 9) continue;  // no digits are left from 10^4 radii away
    const Vec3 towards = from_axes(0.7 * displacement.point(i).cwiseProduct(semi_axes())) - origin;
    const Vec3 direction = i % 2 == 0 ? towards : Vec3(3 * displacement.point(i));
    const double t = solid_.cast(origin, direction);
    if (solid_.level(origin) < 1 - 1e-12) {
      EXPECT_EQ(t, 0) << i;
      ++starts_inside;
    } else if (t < kInfinity) {
      EXPECT_GE(t, 0) << "not behind";
      EXPECT_NEAR(level(to_axes(origin + t * direction)), 1, 1e-10) << i;
      for (int k = 0; k < 50; ++k)
        EXPECT_GT(solid_.level(origin + t * k / 50 * direction), 1 - 1e-10) << "entered before";
      ++hits;
    } else {
      // The ray is nowhere inside, not even where the level is least.
      const Vec3 o = to_axes(origin).cwiseQuotient(semi_axes());
      const Vec3 d = (GetParam().axes.transpose() * direction).cwiseQuotient(semi_axes());
      const double min = std::max(0.0, -o.dot(d) / d.squaredNorm());
      EXPECT_GT((o + min * d).squaredNorm(), 1 - 1e-10) << i;
      ++misses;
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(misses, 500);
  EXPECT_GT(starts_inside, 500);
}

TEST_P(EllipsoidTest, HeightIsTheUpperOutline) {
  int over = 0, beside = 0;
  for (const Vec3& p : places()) {
    const double height = solid_.height(p.x(), p.z());
    if (height == -kInfinity) {
      EXPECT_GE(solid_.level(p), 1 - 1e-12);
      ++beside;
      continue;
    }
    const Vec3 top(p.x(), height, p.z());
    EXPECT_NEAR(solid_.level(top), 1, 1e-10);
    // The level rises with the height there, so this is the upper of the two crossings.
    const Vec3 up = GetParam().axes.transpose() * Vec3::UnitY();
    EXPECT_GE(to_axes(top).cwiseQuotient(semi_axes()).dot(up.cwiseQuotient(semi_axes())), 0);
    ++over;
  }
  EXPECT_GT(over, 500);
  EXPECT_GT(beside, 500);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EllipsoidTest, testing::ValuesIn(kShapes),
                         [](const auto& shape) { return shape.param.name; });

}  // namespace
}  // namespace remote_touch::solids_test
