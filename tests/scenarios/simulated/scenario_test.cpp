#include "scenarios/simulated/scenario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <vector>

#include "core/points/vector.h"
#include "scenarios/simulated/camera_scenes.h"
#include "scenarios/simulated/depth_camera.h"
#include "scenarios/simulated/grid_scenes.h"
#include "scenarios/simulated/panel_scenes.h"
#include "scenarios/simulated/sensor_faults.h"
#include "scenarios/simulated/shape.h"
#include "tests/support/scenes.h"

namespace remote_touch::scenario_test {
namespace {

const NoiseKey kKey{1, 2, 3};

template <class Made>
Made made(const typename Made::Settings& settings = {}) {
  return Made(settings, kKey, scenes::kernels());
}

using Found = std::tuple<std::uint32_t, double, double, double>;  // number and position of a point

std::vector<Found> gathered(const NeighbourSearch& search, const Ball& ball) {
  const GatheredPoints out = scenes::gathered(search, ball);
  const PointsView view = out.view();
  std::vector<Found> found;
  for (std::size_t i = 0; i < out.size(); ++i)
    found.push_back({out.index()[i], view.x[i], view.y[i], view.z[i]});
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Found> expected(const PointCloud& cloud, const Ball& ball) {
  std::vector<Found> found;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 e = cloud.point(i) - ball.centre;
    if (e.x() * e.x() + e.y() * e.y() + e.z() * e.z() <= ball.radius * ball.radius)
      found.push_back({static_cast<std::uint32_t>(i), cloud.x[i], cloud.y[i], cloud.z[i]});
  }
  return found;
}

// A frame has the same bits if another object computes it, in another order.
template <class Made>
void expect_pure_frames(const typename Made::Settings& settings, const std::vector<int>& frames) {
  const Made one = made<Made>(settings), other = made<Made>(settings);
  std::vector<PointCloud> clouds;
  for (const int frame : frames) clouds.push_back(one.cloud(frame));
  for (std::size_t i = frames.size(); i-- > 0;) {
    EXPECT_TRUE(scenes::same_clouds(other.cloud(frames[i]), clouds[i])) << frames[i];
    if (i > 0) {
      EXPECT_FALSE(scenes::same_points(clouds[i], clouds[i - 1])) << "frames differ";
    }
    const Vec3 middle = clouds[i].point(clouds[i].size() / 3);
    const Ball ball{middle.allFinite() ? middle : Vec3::Zero(), 0.02};
    const auto found = gathered(*other.points(frames[i]), ball);
    EXPECT_FALSE(found.empty());
    EXPECT_EQ(found, expected(clouds[i], ball)) << "points() is cloud()";
  }
}

TEST(Scenario, FramesArePure) {
  FlatGrid::Settings flat;
  flat.noise_sigma_m = 0.001;
  expect_pure_frames<FlatGrid>(flat, {0, 1, 5, 1000});
  expect_pure_frames<MovingLift>({}, {0, 1, 15, 25});
  TriangleWave::Settings wave;
  wave.noise_sigma_m = 0.001;
  expect_pure_frames<TriangleWave>(wave, {0});
  MovingPlane::Settings plane;  // it waits in the first 30 frames
  plane.noise_sigma_m = 0.001;
  expect_pure_frames<MovingPlane>(plane, {0, 1, 40});
  expect_pure_frames<Wedge>({}, {0, 40, 70, 110});
  expect_pure_frames<CameraScene>({}, {0, 1, 7});
  expect_pure_frames<BeatingHeart>({}, {3, 9});
  expect_pure_frames<ValveTank>({}, {3, 9});
}

TEST(FlatGrid, PointsLieOnACentredGrid) {
  FlatGrid::Settings s;
  s.grid = {5, 3, 0.01, 0.25, -0.5};
  const PointCloud cloud = made<FlatGrid>(s).cloud(0);
  ASSERT_EQ(cloud.size(), 15u);
  EXPECT_LT((cloud.point(0) - Vec3(-0.0175, 0, -0.015)).norm(), 1e-17);
  EXPECT_LT((cloud.point(4) - Vec3(0.0225, 0, -0.015)).norm(), 1e-17);
  EXPECT_LT((cloud.point(14) - Vec3(0.0225, 0, 0.005)).norm(), 1e-17);
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
  MovingShape::Settings kept;
  kept.noise_sigma_m = 0.001, kept.redraw_noise = false;
  EXPECT_EQ(made<MovingShape>(kept).frame_count(), 1);
}

TEST(FlatGrid, NoiseIsRedrawnOrKept) {
  FlatGrid::Settings s;
  s.noise_sigma_m = 0.002;
  EXPECT_GT(made<FlatGrid>(s).frame_count(), 1000000);
  s.redraw_noise = false;
  EXPECT_EQ(made<FlatGrid>(s).frame_count(), 1);
  EXPECT_TRUE(scenes::same_points(made<FlatGrid>(s).cloud(0), made<FlatGrid>(s).cloud(3)));
  double squares = 0;
  for (const double y : made<FlatGrid>(s).cloud(0).y) squares += y * y;
  EXPECT_NEAR(std::sqrt(squares / 1e4), 0.002, 5 * 0.002 / std::sqrt(2e4));  // standard error for 10^4 draws
}

// Noise is drawn on demand here. The oracle draws all of it and tests every point.
TEST(MovingLift, LazyPointsAreTheCloudBitForBit) {
  std::mt19937 random(1);
  for (const double sigma : {0.0, 0.003, 0.015}) {
    MovingLift::Settings s;
    s.noise_sigma_m = sigma;
    const MovingLift lift = made<MovingLift>(s);
    for (const int frame : {0, 14, 25}) {
      const PointCloud cloud = lift.cloud(frame);
      const double y = lift.surface_height(0, 0, lift.captured_s(frame));
      const PointCloud at = scenes::random_cloud(60, 1, static_cast<unsigned>(frame));
      std::vector<Ball> balls;
      for (std::size_t i = 0; i < at.size(); ++i) {
        const Vec3 far(0.17 * at.x[i], y + 0.1 * at.y[i], 0.17 * at.z[i]);  // beyond the grid's edge at 0.149
        const Vec3 near(0.03 * at.x[i], y + (0.01 + 3 * sigma) * at.y[i], 0.03 * at.z[i]);
        balls.push_back({i % 2 == 0 ? far : near, 0.002 + 0.0003 * static_cast<double>(i)});
        balls.push_back({balls.back().centre + Vec3(0.001, 0.0002, -0.001), 0.01});  // a proxy moves a little
      }
      // The point that the noise has moved highest: only a bound that no normal variate exceeds finds it.
      const auto highest = std::max_element(cloud.y.begin(), cloud.y.end()) - cloud.y.begin();
      balls.push_back({cloud.point(static_cast<std::size_t>(highest)), 1e-5});
      const auto search = lift.points(frame);
      std::size_t total = 0, empty = 0;
      for (int round = 0; round < 2; ++round) {
        for (const Ball& ball : balls) {
          const auto want = expected(cloud, ball);
          ASSERT_EQ(gathered(*search, ball), want) << sigma << ", " << ball.centre.transpose();
          total += want.size(), empty += want.empty();
        }
        std::shuffle(balls.begin(), balls.end(), random);
      }
      EXPECT_GT(total, 2000u);
      EXPECT_GT(empty, 5u);
    }
  }
}

// Corners half a period apart, alternately below and above by an amplitude that grows along the grid.
double wave_height(double x) {
  const double length = 299 * 0.0015, place = std::clamp((x + 0.5 * length) / 0.03, 0.0, length / 0.03);
  const int k = static_cast<int>(place);
  const auto corner = [&](int i) { return (i % 2 == 1 ? 0.015 : -0.015) * std::min(1.0, i * 0.03 / length); };
  return corner(k) + (place - k) * (corner(k + 1) - corner(k));
}

TEST(TriangleWave, RefusesAGridOfOneColumn) {
  TriangleWave::Settings settings;
  EXPECT_EQ(validate(settings), "");
  settings.grid.columns = 1;
  EXPECT_EQ(validate(settings), "columns = 1: expected 2 or more, because the wave runs along x");
}

TEST(TriangleWave, SignedDistanceIsToTheStraightFlanks) {
  const TriangleWave wave = made<TriangleWave>();
  EXPECT_NEAR(wave.surface_height(-149.5 * 0.0015 + 0.09, 1, 0), 0.015 * 0.09 / (299 * 0.0015), 1e-15);
  const double end = 149.5 * 0.0015, spacing = 2e-5;
  const PointCloud at = scenes::random_cloud(200, 1, 1);
  int below = 0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vec3 p(0.22 * at.x[i], 0.025 * at.y[i], 0.07 * at.z[i]);
    double squared = std::numeric_limits<double>::infinity();
    for (double x = -end; x <= end; x += spacing)
      squared = std::min(squared, std::pow(x - p.x(), 2) + std::pow(wave_height(x) - p.y(), 2));
    const double got = wave.signed_distance(p, 0);
    EXPECT_NEAR(wave.surface_height(p.x(), p.z(), 0), wave_height(p.x()), 1e-15);
    EXPECT_EQ(got < 0, p.y() < wave_height(p.x()));
    // The flanks rise by less than 1: samples are at most 1.5 spacings apart along them.
    EXPECT_LE(std::abs(got), std::sqrt(squared) + 1e-15);
    EXPECT_GE(std::sqrt(got * got + 2.25 * spacing * spacing), std::sqrt(squared) - 1e-15);
    below += got < 0;
  }
  EXPECT_GT(below, 50);
  EXPECT_TRUE(std::isnan(wave.signed_distance({0, -0.05, 0.08}, 0))) << "beside the cloud, along z";
  EXPECT_TRUE(std::isnan(wave.signed_distance({end + 1, -0.05, 0}, 0))) << "and along x";
  EXPECT_GT(wave.signed_distance({end + 0.01, 0.05, 0.08}, 0), 0);
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

// The camera looks from (0.3, 0.6) to (0, 0.02) in the (x, y) plane.
std::size_t pixel(int u, int v) {
  return static_cast<std::size_t>(v) * 640 + static_cast<std::size_t>(u);
}

CameraScene ideal_camera() {
  CameraScene::Settings s;
  s.camera.noise_per_m = s.camera.quantisation_per_m = 0;
  return made<CameraScene>(s);
}

TEST(CameraScene, TableIsSeenAtItsDistance) {
  const CameraScene scene = ideal_camera();
  const PointCloud cloud = scene.cloud(0);
  // The axis passes between ramp and box. A row looks down by its tangent (v - 239.5) / 525.
  for (const int v : {200, 239, 240, 300})
    for (const int u : {310, 320, 335}) {
      const double down = (v - 239.5) / 525;
      const double depth = 0.6 * std::sqrt(0.3 * 0.3 + 0.58 * 0.58) / (0.58 + 0.3 * down);
      EXPECT_NEAR(scene.true_depth().z_m[pixel(u, v)], depth, 1e-14) << u << " " << v;
      EXPECT_NEAR(cloud.y[pixel(u, v)], 0, 1e-14);
      EXPECT_NEAR(cloud.z[pixel(u, v)], -0.02 - (u - 319.5) / 525 * depth, 1e-14) << "z is to the left";
    }
}

TEST(CameraScene, NoiseFreePointsLieOnTheSurfaceInSight) {
  const CameraScene scene = ideal_camera();
  const PointCloud cloud = scene.cloud(0);
  int on_solids = 0;
  for (std::size_t i = 0; i < cloud.size(); i += 3) {
    if (std::isnan(cloud.x[i])) continue;
    const Vec3 p = cloud.point(i);
    ASSERT_LT(std::abs(scene.signed_distance(p, 0)), 1e-12) << p.transpose();
    for (const double fraction : {0.7, 0.9, 0.99, 0.999})
      ASSERT_GT(scene.signed_distance(Vec3(0.3, 0.6, -0.02) + fraction * (p - Vec3(0.3, 0.6, -0.02)), 0), 0);
    on_solids += p.y() > 0.001;
  }
  EXPECT_GT(on_solids, 5000);
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
