// The true normal of a scene, against normals in closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>

#include "core/points/vector.h"
#include "scenarios/simulated/grid_scenes.h"
#include "scenarios/simulated/panel_scenes.h"
#include "scenarios/simulated/sensor_faults.h"
#include "scenarios/simulated/shape.h"
#include "tests/support/scenes.h"

namespace remote_touch::true_normal_test {
namespace {

template <class Made>
Made made(const typename Made::Settings& settings = {}) {
  return Made(settings, {1, 2, 3}, scenes::kernels());
}

MovingShape shape(Shape::Kind kind, double tilt_deg = 0) {
  MovingShape::Settings settings;
  settings.shape.kind = kind;
  settings.motion.tilt_deg = tilt_deg;
  settings.motion.lift.start_depth_m = 0;
  return made<MovingShape>(settings);
}

void expect_normal(const Scenario& scene, const Vec3& p_W, double time_s, const Vec3& expected,
                   double tolerance = 1e-9) {
  EXPECT_LT((scene.true_normal(p_W, time_s) - expected).norm(), tolerance)
      << scene.true_normal(p_W, time_s).transpose() << " at " << p_W.transpose() << ", " << time_s << " s";
}

TEST(TrueNormal, NormalOfAPlaneIsTheSameEverywhereAndWhileItMoves) {
  const auto lift = made<MovingLift>();
  const auto plane = made<MovingPlane>();
  const auto grid = made<FlatGrid>();
  for (const Scenario* scene : {static_cast<const Scenario*>(&lift), static_cast<const Scenario*>(&plane),
                                static_cast<const Scenario*>(&grid)})
    for (const double time_s : {0.0, 0.4, 0.9}) {
      for (const Vec3& p_W : {Vec3(0, 0.005, 0), Vec3(0.03, -0.02, -0.04)})
        expect_normal(*scene, p_W, time_s, Vec3::UnitY());
      EXPECT_EQ(scene->plane_normal(time_s), Vec3(Vec3::UnitY()));
    }
}

TEST(TrueNormal, NormalOfATiltedPlaneIsTilted) {
  for (const double tilt_deg : {-40.0, 0.0, 20.0}) {
    const auto [sine, cosine] = sin_cos(tilt_deg * kRadiansPerDegree);
    const MovingShape plane = shape(Shape::Kind::flat, tilt_deg);
    const Vec3 expected(-sine, cosine, 0);
    expect_normal(plane, {0.001, 0.004, 0.002}, 0, expected);
    ASSERT_TRUE(plane.plane_normal(0));
    EXPECT_LT((*plane.plane_normal(0) - expected).norm(), 1e-15);
  }
}

// The normal over a flank is perpendicular to the flank. Over a crest it points from the crest to p.
TEST(TrueNormal, ATriangleWaveHasTheNormalsOfItsFlanksAndCrests) {
  TriangleWave::Settings settings;
  settings.period_m = 0.04, settings.max_height_m = 0.01;
  const auto wave = made<TriangleWave>(settings);
  const double start = settings.grid.x(0), half = 0.5 * settings.period_m;
  for (const int k : {1, 3, 5}) {  // crests of growing height
    const double x0 = start + k * half, x1 = x0 + half, x = 0.5 * (x0 + x1);
    const double y0 = wave.surface_height(x0, 0, 0), y1 = wave.surface_height(x1, 0, 0);
    const Vec3 flank = Vec3(y0 - y1, x1 - x0, 0).normalized(), crest = Vec3(0.01, 1, 0).normalized();
    ASSERT_GT(y0, y1);
    expect_normal(wave, Vec3(x, 0.5 * (y0 + y1), 0) + 0.002 * flank, 0, flank);
    expect_normal(wave, Vec3(x, 0.5 * (y0 + y1), 0) - 0.001 * flank, 0, flank);
    ASSERT_LT(0.01, (y0 - y1) / half) << "above the crest, beyond both flanks";
    expect_normal(wave, Vec3(x0, y0, 0) + 0.005 * crest, 0, crest, 2e-4);
  }
}

TEST(TrueNormal, PointsAwayFromTheCentreOfABall) {
  const MovingShape ball = shape(Shape::Kind::sphere);
  const Vec3 centre_W(0, -Shape::Settings{}.radius_m, 0);
  for (const Vec3& p_W : {Vec3(0.01, 0.002, 0.004), Vec3(-0.02, 0, 0.01), Vec3(0.004, -0.01, -0.003)})
    expect_normal(ball, p_W, 0, (p_W - centre_W).normalized(), 1e-5);
}

// The distance of the ripple is found by a search, so the tolerance is larger.
TEST(TrueNormal, ARippleHasTheNormalOfItsNearestPoint) {
  const MovingShape ripple = shape(Shape::Kind::ripple);
  const Shape::Settings wave;
  const double per_m = 2 * M_PI / wave.period_m;
  for (const double x : {-0.0071, 0.0, 0.0023, 0.0075, 0.011}) {
    const Vec3 normal = Vec3(-wave.amplitude_m * per_m * std::cos(per_m * x), 1, 0).normalized();
    expect_normal(ripple, Vec3(x, wave.amplitude_m * std::sin(per_m * x), 0.003) + 0.002 * normal, 0, normal,
                  2e-4);
  }
}

// Over the bottom of a valley two flanks are equally near, and the normal could be that of either.
TEST(TrueNormal, IsNotKnownOverACrease) {
  const MovingShape valley = shape(Shape::Kind::valley);
  const auto [sine, cosine] = sin_cos(Shape::Settings{}.slope_deg * kRadiansPerDegree);
  for (const double x : {-5e-5, 0.0, 5e-5})
    EXPECT_TRUE(valley.true_normal({x, 0.006, 0}, 0).array().isNaN().all()) << x;
  expect_normal(valley, {0.001, 0.006, 0}, 0, {-sine, cosine, 0});
  expect_normal(valley, {-0.001, 0.006, 0}, 0, {sine, cosine, 0});
}

TEST(TrueNormal, OnlyAFlatSceneHasAPlaneNormal) {
  for (const Shape::Kind kind : {Shape::Kind::ridge, Shape::Kind::sphere, Shape::Kind::corner})
    EXPECT_FALSE(shape(kind).plane_normal(0));
  EXPECT_FALSE(made<TriangleWave>().plane_normal(0));
  EXPECT_FALSE(made<Slot>().plane_normal(0));
  EXPECT_EQ(made<SinglePanel>().plane_normal(0), Vec3(Vec3::UnitZ()));
}

TEST(TrueNormal, IsNotKnownOfASurfaceThatHasVanished) {
  MovingShape::Settings settings;
  settings.vanish_at_s = 0.5;
  const auto gone = made<MovingShape>(settings);
  EXPECT_TRUE(gone.plane_normal(0.4));
  EXPECT_FALSE(gone.plane_normal(0.6));
  EXPECT_TRUE(gone.true_normal({0, 0.01, 0}, 0.6).array().isNaN().all());
}

TEST(TrueNormal, ASensorWithFaultsHasTheNormalOfTheScene) {
  MovingShape::Settings settings;
  settings.motion.tilt_deg = 20;
  SensorFaults faults;
  faults.hole_fraction = 0.3;
  const auto plain = made<MovingShape>(settings);
  const FaultySensor poor(std::make_unique<MovingShape>(settings, NoiseKey{1, 2, 3}, scenes::kernels()),
                          faults, {1, 2, 3}, scenes::kernels());
  EXPECT_EQ(poor.plane_normal(0.2), plain.plane_normal(0.2));
  EXPECT_EQ(poor.true_normal({0, 0.01, 0}, 0.2), plain.true_normal({0, 0.01, 0}, 0.2));
}

}  // namespace
}  // namespace remote_touch::true_normal_test
