// Properties of all simulated scenes: refusals of settings, sides without a back, noise that goes on,
// frames that are kept, and the true normal.
#include "scenarios/simulated/scenario.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/points/vector.h"
#include "scenarios/simulated/camera_scenes.h"
#include "scenarios/simulated/depth_camera.h"
#include "scenarios/simulated/grid_scenes.h"
#include "scenarios/simulated/panel_scenes.h"
#include "scenarios/simulated/sensor_faults.h"
#include "scenarios/simulated/shape.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::scenario_test {
namespace {

const NoiseKey kKey{1, 2, 3};

template <class Made>
Made made(const typename Made::Settings& settings = {}) {
  return Made(settings, kKey, scenes::kernels());
}

// Noise that is drawn anew in each frame does not stop when the surface does, after 2 s at most.
template <class Made>
void expect_endless_noise() {
  typename Made::Settings s;
  s.grid = {4, 4, 0.002, 0, 0}, s.noise_sigma_m = 0.001;
  const Made noisy = made<Made>(s);
  EXPECT_EQ(noisy.frame_count(), std::numeric_limits<int>::max());
  for (const int frame : {70, 1000}) {
    EXPECT_FALSE(scenes::same_points(noisy.cloud(frame), noisy.cloud(frame + 1))) << frame;
    EXPECT_EQ(noisy.surface_height(0, 0, noisy.captured_s(frame)),
              noisy.surface_height(0, 0, noisy.captured_s(frame + 1)));
  }
  s.noise_sigma_m = 0;
  EXPECT_LT(made<Made>(s).frame_count(), 70);
}

TEST(Scenario, NoiseGoesOnWhenTheSurfaceRests) {
  expect_endless_noise<FlatGrid>();
  expect_endless_noise<MovingLift>();
  expect_endless_noise<MovingPlane>();
  expect_endless_noise<MovingShape>();
  expect_endless_noise<Plates>();
  MovingShape::Settings kept;
  kept.noise_sigma_m = 0.001, kept.redraw_noise = false;
  EXPECT_EQ(made<MovingShape>(kept).frame_count(), 1);
  FlatGrid::Settings grid;
  grid.noise_sigma_m = 0.002, grid.redraw_noise = false;
  EXPECT_EQ(made<FlatGrid>(grid).frame_count(), 1);
  EXPECT_TRUE(scenes::same_points(made<FlatGrid>(grid).cloud(0), made<FlatGrid>(grid).cloud(3)));
}

// A position below the plane but beside the cloud has passed through no surface. Single points have no sides.
TEST(Scenario, HasNoBackBesideItsPoints) {
  const FlatGrid flat = made<FlatGrid>();  // 100 x 100 points, 1.5 mm apart
  const double border = 49.5 * 0.0015;
  for (const Vec3& p : {Vec3(border, -0.01, 0), Vec3(0, -0.01, -border)})
    EXPECT_EQ(flat.signed_distance(p, 0), -0.01);
  for (const Vec3& p : {Vec3(border + 1e-6, -0.01, 0), Vec3(0, -0.01, -border - 1e-6)})
    EXPECT_TRUE(std::isnan(flat.signed_distance(p, 0)));
  EXPECT_EQ(flat.signed_distance({1, 0.01, 1}, 0), 0.01);
  const MovingLift lift = made<MovingLift>();  // 200 x 200 points
  EXPECT_TRUE(std::isnan(lift.signed_distance({99.5 * 0.0015 + 1e-6, -1, 0}, 0)));
  EXPECT_LT(lift.signed_distance({99.5 * 0.0015, -1, 0}, 0), -0.9);
  const ListedPoints points = made<ListedPoints>();
  for (const double y : {0.01, 0.0, -0.01}) EXPECT_TRUE(std::isnan(points.signed_distance({0, y, 0}, 0)));
}

// Settings that contradict each other, one row for each refusal.
TEST(Scenario, SettingsThatContradictEachOtherAreRefused) {
  const auto why = [](auto settings, auto change) {
    EXPECT_EQ(validate(settings), "") << "the settings without the change";
    change(settings);
    return validate(settings);
  };
  const std::string same_place = "camera_position_m and target_position_m: expected two different positions";
  const std::pair<std::string, std::string> rows[] = {
      {why(DepthCameraSettings{}, [](auto& s) { s.target_position_m = s.camera_position_m; }), same_place},
      {why(DepthSensorSettings{}, [](auto& s) { s.camera.target_position_m = s.camera.camera_position_m; }),
       same_place},
      {why(DepthSensorSettings{}, [](auto& s) { s.baseline_m = 0; }), "baseline_m = 0: expected above 0"},
      {why(ValveTank::Settings{}, [](auto& s) { s.left_valve_position_m.z() = 0.01; }), "left_valve"},
      {why(ValveTank::Settings{}, [](auto& s) { s.camera.camera_position_m.z() = 0; }), "camera_position_m"},
      {why(TriangleWave::Settings{}, [](auto& s) { s.grid.columns = 1; }),
       "columns = 1: expected 2 or more, because the wave runs along x"},
      {why(OpenBox::Settings{}, [](auto& s) { s.size_m.y() = 0; }), "size_m"},
      {why(Wedge::Settings{}, [](auto& s) { s.open_start_s = 1.5; }), "expected in ascending order"},
      {why(SinglePanel::Settings{}, [](auto& s) { s.normal.setZero(); }), "normal"},
      {why(MovingPlane::Settings{}, [](auto& s) { s.speed_m_per_s = s.acceleration_m_per_s2 = 0; }), "speed"},
      {why(ListedPoints::Settings{}, [](auto& s) { s.points.clear(); }), "points: expected one or more"},
      {why(Plates::Settings{}, [](auto& s) { s.plates = {0, 0, 0, 0.2, 0, 0, 0, 0, 0}; }),
       "row 1: expected sizes"},
      {why(Plates::Settings{}, [](auto& s) { s.plates.clear(); }), "plates = []: expected one row or more"},
      {why(MovingShape::Settings{},
           [](auto& s) {
             s.shape.kind = Shape::Kind::ridge, s.shape.slope_deg = 60;
             s.motion.tilt_deg = -20, s.motion.rock_deg = 10;
           }),
       "below 89 degrees together, not 90.0"},
      {why(SensorFaults{}, [](auto& s) { s.view_direction.setZero(); }), "view_direction: expected a vector"},
  };
  for (const auto& [text, part] : rows) EXPECT_HAS(text, part);
  MovingShape::Settings ball;
  ball.motion.tilt_deg = -20, ball.motion.rock_deg = 10, ball.shape.slope_deg = 60;
  ball.shape.kind = Shape::Kind::sphere;
  EXPECT_EQ(validate(ball), "") << "it has no slope";
  ball.shape.kind = Shape::Kind::ridge, ball.motion.rock_deg = 0;
  EXPECT_EQ(validate(ball), "") << "80 degrees";
}

// Frames that are kept are made once; the frame that was used longest ago is dropped.

KeptFrames::Points one_point(std::size_t frame) {
  return make_search(scenes::cloud_of({Vec3(static_cast<double>(frame), 0, 0)}));
}

double x_of(const KeptFrames::Points& points) {
  return points->stored_cloud()->x.at(0);
}

TEST(KeptFrames, AreMadeOnce) {
  KeptFrames frames(2);
  std::map<std::size_t, int> made;
  const auto get = [&](std::size_t frame) {
    const KeptFrames::Points points = frames.get(frame, [&] { return ++made[frame], one_point(frame); });
    EXPECT_EQ(x_of(points), static_cast<double>(frame));
    return points;
  };
  const KeptFrames::Points first = get(0);
  EXPECT_EQ(get(0), first);
  get(1), get(0), get(1), get(0);
  EXPECT_EQ(made, (std::map<std::size_t, int>{{0, 1}, {1, 1}}));
  get(2);  // instead of 1, which was used longest ago
  get(0), get(1), get(1);
  EXPECT_EQ(made, (std::map<std::size_t, int>{{0, 1}, {1, 2}, {2, 1}}));
}

TEST(KeptFrames, AFrameThatCannotBeMadeIsNotKept) {
  KeptFrames frames(1);
  const auto fails = []() -> KeptFrames::Points { throw std::runtime_error("no frame"); };
  EXPECT_THROW(frames.get(0, fails), std::runtime_error);
  EXPECT_EQ(x_of(frames.get(0, [] { return one_point(7); })), 7);
  EXPECT_EQ(x_of(frames.get(0, fails)), 7);
}

TEST(KeptFrames, SeveralThreadsGetTheSameFrames) {
  KeptFrames frames(3);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&frames, t] {
      for (std::size_t i = 0; i < 500; ++i) {
        const std::size_t frame = (i + t) % 5;
        EXPECT_EQ(x_of(frames.get(frame, [&] { return one_point(frame); })), static_cast<double>(frame));
      }
    });
  for (std::thread& thread : threads) thread.join();
}

}  // namespace
}  // namespace remote_touch::scenario_test

// The true normal of a scene, against normals in closed form.
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
  const auto tilted = shape(Shape::Kind::flat, -40), level = shape(Shape::Kind::flat, 0);
  const auto [sine, cosine] = sin_cos(-40 * kRadiansPerDegree);
  const Vec3 up = Vec3::UnitY(), aslant(-sine, cosine, 0);
  const std::pair<const Scenario*, Vec3> rows[] = {
      {&lift, up}, {&plane, up}, {&grid, up}, {&level, up}, {&tilted, aslant}};
  for (const auto& [scene, normal] : rows)
    for (const double time_s : {0.0, 0.4, 0.9}) {
      for (const Vec3& p_W : {Vec3(0, 0.005, 0), Vec3(0.03, -0.02, -0.04)})
        expect_normal(*scene, p_W, time_s, normal);
      EXPECT_LT((scene->plane_normal(time_s).value() - normal).norm(), 1e-15);
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

// Over the bottom of a valley two flanks are equally near, and the normal could be that of either.
TEST(TrueNormal, IsNotKnownOverACreaseOrOfASurfaceThatHasVanished) {
  const MovingShape valley = shape(Shape::Kind::valley);
  const auto [sine, cosine] = sin_cos(Shape::Settings{}.slope_deg * kRadiansPerDegree);
  for (const double x : {-5e-5, 0.0, 5e-5})
    EXPECT_TRUE(valley.true_normal({x, 0.006, 0}, 0).array().isNaN().all()) << x;
  expect_normal(valley, {0.001, 0.006, 0}, 0, {-sine, cosine, 0});
  expect_normal(valley, {-0.001, 0.006, 0}, 0, {sine, cosine, 0});
  MovingShape::Settings settings;
  settings.vanish_at_s = 0.5;
  const auto gone = made<MovingShape>(settings);
  EXPECT_TRUE(gone.plane_normal(0.4));
  EXPECT_FALSE(gone.plane_normal(0.6));
  EXPECT_TRUE(gone.true_normal({0, 0.01, 0}, 0.6).array().isNaN().all());
}

TEST(TrueNormal, OnlyAFlatSceneHasAPlaneNormal) {
  for (const Shape::Kind kind : {Shape::Kind::ridge, Shape::Kind::sphere, Shape::Kind::corner})
    EXPECT_FALSE(shape(kind).plane_normal(0));
  EXPECT_FALSE(made<TriangleWave>().plane_normal(0));
  EXPECT_FALSE(made<Slot>().plane_normal(0));
  EXPECT_EQ(made<SinglePanel>().plane_normal(0), Vec3(Vec3::UnitZ()));
}

}  // namespace
}  // namespace remote_touch::true_normal_test
