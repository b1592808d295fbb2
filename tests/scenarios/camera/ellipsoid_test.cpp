#include "scenarios/camera/ellipsoid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <ostream>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::ellipsoid_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A rotation about a general axis. Its columns are orthonormal to rounding.
Eigen::Matrix3d turned() {
  Eigen::Matrix3d about_x, about_y;
  about_x << 1, 0, 0, 0, 0.8, -0.6, 0, 0.6, 0.8;
  about_y << 0.28, 0, 0.96, 0, 1, 0, -0.96, 0, 0.28;
  return about_x * about_y;
}

struct Shape {
  const char* name;
  Vec3 semi_axes;
  Eigen::Matrix3d axes = turned();
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

TEST_P(EllipsoidTest, NoSampleOfTheSurfaceIsCloser) {
  // Latitudes and longitudes of the unit ball, from rational points of the circle.
  std::vector<Vec3> samples;
  constexpr int kParts = 120;
  const auto circle = [](double fraction) -> Eigen::Vector2d {  // -1 to 1: half the circle
    return Eigen::Vector2d(1 - fraction * fraction, 2 * fraction) / (1 + fraction * fraction);
  };
  for (int i = -kParts; i <= kParts; ++i)
    for (int j = -kParts; j <= kParts; ++j)
      for (const double side : {1.0, -1.0}) {
        const Eigen::Vector2d around = side * circle(1.0 * i / kParts), up = circle(1.0 * j / kParts);
        samples.push_back(Vec3(up.x() * around.x(), up.x() * around.y(), up.y()).cwiseProduct(semi_axes()));
      }
  // Neighbours differ by 1 / 60 of a radius at most, in two directions.
  const double reach = semi_axes().maxCoeff() / 60;
  const std::vector<Vec3> all = places();
  for (std::size_t k = 0; k < all.size(); k += 97) {
    const Vec3 q = to_axes(all[k]);
    double squared = kInfinity;
    for (const Vec3& s : samples) squared = std::min(squared, (s - q).squaredNorm());
    const double got = std::abs(solid_.signed_distance(all[k]));
    ASSERT_LE(got, std::sqrt(squared) * (1 + 1e-12) + 1e-12) << q.transpose();
    ASSERT_GE(got + reach, std::sqrt(squared)) << q.transpose();
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

TEST(Ellipsoid, ABallHasTheValuesComputedByHand) {
  const Ellipsoid ball({0, 1, 0}, {0.5, 0.5, 0.5});
  EXPECT_NEAR(ball.signed_distance({3, 5, 0}), 4.5, 1e-15);
  EXPECT_NEAR(ball.signed_distance({0.1, 1, 0}), -0.4, 1e-16);
  EXPECT_NEAR(ball.cast({0, 5, 0.3}, {0, -2, 0}), 1.8, 1e-15);  // t is in units of the direction
  EXPECT_EQ(ball.cast({0, 5, 0.3}, {0, 2, 0}), kInfinity);      // behind
  EXPECT_EQ(ball.cast({0, 5, 0.6}, {0, -2, 0}), kInfinity);     // beside
  EXPECT_NEAR(ball.height(0.3, 0), 1.4, 1e-15);
  EXPECT_EQ(ball.height(0.51, 0), -kInfinity);
}

}  // namespace
}  // namespace remote_touch::ellipsoid_test
