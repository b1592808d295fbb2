#include "scenarios/simulated/camera_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <set>
#include <vector>

#include "tests/support/scenes.h"

namespace remote_touch::beating_heart_test {
namespace {

constexpr double kBeat_s = 0.8;  // period of 75 beats a minute

BeatingHeart made(const BeatingHeart::Settings& settings = {}) {
  return BeatingHeart(settings, NoiseKey{1}, scenes::kernels());
}
BeatingHeart ideal() {
  BeatingHeart::Settings s;
  s.camera.noise_per_m = 0, s.camera.quantisation_per_m = 0;
  return made(s);
}
double top(const BeatingHeart& heart, double time_s) {
  return heart.surface_height(0, 0, time_s);
}

// Positions on and around the organ.
std::vector<Vec3> places() {
  const PointCloud at = scenes::random_cloud(300, 1, 3);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < at.size(); ++i)
    places.emplace_back(0.08 * at.x[i], 0.03 + 0.05 * at.y[i], 0.06 * at.z[i]);
  return places;
}

TEST(BeatingHeart, TheTopSinksByTheAmplitudeInEveryBeat) {
  for (const double amplitude : {0.0, 0.0065, 0.015}) {
    BeatingHeart::Settings s;
    s.amplitude_m = amplitude;
    const BeatingHeart heart = made(s);
    double low = 1, high = 0;
    for (double t = 0; t < kBeat_s; t += 0.001)
      low = std::min(low, top(heart, t)), high = std::max(high, top(heart, t));
    EXPECT_NEAR(high, 0.06, 1e-15);
    EXPECT_NEAR(low, 0.06 - amplitude, 1e-15);
  }
}

TEST(BeatingHeart, EveryBeatIsTheSame) {
  for (const double rate : {75.0, 40.0}) {
    BeatingHeart::Settings s;
    s.rate_per_min = rate;
    const BeatingHeart heart = made(s);
    bool moves = false;
    for (const Vec3& p : places())
      for (const double t : {0.0, 0.11, 0.37, 0.6}) {
        const double now = heart.signed_distance(p, t);
        EXPECT_NEAR(heart.signed_distance(p, t + 60 / rate), now, 1e-15);
        EXPECT_NEAR(heart.signed_distance(p, t + 1000 * 60 / rate), now, 1e-13);
        moves |= std::abs(heart.signed_distance(p, t + 30 / rate) - now) > 0.001;
      }
    EXPECT_TRUE(moves) << "a period of half a beat";
  }
}

// The speed is computed by differences over h. Its largest values are those of a fifth-order step. It changes
// no faster than by the largest acceleration of such a step, 10 / sqrt(3) amplitude / duration^2.
TEST(BeatingHeart, TheTopMovesSmoothly) {
  const BeatingHeart heart = made();
  const double h = 1e-4, contraction_s = 0.3 * kBeat_s, relaxation_s = 0.4 * kBeat_s;
  const auto speed = [&](double t) { return (top(heart, t + h) - top(heart, t - h)) / (2 * h); };
  double max_speed_down = 0, max_speed_up = 0;
  for (double t = -0.1; t < 2 * kBeat_s; t += h) {
    max_speed_down = std::max(max_speed_down, -speed(t)), max_speed_up = std::max(max_speed_up, speed(t));
    const double acceleration = 10 / std::sqrt(3.0) * 0.0065 / (contraction_s * contraction_s);
    ASSERT_LE(std::abs(speed(t + h) - speed(t)), 1.001 * h * acceleration) << t;
  }
  EXPECT_NEAR(max_speed_down, 15.0 / 8 * 0.0065 / contraction_s, 1e-5);
  EXPECT_NEAR(max_speed_up, 15.0 / 8 * 0.0065 / relaxation_s, 1e-5);
}

TEST(BeatingHeart, TheAtriumLeads) {
  const BeatingHeart heart = made();
  const auto lowest_at = [&](double x, double z) {
    double at = 0;
    for (double t = 0; t < kBeat_s; t += 0.001)
      if (heart.surface_height(x, z, t) < heart.surface_height(x, z, at) - 1e-12) at = t;
    return at;
  };
  EXPECT_NEAR(lowest_at(0, 0), 0.3 * kBeat_s, 0.01);
  EXPECT_NEAR(lowest_at(-0.046, -0.004), 0.12 * kBeat_s, 0.01);
}

TEST(BeatingHeart, TruthIsContinuousInTimeAndSpace) {
  const BeatingHeart heart = made();
  const double h = 1e-5;
  // A semi-axis of 40 mm shrinks by 6.5 / 32 of its length in a contraction. Its largest speed is 15 / 8 of
  // the mean.
  const double max_speed = 15.0 / 8 * 0.040 * 0.0065 / 0.032 / (0.3 * kBeat_s);
  for (const Vec3& p : places())
    for (double t = 0; t < kBeat_s; t += 0.0307) {
      const double d = heart.signed_distance(p, t);
      EXPECT_LE(std::abs(heart.signed_distance(p, t + h) - d), 1.001 * max_speed * h);
      EXPECT_LE(std::abs(heart.signed_distance(p + Vec3(h, -h, h), t) - d), 1.001 * std::sqrt(3.0) * h);
      if (d < 0) {
        EXPECT_LT(p.y(), heart.surface_height(p.x(), p.z(), t)) << "inside is below the top";
      }
    }
}

TEST(BeatingHeart, TheSurfaceIsWhereTheDistanceIsZero) {
  const BeatingHeart heart = made();
  for (const Vec3& p : places())
    for (const double t : {0.0, 0.1, 0.24, 0.5}) {
      const Vec3 on(p.x(), heart.surface_height(p.x(), p.z(), t), p.z());
      EXPECT_NEAR(heart.signed_distance(on, t), 0, 1e-13);
    }
  EXPECT_NEAR(heart.signed_distance({0, 0.07, 0}, 0), 0.01, 1e-15);
  EXPECT_NEAR(heart.signed_distance({0.3, 0.07, 0}, 0), 0.07, 1e-15) << "over the table";
  EXPECT_NEAR(heart.signed_distance({0.3, -0.02, 0}, 0), -0.02, 1e-15) << "in the table";
}

// A proxy that is pressed rests where the surface curves away from it on all sides.
TEST(BeatingHeart, IsConvexAroundItsTop) {
  const BeatingHeart heart = made();
  const double h = 0.001;
  for (const double t : {0.0, 0.12, 0.24, 0.4, 0.6})
    for (double x = -0.02; x <= 0.02; x += 0.002)
      for (double z = -0.02; z <= 0.02; z += 0.002) {
        if (x * x + z * z > 0.02 * 0.02) continue;
        const auto y = [&](double i, double k) { return heart.surface_height(x + i * h, z + k * h, t); };
        EXPECT_LT(y(1, 0) + y(-1, 0), 2 * y(0, 0)) << x << " " << z << " " << t;
        EXPECT_LT(y(0, 1) + y(0, -1), 2 * y(0, 0)) << x << " " << z << " " << t;
      }
}

TEST(BeatingHeart, IdealPointsLieOnTheSurfaceOfTheirTime) {
  const BeatingHeart heart = ideal();
  for (const int frame : {0, 2, 5, 7, 1000}) {
    const PointCloud cloud = heart.cloud(frame);
    const double time = heart.captured_s(frame);
    int on_organ = 0, holes = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const bool hole = std::isnan(cloud.x[i]), organ = cloud.colour[i] != 0x3A6E78;
      on_organ += organ, holes += hole;
      if (hole || (!organ && i % 7 != 0)) continue;  // a sample is enough for the table
      const Vec3 p = cloud.point(i);
      ASSERT_LT(std::abs(heart.signed_distance(p, time)), 1e-9) << p.transpose();
      ASSERT_EQ(organ, p.y() > 1e-9) << "colour and place agree";
    }
    EXPECT_GT(on_organ, 4000);
    EXPECT_LT(holes, 4000);
  }
}

TEST(BeatingHeart, TheLobesAreRedAndTheTableIsNot) {
  std::set<std::uint32_t> reds;
  for (const std::uint32_t colour : made().cloud(4).colour) {
    const int r = colour >> 16, g = colour >> 8 & 255, b = colour & 255;
    if (r <= b) continue;
    reds.insert(colour);
    ASSERT_GE(g, b);  // hue = 60 (g - b) / (r - b) degrees
    EXPECT_LE(60 * (g - b), 15 * (r - b));
    EXPECT_GT(r, 2 * b) << "saturated";
  }
  EXPECT_EQ(reds.size(), 3u);
}

TEST(BeatingHeart, RestsAtZeroAmplitude) {
  BeatingHeart::Settings s;
  EXPECT_EQ(made().frame_count(), std::numeric_limits<int>::max());
  s.amplitude_m = 0;
  EXPECT_GT(made(s).frame_count(), 1) << "its noise does not";
  s.camera.noise_per_m = 0;
  const BeatingHeart heart = made(s);
  EXPECT_EQ(heart.frame_count(), 1);
  for (const Vec3& p : places())
    EXPECT_EQ(heart.signed_distance(p, 0.3), heart.signed_distance(p, 0)) << p.transpose();
  EXPECT_TRUE(scenes::same_clouds(heart.cloud(0), heart.cloud(9)));
}

}  // namespace
}  // namespace remote_touch::beating_heart_test

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
