// A target that is lost, and forces that begin and end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/virtual_fixtures/guided_renderer.h"
#include "tests/core/dissertation/virtual_fixtures/guided_scene.h"

namespace remote_touch::guidance_over_time_test {
namespace {

using namespace guided_scene;

class GuidanceOverTime : public testing::TestWithParam<Inner> {};
INSTANTIATE_TEST_SUITE_P(Guided, GuidanceOverTime, testing::Values(Inner::proxy, Inner::tool), inner_name);

Frame frame_at(double arrives_s, std::vector<GuidanceTarget> targets, int index) {
  Frame f = frame(std::move(targets), index);
  f.arrives_s = arrives_s;
  return f;
}

TEST_P(GuidanceOverTime, ALostTargetIsUsedForHoldSeconds) {
  GuidanceSettings holding = plain();
  holding.hold_s = 0.1;
  GuidedRenderer r = guided(GetParam(), {guide("valve")}, {}, holding);
  r.on_frame(frame_at(0, {target(kLeft)}, 0));
  EXPECT_EQ(r.step(device(kAbove), 0.05).guidance->goal_W, kLeft);
  r.on_frame(frame_at(0.0625, {GuidanceTarget{}}, 1));
  r.on_frame(frame_at(0.125, {GuidanceTarget{}}, 2));  // lost since the first of the two
  EXPECT_EQ(r.step(device(kAbove), 0.162).guidance->goal_W, kLeft);
  expect_no_guidance(r.step(device(kAbove), 0.163));
  r.on_frame(frame_at(0.1875, {target(kRight)}, 3));
  EXPECT_EQ(r.step(device(kAbove), 0.1875).guidance->goal_W, kRight);
}

TEST_P(GuidanceOverTime, ATargetThatWasNeverSeenIsNotHeld) {
  GuidanceSettings holding = plain();
  holding.hold_s = 10;
  GuidedRenderer r = guided(GetParam(), {guide("valve")}, {}, holding);
  r.on_frame(frame_at(0, {GuidanceTarget{}}, 0));
  expect_no_guidance(r.step(device(kAbove), 0.001));
}

// Closed form: a device that rests feels level times the spring, and the level changes by 1 ms / fade_s a
// tick.
TEST_P(GuidanceOverTime, TheForceRisesAndFallsEvenly) {
  GuidanceSettings fading = plain();
  fading.fade_s = 0.1;
  std::vector<SequenceStep> steps{step(FixtureAction::activate, "valve", StepStart::button, 0),
                                  step(FixtureAction::release, "valve", StepStart::button, 1)};
  GuidedRenderer r = guided(GetParam(), {guide("valve")}, steps, fading);
  r.on_frame(frame({target(kLeft)}));
  const Vec3 full_N = guidance_wrench(fading, -1, {kLeft, Eigen::Quaterniond::Identity()},
                                      {kAbove, Eigen::Quaterniond::Identity()})
                          .force_N;
  DeviceState held = device(kAbove);
  const auto level = [&](int ms) { return r.step(held, 0.001 * ms).force_N.norm() / full_N.norm(); };
  EXPECT_EQ(level(0), 0);
  held.buttons = 1;
  for (int ms = 1; ms <= 150; ++ms) EXPECT_NEAR(level(ms), std::min(1.0, 0.01 * ms), 1e-12) << ms;
  held.buttons = 2;
  for (int ms = 151; ms <= 300; ++ms) EXPECT_NEAR(level(ms), std::max(0.0, 0.01 * (250 - ms)), 1e-12) << ms;
  expect_no_guidance(r.step(held, 0.301));
}

// Wherever the two are in the list of fixtures.
TEST_P(GuidanceOverTime, TheGoalIsThatOfTheActiveFixtureWhileAnotherFades) {
  GuidanceSettings fading = plain();
  fading.fade_s = 0.1;
  for (const bool reversed : {false, true}) {
    const std::string first = reversed ? "right" : "left", second = reversed ? "left" : "right";
    const Vec3 first_W = reversed ? kRight : kLeft, second_W = reversed ? kLeft : kRight;
    std::vector<SequenceStep> steps{step(FixtureAction::activate, first, StepStart::button, 0),
                                    step(FixtureAction::activate, second, StepStart::button, 1),
                                    step(FixtureAction::release, second, StepStart::button, 2)};
    GuidedRenderer r = guided(GetParam(), {guide("left"), guide("right")}, steps, fading);
    r.on_frame(frame({target(kLeft), target(kRight)}));
    DeviceState held = device(kAbove);
    r.step(held, 0);
    held.buttons = 1;
    for (int ms = 1; ms <= 200; ++ms) {
      ASSERT_EQ(r.step(held, 0.001 * ms).guidance->goal_W, first_W) << ms;
    }
    held.buttons = 2;
    for (int ms = 201; ms <= 350; ++ms) {
      ASSERT_EQ(r.step(held, 0.001 * ms).guidance->goal_W, second_W) << ms;
    }
    held.buttons = 4;
    EXPECT_EQ(r.step(held, 0.351).guidance->goal_W, second_W) << "it fades alone";
  }
}

// The force of a lost target fades in the same way.
TEST_P(GuidanceOverTime, TheForceFallsWhenTheTargetIsLost) {
  GuidanceSettings fading = plain();
  fading.fade_s = 0.05, fading.hold_s = 0.1;
  GuidedRenderer r = guided(GetParam(), {guide("valve")}, {}, fading);
  r.on_frame(frame_at(0, {target(kLeft)}, 0));
  double before_N = 0, max_change_N = 0;
  for (int ms = 0; ms <= 400; ++ms) {
    if (ms == 200) r.on_frame(frame_at(0.2, {GuidanceTarget{}}, 1));
    const double force_N = r.step(device(kAbove), 0.001 * ms).force_N.norm();
    max_change_N = std::max(max_change_N, std::abs(force_N - before_N));
    before_N = force_N;
    if (ms >= 60 && ms < 300) {
      EXPECT_GT(force_N, 3.9) << ms;
    }
  }
  EXPECT_EQ(before_N, 0);
  EXPECT_LE(max_change_N, fading.max_force_N * 0.001 / fading.fade_s + 1e-12);
}

}  // namespace
}  // namespace remote_touch::guidance_over_time_test
