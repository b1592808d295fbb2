// The shapes of moving-shape against brute force over dense samples of their surfaces, and their motions
// against formulas.
#include "scenarios/simulated/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "scenarios/simulated/grid_scenes.h"
#include "tests/support/scenes.h"

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

TEST(Shape, PointsHaveTheHeightOfItsFormula) {
  for (const Kind kind : kKinds) {
    const Shape::Settings s = settings_of(kind);
    const Shape shape(s, kGrid);
    int missing = 0;
    for (int i = 0; i < kGrid.rows * kGrid.columns; ++i) {
      const double x = kGrid.x(i % kGrid.columns), z = kGrid.z(i / kGrid.columns);
      const Vec3 p = shape.point(x, z);
      if (kind == Kind::sphere && std::hypot(x, z) > s.radius_m) {
        EXPECT_TRUE(p.array().isNaN().all());
        EXPECT_EQ(shape.height(x, z), -s.radius_m) << "the plane that a hand presses beside it";
        ++missing;
        continue;
      }
      EXPECT_EQ(p, Vec3(x, shape.height(x, z), z));
      EXPECT_NEAR(p.y(), expected_height(s, x, z), 1e-16);
    }
    EXPECT_EQ(missing > 0, kind == Kind::sphere);
  }
}

// The search along x finds the nearest of several crests or troughs.
TEST(Shape, ARippleHasItsDistanceFromAfarAndOverItsCrests) {
  Shape::Settings s = settings_of(Kind::ripple);
  const Shape shape(s, kGrid);
  const double crest = 0.25 * s.period_m;
  EXPECT_NEAR(shape.signed_distance({crest, 0.1, 0}), 0.1 - s.amplitude_m, 1e-12);
  EXPECT_NEAR(shape.signed_distance({-crest, -0.1, 0.01}), -(0.1 - s.amplitude_m), 1e-12);
  EXPECT_NEAR(shape.signed_distance({crest, s.amplitude_m + 0.0003, 0.024}), std::hypot(0.0003, 0.004),
              1e-12);
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

// Shapes that move.
namespace remote_touch::moving_shape_test {
namespace {

using Kind = Shape::Kind;

const NoiseKey kKey{1, 2, 3};
constexpr double kPi = 3.14159265358979323846;
const Kind kKinds[] = {Kind::flat, Kind::ridge, Kind::valley, Kind::sphere, Kind::ripple, Kind::corner};

MovingShape made(const MovingShape::Settings& settings, const NoiseKey& key = kKey) {
  return MovingShape(settings, key, scenes::kernels());
}

Vec3 turned(const Vec3& p, double angle_deg) {
  return Eigen::AngleAxisd(angle_deg * kPi / 180, Vec3::UnitZ()) * p;
}

// Settings of a shape of this kind, with all motions at once.
MovingShape::Settings busy(Kind kind) {
  MovingShape::Settings s;
  s.grid = {41, 31, 0.0015, 0.25, -0.5};
  s.shape.kind = kind, s.shape.slope_deg = 25, s.shape.radius_m = 0.025;
  s.motion = {8, {0, 0.02, 0.1, 4 / 30.0, -1, 4 / 30.0}, 0.05, 0.004, 3, 6, 1.5, 0.1};
  s.truth = SurfaceTime::moving;
  return s;
}

TEST(MovingShape, AFlatLiftIsAMovingLiftBitForBit) {
  MovingLift::Settings lift;
  MovingShape::Settings shape;
  shape.grid = lift.grid, shape.noise_sigma_m = lift.noise_sigma_m;
  shape.motion.lift = lift.lift;
  for (const bool moving : {false, true}) {
    if (moving) lift.truth = SurfaceTime::moving, shape.truth = SurfaceTime::moving;
    const MovingLift one(lift, kKey, scenes::kernels());
    const MovingShape other = made(shape);
    ASSERT_EQ(other.frame_count(), one.frame_count());
    for (const int frame : {0, 1, 15, 17, 25})
      EXPECT_TRUE(scenes::same_points(one.cloud(frame), other.cloud(frame))) << frame;
    for (int tick = 0; tick < 1000; tick += 7) {
      const double time_s = 0.001 * tick;
      const Vec3 p(0.01, 1e-4 * tick - 0.05, -0.02);
      EXPECT_EQ(one.signed_distance(p, time_s), other.signed_distance(p, time_s)) << time_s;
      EXPECT_EQ(one.surface_height(0, 0, time_s), other.surface_height(0, 0, time_s)) << time_s;
    }
  }
}

// A step along a point's normal changes the distance to the true surface by the length of the step, in any
// pose.
TEST(MovingShape, NormalsAreThoseOfTheTrueSurface) {
  for (const Kind kind : kKinds) {
    MovingShape::Settings s = busy(kind);
    EXPECT_FALSE(made(s).cloud(3).has_normals());
    s.normals = true;
    const MovingShape shape = made(s);
    EXPECT_TRUE(scenes::same_points(shape.cloud(5), made(busy(kind)).cloud(5)));
    for (const int frame : {0, 9}) {
      const PointCloud cloud = shape.cloud(frame);
      int tried = 0;
      for (std::size_t i = 0; i < cloud.size(); i += 13) {
        if (!cloud.point(i).allFinite()) continue;
        ASSERT_NEAR(cloud.normal(i).norm(), 1, 1e-12);
        constexpr double kStep_m = 1e-5;  // beside a crease another side may be nearer
        const Vec3 above = cloud.point(i) + kStep_m * cloud.normal(i);
        EXPECT_NEAR(shape.signed_distance(above, frame / 30.0), kStep_m, 1e-7) << static_cast<int>(kind);
        ++tried;
      }
      EXPECT_GT(tried, 30);
    }
  }
}

TEST(MovingShape, SlideShakeAndRockFollowTheirFormulas) {
  MovingShape::Settings s;
  s.motion.slide_velocity_m_per_s = -0.2, s.motion.shake_amplitude_m = 0.003, s.motion.shake_hz = 4;
  s.motion.rock_deg = 7, s.motion.rock_hz = 0.8, s.motion.tilt_deg = -3, s.motion.motion_from_s = 0.25;
  s.truth = SurfaceTime::moving;
  const MovingShape shape = made(s);
  EXPECT_EQ(shape.frame_count(), std::numeric_limits<int>::max());
  for (int frame = 0; frame < 40; frame += 3) {
    const double t = std::max(0.0, frame / 30.0 - 0.25);
    const Vec3 origin(-0.2 * t, 0.003 * std::sin(2 * kPi * 4 * t), 0);
    const double rotation_deg = -3 + 7 * std::sin(2 * kPi * 0.8 * t);
    const PointCloud cloud = shape.cloud(frame);
    for (std::size_t i = 0; i < cloud.size(); i += 97) {
      const int column = static_cast<int>(i) % 80, row = static_cast<int>(i) / 80;
      const Vec3 expected = origin + turned({s.grid.x(column), 0, s.grid.z(row)}, rotation_deg);
      EXPECT_LT((cloud.point(i) - expected).norm(), 1e-15) << frame;
    }
    // The height is that of a tilted plane, also over positions beyond its border.
    for (const double x : {0.0, 0.03, -1.0})
      EXPECT_NEAR(shape.surface_height(x, 0.01, frame / 30.0),
                  origin.y() + std::tan(rotation_deg * kPi / 180) * (x - origin.x()), 1e-14);
  }
  EXPECT_EQ(shape.surface_height(0, 0, 0.1), shape.surface_height(0, 0, 0.2)) << "before it begins";
}

TEST(MovingShape, NoiseFreePointsLieOnTheTrueSurfaceAtEveryFrame) {
  for (const Kind kind : kKinds) {
    const MovingShape shape = made(busy(kind));
    for (const int frame : {0, 2, 5, 9, 23}) {
      const PointCloud cloud = shape.cloud(frame);
      const double t = shape.captured_s(frame);
      int measured = 0;
      for (std::size_t i = 0; i < cloud.size(); i += 5) {
        if (!cloud.is_measured(i)) continue;
        ++measured;
        const Vec3 p = cloud.point(i);
        ASSERT_NEAR(shape.signed_distance(p, t), 0, 2e-12) << static_cast<int>(kind) << " frame " << frame;
        // A ball that is turned overhangs at its rim.
        const bool lies_on_top = shape.signed_distance(p + Vec3(0, 0.001, 0), t) > 0.0005;
        if (lies_on_top) {
          ASSERT_NEAR(shape.surface_height(p.x(), p.z(), t), p.y(), 1e-11);
        }
      }
      EXPECT_GT(measured, 100);
    }
  }
}

// The moving truth between frames is the surface where the motion has carried it. The truth of the newest
// frame does not change.
TEST(MovingShape, TheTruthMovesBetweenFramesOrIsThatOfTheNewest) {
  MovingShape::Settings s = busy(Kind::ridge);
  const MovingShape moving = made(s);
  s.truth = SurfaceTime::newest_frame;
  const MovingShape newest = made(s);
  const Vec3 p(0.004, 0.03, 0.002);
  for (int frame = 3; frame < 12; ++frame) {
    const double t = moving.captured_s(frame), next = moving.captured_s(frame + 1);
    EXPECT_NEAR(moving.signed_distance(p, t), newest.signed_distance(p, t), 1e-15);
    EXPECT_EQ(newest.signed_distance(p, t + 0.03), newest.signed_distance(p, t));
    EXPECT_NE(moving.signed_distance(p, t + 0.03), moving.signed_distance(p, t));
    EXPECT_NEAR(moving.signed_distance(p, next - 1e-9), moving.signed_distance(p, next), 1e-8);
  }
}

TEST(MovingShape, NoiseBelongsToKeyAndFrame) {
  MovingShape::Settings s = busy(Kind::ridge);
  const MovingShape clean = made(s);
  s.noise_sigma_m = 0.002;
  const PointCloud noisy = made(s).cloud(4), without = clean.cloud(4);
  EXPECT_FALSE(scenes::same_points(noisy, made(s, {9, 2, 3}).cloud(4)));
  double squares = 0;
  for (std::size_t i = 0; i < noisy.size(); ++i) squares += (noisy.point(i) - without.point(i)).squaredNorm();
  const double count = 3 * static_cast<double>(noisy.size());
  EXPECT_NEAR(std::sqrt(squares / count), 0.002, 5 * 0.002 / std::sqrt(2 * count));
  const Vec3 first = made(s).cloud(0).point(0) - clean.cloud(0).point(0);
  EXPECT_GT((noisy.point(0) - without.point(0) - first).norm(), 1e-6);
  s.redraw_noise = false;
  EXPECT_LT((made(s).cloud(4).point(0) - without.point(0) - first).norm(), 1e-15);
}

// Only a flat grid that stays level makes its noise on demand; it has the points of its cloud.
TEST(MovingShape, ALevelGridIsSearchedOnDemand) {
  for (const Kind kind : {Kind::flat, Kind::ridge})
    for (const bool level : {true, false}) {
      MovingShape::Settings s = busy(kind);
      if (level) s.motion = {}, s.motion.shake_amplitude_m = 0.004;
      s.noise_sigma_m = 0.001;
      const MovingShape shape = made(s);
      const auto points = shape.points(5);
      const bool is_lazy = dynamic_cast<const NoisyGridSearch*>(points.get()) != nullptr;
      EXPECT_EQ(is_lazy, level && kind == Kind::flat);
      const PointCloud cloud = shape.cloud(5);
      for (std::size_t i = 0; i < cloud.size(); i += 50) {
        const Ball ball{cloud.point(i), 0.008};
        EXPECT_EQ(scenes::gathered(*points, ball).size(),
                  scenes::gathered(BruteForceSearch(cloud), ball).size());
      }
      EXPECT_EQ(scenes::gathered(*points, {Vec3(0, 0, std::nan("")), 1}).size(), 0u);
    }
}

TEST(MovingShape, VanishesForGoodAtItsTime) {
  for (const double rate_hz : {15.0, 30.0, 60.0}) {
    MovingShape::Settings s = busy(Kind::flat);
    s.frame_rate_hz = rate_hz;
    const MovingShape stays = made(s);
    s.vanish_at_s = 0.4;
    const MovingShape shape = made(s);
    const int last = static_cast<int>(std::lround(0.4 * rate_hz));
    ASSERT_EQ(shape.frame_count(), last + 1);
    EXPECT_TRUE(scenes::same_points(shape.cloud(last - 1), stays.cloud(last - 1)));
    EXPECT_EQ(shape.cloud(last).size(), 0u);
    EXPECT_EQ(shape.points(last)->size(), 0u);
    const double gone_s = shape.captured_s(last);
    EXPECT_EQ(shape.signed_distance({0, 0.01, 0}, gone_s - 0.001),
              stays.signed_distance({0, 0.01, 0}, gone_s - 0.001));
    EXPECT_TRUE(std::isnan(shape.signed_distance({0, 0.01, 0}, gone_s)));
    EXPECT_EQ(shape.surface_height(0, 0, gone_s + 3), stays.surface_height(0, 0, gone_s));
  }
}

TEST(MovingShape, OneFrameMayBeEmpty) {
  for (const double rate_hz : {15.0, 30.0, 60.0}) {
    MovingShape::Settings s;
    s.frame_rate_hz = rate_hz, s.empty_frame_at_s = 0.4;
    const MovingShape rests = made(s);
    const int empty = static_cast<int>(std::lround(0.4 * rate_hz));
    ASSERT_EQ(rests.frame_count(), empty + 2);
    EXPECT_EQ(rests.cloud(empty).size(), 0u);
    EXPECT_TRUE(scenes::same_points(rests.cloud(empty - 1), rests.cloud(empty + 1)));
    EXPECT_EQ(rests.signed_distance({0, 0.01, 0}, 0.41), 0.01) << "it is there, and not seen";
    s = busy(Kind::ripple), s.frame_rate_hz = rate_hz, s.empty_frame_at_s = 0.4;
    EXPECT_EQ(made(s).cloud(empty).size(), 0u);
    EXPECT_GT(made(s).cloud(empty + 1).size(), 0u);
  }
}

}  // namespace
}  // namespace remote_touch::moving_shape_test
