// A lift against its closed form: the motion is a function of time, which frames sample.
#include "scenarios/simulated/grid_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"
#include "scenarios/simulated/shape.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

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
  const LiftMotion::Settings receding{0.1, -0.02, -0.3, 0.1};  // from above zero
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

TEST(LiftMotion, EventsOfAShapeAreAtTheirTimesAtAnyFrameRate) {
  for (const double rate_hz : {15.0, 30.0, 60.0}) {
    MovingShape::Settings s;
    s.frame_rate_hz = rate_hz, s.empty_frame_at_s = 0.4, s.vanish_at_s = 0.8;
    const MovingShape shape(s, {1, 2, 3}, scenes::kernels());
    for (int frame = 0; frame < shape.frame_count(); ++frame) {
      const bool is_empty = frame == std::lround(0.4 * rate_hz),
                 is_gone = frame >= std::lround(0.8 * rate_hz);
      EXPECT_EQ(shape.cloud(frame).size() == 0, is_empty || is_gone) << rate_hz << " " << frame;
    }
  }
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
