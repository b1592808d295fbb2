// Scenes of points on a grid: lifts, planes and waves against their closed forms.
#include "scenarios/simulated/grid_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/simulated/shape.h"
#include "tests/support/scenes.h"

// A lift against its closed form: the motion is a function of time, which frames sample.
namespace remote_touch::lifts_test {
namespace {

constexpr double kRates_hz[] = {15, 30, 60, 90, 1000, 7.5, 29.97};

// The lift of Fig 4.12 after a wait.
LiftMotion::Settings lift() {
  return {0.2, 0.05, 0.1, 0.5, 3, 1 / 3.0};
}

// y = y_0 + v_0 t + a t (t + 1 / u) / 2 from one update before the end of the rise on.
double closed_form(const LiftMotion::Settings& s, double time_s) {
  const double since_s = std::clamp(time_s - s.wait_s, 0.0, s.rise_s + s.acceleration_s);
  const double step_s = 1 / s.update_rate_hz, t = since_s - s.rise_s;
  const double accelerated = t > -step_s ? 0.5 * s.acceleration_m_per_s2 * t * (t + step_s) : 0;
  return -s.start_depth_m + s.start_velocity_m_per_s * since_s + accelerated;
}

// --- a function of time ---

TEST(LiftMotion, IsTheClosedFormAtAnyTime) {
  LiftMotion::Settings odd = lift();  // no update where a part begins or ends
  odd.wait_s = 0.123, odd.rise_s = 0.4567, odd.acceleration_s = 0.2345, odd.update_rate_hz = 17;
  const LiftMotion::Settings receding{0.1, -0.02, -0.3, 0.1};  // the range begins above zero
  for (const LiftMotion::Settings& s : {lift(), odd, receding}) {
    const LiftMotion motion(s);
    for (int tick = 0; tick < 1500; ++tick)
      EXPECT_NEAR(motion.height_m(0.001 * tick), closed_form(s, 0.001 * tick), 1e-14) << tick;
  }
}

// Checks the frames of a scene at each rate, and the surface between the frames.
template <class Made>
void expect_the_same_motion(typename Made::Settings settings, const LiftMotion::Settings& expected) {
  settings.noise_sigma_m = 0, settings.truth = SurfaceTime::moving;
  settings.grid = {3, 3, 0.01, 0, 0};
  for (const double rate_hz : kRates_hz) {
    settings.frame_rate_hz = rate_hz;
    const Made scene(settings, {1, 2, 3}, scenes::kernels());
    for (int frame = 0; frame < scene.frame_count(); ++frame)
      ASSERT_NEAR(scene.cloud(frame).y[4], closed_form(expected, scene.captured_s(frame)), 1e-14)
          << rate_hz << " " << frame;
    EXPECT_NEAR(scene.cloud(scene.frame_count() - 1).y[4], closed_form(expected, 100), 1e-14) << "at rest";
    for (int tick = 0; tick < 1200; ++tick) {
      ASSERT_NEAR(scene.surface_height(0, 0, 0.001 * tick), closed_form(expected, 0.001 * tick), 1e-14)
          << rate_hz << " " << tick;
      ASSERT_NEAR(scene.signed_distance({0, 0.1, 0}, 0.001 * tick), 0.1 - closed_form(expected, 0.001 * tick),
                  1e-14);
    }
  }
}

TEST(LiftMotion, IsTheSameAtEveryFrameRate) {
  MovingLift::Settings plane;
  plane.lift = lift();
  expect_the_same_motion<MovingLift>(plane, lift());
  MovingShape::Settings shape;
  shape.motion.lift = lift();
  expect_the_same_motion<MovingShape>(shape, lift());
}

// --- the heights that 4.3.2 gives ---

// The heights at frames that coincide with the updates are the sums of 4.3.2, bit for bit.
TEST(LiftMotion, HasThePrintedHeights) {
  for (const double rate_hz : {30.0, 90.0, 130.0}) {
    for (const int rise : {0, 13, 15, 45}) {
      LiftMotion::Settings s = lift();
      s.wait_s = 7 / rate_hz, s.rise_s = rise / rate_hz, s.acceleration_s = 10 / rate_hz;
      s.update_rate_hz = rate_hz;
      const LiftMotion motion(s);
      ASSERT_EQ(motion.frame_count(rate_hz), 7 + rise + 10 + 1);
      double velocity = s.start_velocity_m_per_s, height = -s.start_depth_m;
      for (int frame = 0; frame <= 7 + rise + 10 + 3; ++frame) {
        if (frame >= 7 && frame <= 7 + rise) height = -s.start_depth_m + (frame - 7) * (velocity / rate_hz);
        if (frame > 7 + rise && frame <= 7 + rise + 10)
          velocity += s.acceleration_m_per_s2 / rate_hz, height += velocity / rate_hz;
        EXPECT_EQ(motion.height_of_frame_m(frame, rate_hz), height) << rate_hz << " " << rise << " " << frame;
      }
    }
  }
}

TEST(LiftMotion, MayBeLinearBetweenUpdates) {
  LiftMotion::Settings s = lift();
  const LiftMotion parabola(s);
  s.between_updates = LiftMotion::BetweenUpdates::line;
  const LiftMotion line(s);
  for (int tick = 0; tick < 1200; ++tick) {
    const double place = 0.001 * tick * 30, before_s = std::floor(place) / 30, after_s = before_s + 1 / 30.0;
    const double part = place - std::floor(place), low = parabola.height_m(before_s);
    EXPECT_NEAR(line.height_m(0.001 * tick), low + part * (parabola.height_m(after_s) - low), 1e-14) << tick;
  }
}

TEST(LiftMotion, NamesItsPhases) {
  const auto parts = LiftMotion(lift()).phases();
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].name, "the rise");
  EXPECT_NEAR(parts[0].begins_s, 0.2, 1e-12);
  EXPECT_NEAR(parts[1].begins_s, 0.7, 1e-12);
  EXPECT_NEAR(parts[1].ends_s, 0.7 + 1 / 3.0, 1e-12);
  LiftMotion::Settings steady = lift();
  steady.acceleration_m_per_s2 = 0;
  EXPECT_NEAR(LiftMotion(steady).phases().at(0).ends_s, 0.7 + 1 / 3.0, 1e-12);
  steady.start_velocity_m_per_s = 0;
  EXPECT_TRUE(LiftMotion(steady).phases().empty());
}

// --- the proxy on it: (4.14) at every rate ---

TEST(LiftMotion, PopsThroughAtTheBoundOfEachFrameRate) {
  for (const double rate_hz : {15.0, 30.0, 60.0}) {
    for (const double of_bound : {0.97, 1.03}) {
      const double acceleration = of_bound * 0.00499 * rate_hz * rate_hz;
      const Trace trace = simulate(Experiment::load(
          "fig4.12", {"scenario.noise_sigma_m=0", "scenario.start_velocity_m_per_s=0.05",
                      "scenario.start_depth_m=0.025", "scenario.frame_rate_hz=" + std::to_string(rate_hz),
                      "scenario.acceleration_m_per_s2=" + std::to_string(acceleration)}));
      EXPECT_EQ(trace.signed_distance_m.back() < 0, of_bound > 1) << rate_hz << " " << of_bound;
    }
  }
}

}  // namespace
}  // namespace remote_touch::lifts_test

// Grids and waves at rest, the plane that rises, and points whose noise is made on demand.
namespace remote_touch::grid_scenes_test {
namespace {

template <class Made>
Made made(const typename Made::Settings& settings = {}) {
  return Made(settings, {1, 2, 3}, scenes::kernels());
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

TEST(FlatGrid, PointsLieOnACentredGrid) {
  FlatGrid::Settings s;
  s.grid = {5, 3, 0.01, 0.25, -0.5};
  const PointCloud cloud = made<FlatGrid>(s).cloud(0);
  ASSERT_EQ(cloud.size(), 15u);
  EXPECT_LT((cloud.point(0) - Vec3(-0.0175, 0, -0.015)).norm(), 1e-17);
  EXPECT_LT((cloud.point(4) - Vec3(0.0225, 0, -0.015)).norm(), 1e-17);
  EXPECT_LT((cloud.point(14) - Vec3(0.0225, 0, 0.005)).norm(), 1e-17);
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

TEST(MovingPlane, WaitsRisesAndRests) {
  MovingPlane::Settings s;
  s.acceleration_m_per_s2 = 0.6;
  const MovingPlane plane = made<MovingPlane>(s);
  const auto height = [&](double t) { return plane.surface_height(0, 0, t); };
  EXPECT_EQ(height(0), -0.06);
  EXPECT_EQ(height(1), -0.06);
  EXPECT_NEAR(height(1.1), -0.06 + 0.01 + 0.003, 1e-15);
  // 0.1 t + 0.3 t^2 = 0.1
  const double end = (-0.1 + std::sqrt(0.01 + 0.12)) / 0.6;
  EXPECT_NEAR(height(1 + end - 1e-9), 0.04, 1e-9);
  EXPECT_EQ(height(1 + end + 1e-12), -0.06 + 0.1);
  EXPECT_EQ(plane.frame_count(), 1 + static_cast<int>(std::ceil((1 + end) * 30)));
  EXPECT_NEAR(plane.signed_distance({0.09, -0.05, 0.02}, 1.1), -0.05 + 0.047, 1e-15);
  EXPECT_NEAR(plane.signed_distance({1, -0.04, 2}, 1.1), -0.04 + 0.047, 1e-15);
  EXPECT_TRUE(std::isnan(plane.signed_distance({1, -0.05, 2}, 1.1))) << "beside the cloud";
  for (const int frame : {0, 31, 40, plane.frame_count() - 1}) {
    const PointCloud cloud = plane.cloud(frame);
    EXPECT_EQ(cloud.y[7], height(plane.captured_s(frame)));
    EXPECT_EQ(cloud.normal(7), Vec3(Vec3::UnitY()));
  }
  s.speed_m_per_s = s.acceleration_m_per_s2 = s.rise_height_m = 0;
  EXPECT_EQ(made<MovingPlane>(s).frame_count(), 1);
}

// It rises for 1e8 s, which is 1e12 frames.
TEST(MovingPlane, LimitsItsFramesToTheLargestInt) {
  MovingPlane::Settings s;
  s.frame_rate_hz = 10000, s.speed_m_per_s = 1e-6, s.rise_height_m = 100;
  EXPECT_EQ(made<MovingPlane>(s).frame_count(), std::numeric_limits<int>::max());
}

}  // namespace
}  // namespace remote_touch::grid_scenes_test
