// The shapes of moving-shape against brute force over dense samples of their surfaces.
#include "scenarios/simulated/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "analysis/trace/columns.h"
#include "runners/experiment/hand/trajectory.h"
#include "scenarios/simulated/grid_scenes.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::shape_test {
namespace {

using Kind = Shape::Kind;

constexpr double kPi = 3.14159265358979323846;
const Grid kGrid{41, 21, 0.002, 0, 0};  // 80 mm by 40 mm

Shape::Settings settings_of(Kind kind) {
  Shape::Settings s;
  s.kind = kind, s.slope_deg = 35, s.radius_m = 0.015, s.amplitude_m = 0.004, s.period_m = 0.02;
  return s;
}

// Returns the height by the formula of each shape.
double expected_height(const Shape::Settings& s, double x, double z) {
  const double flank = std::tan(s.slope_deg * kPi / 180) * std::abs(x);
  switch (s.kind) {
    case Kind::ridge:
      return -flank;
    case Kind::valley:
      return flank;
    case Kind::sphere:
      return std::sqrt(s.radius_m * s.radius_m - x * x - z * z) - s.radius_m;
    case Kind::corner: {
      double lowest = 1;
      for (const double deg : {90.0, 210.0, 330.0})
        lowest = std::min(lowest, -std::tan(s.slope_deg * kPi / 180) *
                                      (std::cos(deg * kPi / 180) * x + std::sin(deg * kPi / 180) * z));
      return lowest;
    }
    case Kind::ripple:
      return s.amplitude_m * std::sin(2 * kPi * x / s.period_m);
    default:
      return 0;
  }
}

struct Samples {
  std::vector<Vec3> points;
  double max_gap_m;  // no point of the surface is farther from a sample than half of this
};

// Samples are evenly spaced in x and z; those of the dome in its polar angles, because its rim is vertical.
Samples dense_samples(const Shape::Settings& s) {
  Samples samples{{}, 0};
  if (s.kind == Kind::sphere) {
    constexpr int kAround = 720, kDown = 180;
    for (int j = 0; j <= kDown; ++j)
      for (int i = 0; i < kAround; ++i) {
        const double down = 0.5 * kPi * j / kDown, around = 2 * kPi * i / kAround;
        samples.points.push_back(s.radius_m * Vec3(std::sin(down) * std::cos(around), std::cos(down) - 1,
                                                   std::sin(down) * std::sin(around)));
      }
    samples.max_gap_m = s.radius_m * std::sqrt(2.0) * 2 * kPi / kAround;
    return samples;
  }
  constexpr double kStep_m = 0.0001;
  const double steepest = std::tan(steepest_deg(s) * kPi / 180);
  for (int i = -400; i <= 400; ++i)
    for (int j = -200; j <= 200; ++j)
      samples.points.emplace_back(i * kStep_m, expected_height(s, i * kStep_m, j * kStep_m), j * kStep_m);
  samples.max_gap_m = kStep_m * std::sqrt(2 + steepest * steepest);
  return samples;
}

double nearest_sample_m(const Samples& samples, const Vec3& p) {
  double squared = std::numeric_limits<double>::infinity();
  for (const Vec3& q : samples.points) squared = std::min(squared, (p - q).squaredNorm());
  return std::sqrt(squared);
}

const Kind kKinds[] = {Kind::flat, Kind::ridge, Kind::valley, Kind::sphere, Kind::ripple, Kind::corner};

TEST(Shape, DistanceIsToTheNearestOfDenseSamples) {
  std::mt19937 random(1);
  const auto even = [&] { return random() / 2147483648.0 - 1; };
  for (const Kind kind : kKinds) {
    if (kind == Kind::corner) continue;  // has no border: see the next test
    SCOPED_TRACE(static_cast<int>(kind));
    const Shape::Settings s = settings_of(kind);
    const Shape shape(s, kGrid);
    const Samples samples = dense_samples(s);
    int beyond = 0, below = 0;
    for (int k = 0; k < 150; ++k) {
      const Vec3 p(0.06 * even(), 0.035 * even(), 0.03 * even());
      const bool is_over = kind == Kind::sphere ? std::hypot(p.x(), p.z()) <= s.radius_m
                                                : std::abs(p.x()) <= 0.04 && std::abs(p.z()) <= 0.02;
      const double brute = nearest_sample_m(samples, p), got = std::abs(shape.signed_distance(p));
      if (std::isnan(got)) {  // below its plane and beside it
        EXPECT_FALSE(is_over) << p.transpose();
        const double known_above_m = kind == Kind::flat ? 0 : kind == Kind::sphere ? -s.radius_m : 0.035;
        EXPECT_LT(p.y(), known_above_m) << p.transpose();
        continue;
      }
      beyond += std::abs(p.x()) > 0.04 || std::abs(p.z()) > 0.02;
      if (is_over) {
        EXPECT_EQ(shape.signed_distance(p) > 0, p.y() > expected_height(s, p.x(), p.z())) << p.transpose();
      }
      // The nearest point of the surface lies within half a gap of a sample.
      EXPECT_LE(got, brute + 1e-12) << p.transpose();
      EXPECT_GE(std::sqrt(got * got + 0.25 * samples.max_gap_m * samples.max_gap_m) +
                    0.25 * samples.max_gap_m * samples.max_gap_m / 0.005,  // extra gap of a curved surface
                brute)
          << p.transpose();
      below += shape.signed_distance(p) < 0;
    }
    EXPECT_GT(beyond, 20);
    EXPECT_GT(below, kind == Kind::sphere ? 2 : 10) << "a small part of the places is below the dome";
  }
}

TEST(Shape, DistanceToACornerIsThatToTheNearestSampleOfItsFaces) {
  const Shape::Settings s = settings_of(Kind::corner);
  const Shape corner(s, kGrid);
  Samples samples{{}, 0};
  constexpr double kStep_m = 2e-4;
  for (int j = -400; j <= 400; ++j)
    for (int i = -400; i <= 400; ++i)
      samples.points.emplace_back(i * kStep_m, expected_height(s, i * kStep_m, j * kStep_m), j * kStep_m);
  const double half_gap_m = kStep_m / std::sqrt(2.0) / std::cos(s.slope_deg * kPi / 180);
  std::mt19937 random(4);
  const auto even = [&] { return random() / 2147483648.0 - 1; };
  int inside = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 p(0.02 * even(), 0.03 * even(), 0.02 * even());
    const double brute = nearest_sample_m(samples, p), got = corner.signed_distance(p);
    EXPECT_LE(std::abs(got), brute + 1e-12) << p.transpose();
    EXPECT_GE(std::abs(got) + half_gap_m, brute) << p.transpose();
    EXPECT_EQ(got > 0, p.y() > expected_height(s, p.x(), p.z())) << p.transpose();
    inside += got < 0;
  }
  EXPECT_GT(inside, 40);
  EXPECT_DOUBLE_EQ(corner.signed_distance({0, 0.01, 0}), 0.01) << "from the top";
}

// A normal must be perpendicular to the differences of the heights along x and along z.
TEST(Shape, NormalsAreUprightOnTheSurface) {
  for (const Kind kind : kKinds) {
    const Shape::Settings s = settings_of(kind);
    const Shape shape(s, kGrid);
    for (int k = 0; k < 100; ++k) {
      const double x = 0.0093 * std::sin(1.7 * k) + 1e-4, z = 0.0091 * std::cos(2.3 * k) + 1e-4, step = 1e-7;
      if (kind == Kind::sphere && std::hypot(x, z) > 0.9 * s.radius_m) continue;
      const Vec3 n = shape.normal(x, z);
      const Vec3 across(2 * step, expected_height(s, x + step, z) - expected_height(s, x - step, z), 0),
          along(0, expected_height(s, x, z + step) - expected_height(s, x, z - step), 2 * step);
      EXPECT_NEAR(n.norm(), 1, 1e-12);
      EXPECT_GT(n.y(), 0);
      EXPECT_NEAR(n.dot(across.normalized()), 0, 1e-6) << static_cast<int>(kind) << " " << x << " " << z;
      EXPECT_NEAR(n.dot(along.normalized()), 0, 1e-6) << static_cast<int>(kind) << " " << x << " " << z;
    }
  }
}

// A sphere or corner that is larger than the grid has no points beyond it, and no back there.
TEST(Shape, HasNoBackWhereTheGridDoesNotReach) {
  for (const Kind kind : {Kind::sphere, Kind::corner}) {
    Shape::Settings s = settings_of(kind);
    s.radius_m = 0.5;
    const Shape shape(s, kGrid);
    for (const double x : {-0.1, -0.045, -0.03, 0.0, 0.03, 0.045, 0.1}) {
      const double y = shape.height(x, 0.001), below = shape.signed_distance({x, y - 0.002, 0.001});
      EXPECT_GT(shape.signed_distance({x, y + 0.002, 0.001}), 0.001) << x;
      if (std::abs(x) > 0.044)
        EXPECT_TRUE(std::isnan(below)) << static_cast<int>(kind) << " " << x;
      else
        EXPECT_LT(below, -0.001) << static_cast<int>(kind) << " " << x;
    }
  }
}

// The distance is NaN below the plane that ends at the border. For a ridge that is the plane of its flank, at
// 35 degrees.
TEST(Shape, HasNoBackBesideItsBorder) {
  const Shape flat(settings_of(Kind::flat), kGrid), ridge(settings_of(Kind::ridge), kGrid),
      sphere(settings_of(Kind::sphere), kGrid);
  EXPECT_NEAR(flat.signed_distance({0.043, 0.004, 0}), 0.005, 1e-15);
  EXPECT_TRUE(std::isnan(flat.signed_distance({0.043, -0.004, 0})));
  EXPECT_EQ(flat.signed_distance({0.04, -0.1, 0.02}), -0.1) << "the border belongs to it";
  EXPECT_NEAR(flat.signed_distance({0.042, 0.003, -0.026}), 0.007, 1e-15);
  const double drop = std::tan(35 * kPi / 180);
  EXPECT_GT(ridge.signed_distance({0.05, -drop * 0.05 + 0.001, 0}), 0.01);
  EXPECT_TRUE(std::isnan(ridge.signed_distance({0.05, -drop * 0.05 - 0.001, 0})));
  // Deep below the ridge its lower borders are nearest, and the ridge still covers p.
  EXPECT_NEAR(ridge.signed_distance({0, -0.5, 0}), -std::hypot(0.04, 0.5 - drop * 0.04), 1e-15);
  EXPECT_TRUE(std::isnan(ridge.signed_distance({0, -0.5, 0.021})));
  EXPECT_GT(sphere.signed_distance({0.02, -0.0149, 0}), 0.005);
  EXPECT_TRUE(std::isnan(sphere.signed_distance({0.02, -0.0151, 0})));
  EXPECT_NEAR(sphere.signed_distance({0.01, -0.0151, 0}), -std::hypot(0.005, 0.0001), 1e-15);
}

TEST(Shape, HasABackBehindAFlankOrAWaveAlsoBesideTheBorder) {
  // The flanks of a valley lean outwards: 1 mm behind one that ends at x = 0.04 is beyond 0.04.
  const Shape valley(settings_of(Kind::valley), kGrid), corner(settings_of(Kind::corner), kGrid);
  const Vec3 near_the_end = valley.point(0.0399, 0);
  EXPECT_NEAR(valley.signed_distance(near_the_end - 0.001 * valley.normal(0.0399, 0)), -0.001, 1e-15);
  const Shape wave(settings_of(Kind::ripple), kGrid);
  EXPECT_LT(wave.signed_distance({0.041, -0.02, 0}), 0) << "behind the last trough";
  EXPECT_TRUE(std::isnan(wave.signed_distance({0.06, -0.005, 0})));
  EXPECT_TRUE(std::isnan(wave.signed_distance({0.01, -0.02, 0.021})));
  EXPECT_LT(wave.signed_distance({0.01, -0.02, 0.019}), 0);
  EXPECT_LT(corner.signed_distance({0.01, -0.1, 0}), 0);
  EXPECT_TRUE(std::isnan(corner.signed_distance({1, -10, 0})));
}

TEST(Shape, PointsLieOnTheSurface) {
  for (const Kind kind : kKinds) {
    const Shape::Settings s = settings_of(kind);
    const Shape shape(s, kGrid);
    int missing = 0;
    for (int row = 0; row < kGrid.rows; ++row)
      for (int column = 0; column < kGrid.columns; ++column) {
        const double x = kGrid.x(column), z = kGrid.z(row);
        const Vec3 p = shape.point(x, z);
        if (kind == Kind::sphere && std::hypot(x, z) > s.radius_m) {
          EXPECT_TRUE(std::isnan(p.x()) && std::isnan(p.y()) && std::isnan(p.z()));
          EXPECT_EQ(shape.height(x, z), -s.radius_m);  // the plane that a hand presses beside it
          ++missing;
          continue;
        }
        EXPECT_EQ(p, Vec3(x, shape.height(x, z), z));
        EXPECT_NEAR(p.y(), expected_height(s, x, z), 1e-16);
        EXPECT_NEAR(shape.signed_distance(p), 0, 1e-12);
      }
    EXPECT_EQ(missing > 0, kind == Kind::sphere);
    EXPECT_EQ(shape.height(0, 0), 0);
  }
}

// The search along x finds the nearest of several crests or troughs. The distance to these is known in closed
// form.
TEST(Shape, ARippleHasItsDistanceFromAfarAndOverItsCrests) {
  Shape::Settings s = settings_of(Kind::ripple);
  const Shape shape(s, kGrid);
  const double crest = 0.25 * s.period_m;
  EXPECT_NEAR(shape.signed_distance({crest, 0.1, 0}), 0.1 - s.amplitude_m, 1e-12);
  EXPECT_NEAR(shape.signed_distance({-crest, -0.1, 0.01}), -(0.1 - s.amplitude_m), 1e-12);
  EXPECT_NEAR(shape.signed_distance({crest, s.amplitude_m + 0.0003, 0.024}), std::hypot(0.0003, 0.004),
              1e-12);
  // High above the middle between two crests both are equally near. The expected distance is that of a fine
  // scan.
  const Vec3 p(-crest, 0.05, 0);
  double nearest = 1;
  for (int i = 0; i <= 4000000; ++i) {
    const double x = -0.03 + 0.04 * i / 4e6;
    nearest = std::min(nearest, std::hypot(x - p.x(), expected_height(s, x, 0) - p.y()));
  }
  EXPECT_NEAR(shape.signed_distance(p), nearest, 1e-12);
}

TEST(Shape, AGridOfOnePointOrOneFlankIsAPatch) {
  const Shape dot(settings_of(Kind::ridge), Grid{1, 1, 0.002, 0, 0});
  EXPECT_NEAR(dot.signed_distance({0.003, 0.004, 0}), 0.005, 1e-15);
  const Shape one_flank(settings_of(Kind::valley), Grid{5, 5, 0.002, 1, 0});  // x from -2 to 6 mm
  EXPECT_NEAR(one_flank.signed_distance(one_flank.point(0.005, 0)), 0, 1e-15);
  Grid beside{2, 2, 0.002, 1, 0};  // x from 1 to 3 mm
  const Shape right(settings_of(Kind::valley), beside);
  EXPECT_NEAR(right.signed_distance(right.point(0.001, 0) - Vec3(0.5, 0, 0)), 0.5, 0.05);
}

}  // namespace
}  // namespace remote_touch::shape_test
