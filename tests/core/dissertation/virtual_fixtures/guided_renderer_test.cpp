// Guidance on top of the renderers: what is added to their wrench, when, how it begins and ends, and what a
// task switches.
#include "core/dissertation/virtual_fixtures/guided_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/tool_renderer.h"
#include "core/points/vector.h"
#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::guided_renderer_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

enum class Inner { proxy, tool };
std::string inner_name(const testing::TestParamInfo<Inner>& info) {
  return info.param == Inner::proxy ? "proxy" : "tool";
}

std::unique_ptr<Renderer> inner(Inner kind) {
  if (kind == Inner::proxy)
    return std::make_unique<ProxyRenderer>(ProxyParameters{}, 1000, scenes::kernels());
  return std::make_unique<ToolRenderer>(ToolParameters{}, scenes::box_tool({0.02, 0.005, 0.01}),
                                        scenes::kernels());
}

FixtureValues fixture(FixtureRole role, const std::string& label) {
  FixtureValues values;
  values.role = role, values.label = label;
  return values;
}
FixtureValues guide(const std::string& label) {
  return fixture(FixtureRole::guidance, label);
}
FixtureValues region(const std::string& label) {
  return fixture(FixtureRole::forbidden, label);
}

SequenceStep step(FixtureAction action, const std::string& label, StepStart start = StepStart::previous,
                  int button = 0) {
  SequenceStep s;
  s.action = action, s.fixture = label, s.start = start, s.button = button;
  return s;
}
SequenceStep until_reached(SequenceStep s) {
  s.end = StepEnd::reached;
  return s;
}

// The goal is the target itself, in the orientation of the base.
GuidanceSettings plain() {
  GuidanceSettings s;
  s.standoff_m = 0;
  return s;
}

using Switches = std::shared_ptr<FixtureSwitches>;
GuidedRenderer guided(Inner kind, const std::vector<FixtureValues>& fixtures,
                      std::vector<SequenceStep> steps = {}, const GuidanceSettings& settings = plain(),
                      const Switches& switches = std::make_shared<FixtureSwitches>()) {
  EXPECT_EQ(validate(fixtures, steps), "");
  return {inner(kind), settings, fixtures, std::move(steps), switches};
}

GuidanceTarget target(const Vec3& mean_W) {
  return {100, mean_W, Vec3::Zero()};
}

Frame frame(std::vector<GuidanceTarget> targets, int index = 0) {
  Frame f = scenes::frame(scenes::flat_grid(40), index);
  f.guidance = std::move(targets);
  return f;
}

DeviceState device(const Vec3& p_W, const Vec3& turn = Vec3::Zero(), std::uint32_t buttons = 0) {
  return {p_W, rotation(turn), buttons};
}

const Vec3 kAbove(0, 0.1, 0), kLeft(-0.05, 0.1, 0), kRight(0.05, 0.1, 0);

void expect_no_guidance(const RenderOutput& out) {
  ASSERT_TRUE(out.guidance);
  EXPECT_FALSE(out.guidance->active);
  EXPECT_EQ(out.guidance->force_N, Vec3::Zero());
  EXPECT_EQ(out.guidance->torque_Nm, Vec3::Zero());
  EXPECT_TRUE(out.guidance->goal_W.array().isNaN().all());
  EXPECT_TRUE(out.guidance->goal_orientation_W.coeffs().array().isNaN().all());
  EXPECT_EQ(out.force_N, Vec3::Zero());
  if (out.tool) {
    EXPECT_EQ(out.tool->torque_Nm, Vec3::Zero());
  }
}

class EveryRenderer : public testing::TestWithParam<Inner> {};
INSTANTIATE_TEST_SUITE_P(Guided, EveryRenderer, testing::Values(Inner::proxy, Inner::tool), inner_name);

// --- the wrench ---

// The guided renderer runs beside a plain renderer of the same kind, in a press into the grid.
TEST_P(EveryRenderer, TheSpringOfTheFixtureIsAddedAndNothingElseIsChanged) {
  FixtureValues valve = guide("valve");
  valve.stiffness_N_per_m = 10;
  GuidedRenderer r = guided(GetParam(), {valve});
  const auto alone = inner(GetParam());
  const ToolPose goal{{0.02, 0.05, 0}, Eigen::Quaterniond::Identity()};
  r.on_frame(frame({target(goal.p_W)})), alone->on_frame(frame({}));
  bool touched = false;
  for (int i = 0; i < 200; ++i) {
    const DeviceState d = device({0, 0.03 - 2.5e-4 * i, 0}, {0.002 * i, 0, 0.1});
    const RenderOutput out = r.step(d, 0.001 * i), plain_out = alone->step(d, 0.001 * i);
    const Wrench wrench = guidance_wrench(plain(), 10, goal, {d.position_W, d.orientation_W.normalized()});
    EXPECT_EQ(out.guidance->force_N, wrench.force_N);
    EXPECT_EQ(out.force_N, Vec3(plain_out.force_N + wrench.force_N));
    EXPECT_EQ(out.proxy_W, plain_out.proxy_W);
    EXPECT_EQ(out.status, plain_out.status);
    EXPECT_TRUE(out.guidance->active);
    EXPECT_EQ(out.guidance->goal_W, goal.p_W);
    EXPECT_EQ(out.tool.has_value(), GetParam() == Inner::tool);
    if (out.tool) {
      EXPECT_EQ(out.guidance->torque_Nm, wrench.torque_Nm);
      EXPECT_EQ(out.tool->torque_Nm, Vec3(plain_out.tool->torque_Nm + wrench.torque_Nm));
    } else {
      EXPECT_EQ(out.guidance->torque_Nm, Vec3::Zero()) << "there is nothing that it turns";
    }
    touched |= plain_out.force_N.norm() > 1;
  }
  EXPECT_TRUE(touched);
}

TEST_P(EveryRenderer, HasNoGuidanceBeforeAFrameOrWithoutATarget) {
  GuidedRenderer r = guided(GetParam(), {guide("valve")});
  expect_no_guidance(r.step(device(kAbove), 0));
  r.on_frame(frame({}));
  expect_no_guidance(r.step(device(kAbove), 0.001));
  GuidanceTarget few = target(kLeft);
  few.points = 19;
  r.on_frame(frame({few}, 1));
  expect_no_guidance(r.step(device(kAbove), 0.002));
  r.on_frame(frame({target(kLeft)}, 2));
  EXPECT_TRUE(r.step(device(kAbove), 0.003).guidance->active);
  r.on_frame(frame({GuidanceTarget{}}, 3));
  expect_no_guidance(r.step(device(kAbove), 0.004));
}

TEST_P(EveryRenderer, ADeviceThatIsNotFiniteIsNotPulled) {
  GuidedRenderer r = guided(GetParam(), {guide("valve")});
  r.on_frame(frame({target(kLeft)}));
  r.step(device(kAbove), 0);
  expect_no_guidance(r.step(device({kNaN, 0, 0}), 0.001));
  expect_no_guidance(r.step(device({0, 2e6, 0}), 0.002));
  EXPECT_TRUE(r.step(device(kAbove), 0.003).guidance->active);
}

TEST_P(EveryRenderer, AStaleFrameLeavesTheTarget) {
  GuidedRenderer r = guided(GetParam(), {guide("valve")});
  r.on_frame(frame({target(kLeft)}, 5));
  for (const int index : {4, 5}) {
    r.on_frame(frame({target(kRight)}, index));
    const RenderOutput out = r.step(device(kAbove), 0.2);
    EXPECT_EQ(out.status, RenderStatus::stale_frame_dropped);
    EXPECT_EQ(out.guidance->goal_W, kLeft);
  }
  r.on_frame(frame({target(kRight)}, 6));
  EXPECT_EQ(r.step(device(kAbove), 0.3).guidance->goal_W, kRight);
}

// --- how fixtures begin ---

TEST(GuidedRenderer, AFixtureBeginsAsTheOppositeOfItsFirstAction) {
  const auto switches = std::make_shared<FixtureSwitches>();
  switches->set(3, false);  // left over from an earlier run
  SequenceStep first = step(FixtureAction::wait, "");
  first.not_before_s = 1;
  using enum FixtureAction;
  const GuidedRenderer r =
      guided(Inner::proxy, {region("later"), guide("valve"), region("until"), region("always"), region("")},
             {first, step(lock, "later"), step(unlock, "until"), step(unlock, "later"), step(lock, "until")},
             plain(), switches);
  EXPECT_FALSE(switches->is_on(0));
  EXPECT_TRUE(switches->is_on(2) && switches->is_on(3) && switches->is_on(4));
}

TEST(GuidedRenderer, GuidanceBeginsAsTheOppositeOfItsFirstAction) {
  SequenceStep first = step(FixtureAction::wait, "");
  first.not_before_s = 1;
  using enum FixtureAction;
  const std::pair<std::vector<SequenceStep>, bool> cases[] = {
      {{}, true},
      {{first}, true},
      {{first, step(activate, "valve")}, false},
      {{first, step(release, "valve"), step(activate, "valve")}, true},
      {{first, step(activate, "valve"), step(release, "valve")}, false},
      // Waiting for a fixture is not an action on it.
      {{until_reached(step(wait, "valve"))}, true},
      {{until_reached(step(wait, "valve")), step(activate, "valve")}, false}};
  for (const auto& [steps, active] : cases) {
    GuidedRenderer r = guided(Inner::proxy, {guide("valve")}, steps);
    r.on_frame(frame({target(kLeft)}));
    EXPECT_EQ(r.step(device(kAbove), 0).guidance->active, active) << steps.size();
  }
}

// --- tasks ---

// Fixtures that all start enabled pull together, but not beyond the limits of one, which every tick has
// reached here.
TEST_P(EveryRenderer, SeveralFixturesTogetherKeepTheLimits) {
  using enum FixtureAction;
  GuidedRenderer r = guided(GetParam(), {guide("a"), guide("b"), guide("c")},
                            {step(release, "a", StepStart::button), step(release, "b", StepStart::button),
                             step(release, "c", StepStart::button)});
  r.on_frame(frame({target({0.1, 0.2, 0}), target({0, 0.2, 0.1}), target({-0.1, 0.2, 0})}));
  const GuidanceSettings limits = plain();
  for (int tick = 0; tick < 4; ++tick) {
    const std::uint32_t pressed = tick % 2;
    const RenderOutput out = r.step(device(kAbove, {2, 0, 1}, pressed), 0.001 * tick);
    EXPECT_NEAR(out.guidance->force_N.norm(), limits.max_force_N, 1e-12) << tick;
    const double torque_Nm = out.tool ? limits.max_torque_Nm : 0;
    EXPECT_NEAR(out.guidance->torque_Nm.norm(), torque_Nm, 1e-12) << tick;
  }
}

TEST(GuidedRenderer, AStepBringsItsOwnOffset) {
  using enum FixtureAction;
  SequenceStep near = until_reached(step(activate, "valve")), at = step(activate, "valve");
  near.offset_m = {0, 0, 0.02};
  GuidedRenderer r = guided(Inner::proxy, {guide("valve")}, {near, at});
  r.on_frame(frame({target(kLeft)}));
  EXPECT_EQ(r.step(device(kAbove), 0).guidance->goal_W, Vec3(kLeft + Vec3(0, 0, 0.02)));
  EXPECT_EQ(r.step(device(kLeft + Vec3(0, 0, 0.02)), 0.001).guidance->goal_W, kLeft);
}

// 2 cm is the fixture's radius; a tool has to be turned to it as well, within 5 degrees.
TEST_P(EveryRenderer, AGoalIsReachedWithinTheFixturesRadiusAndAngle) {
  struct Case {
    Vec3 place, turn;
    bool proxy, tool;
  };
  const double degree = 3.14159265358979323846 / 180;
  const Case cases[] = {{kLeft, {0, 0, 0}, true, true},
                        {kLeft + Vec3(0.0199, 0, 0), {0, 0, 0}, true, true},
                        {kLeft + Vec3(0.0201, 0, 0), {0, 0, 0}, false, false},
                        {kLeft, {0, 4.9 * degree, 0}, true, true},
                        {kLeft, {0, 5.1 * degree, 0}, true, false},
                        {kLeft, {0, -170 * degree, 0}, true, false}};
  for (const Case& c : cases) {
    GuidedRenderer r =
        guided(GetParam(), {guide("valve")}, {until_reached(step(FixtureAction::activate, "valve"))});
    EXPECT_EQ(r.step(device(kLeft), 0).guidance->sequence_step, 0) << "it is not seen";
    r.on_frame(frame({target(kLeft)}));
    EXPECT_EQ(r.step(device(kAbove), 0).guidance->sequence_step, 0);
    const RenderOutput out = r.step(device(c.place, c.turn), 0.001);
    const bool reached = GetParam() == Inner::tool ? c.tool : c.proxy;
    EXPECT_EQ(out.guidance->sequence_step, reached ? 1 : 0)
        << c.place.transpose() << ", " << c.turn.transpose();
    EXPECT_EQ(out.guidance->sequence_running, !reached);
  }
}

// The device may be at a goal behind a surface while the tool, which the robot follows, is held before it.
TEST_P(EveryRenderer, ItIsTheToolThatReachesAGoal) {
  GuidedRenderer r =
      guided(GetParam(), {guide("valve")}, {until_reached(step(FixtureAction::activate, "valve"))});
  const Vec3 behind(0, -0.03, 0);
  r.on_frame(frame({target(behind)}));
  RenderOutput out;
  for (int i = 0; i <= 300; ++i) out = r.step(device({0, std::max(-0.03, 0.03 - 3e-4 * i), 0}), 0.001 * i);
  ASSERT_GT(out.proxy_W.y(), -0.005);
  EXPECT_EQ(out.guidance->sequence_step, 0);
}

// Only a step that waits until its goal is reached has a distance to it.
TEST_P(EveryRenderer, AStepThatEndsAtOnceReportsNoDistance) {
  const SequenceStep activate = step(FixtureAction::activate, "valve");
  for (const bool waits : {false, true}) {
    GuidedRenderer r = guided(GetParam(), {guide("valve")}, {waits ? until_reached(activate) : activate});
    r.on_frame(frame({target(kAbove)}));
    const RenderOutput out = r.step(device(kAbove), 0);
    ASSERT_EQ(out.guidance->sequence_step, 1);
    EXPECT_EQ(std::isnan(out.guidance->sequence_distance_m), !waits);
    EXPECT_EQ(std::isnan(out.guidance->sequence_angle_rad), !waits);
  }
}

// --- a target that is lost, and forces that begin and end ---

// Closed form: a device that rests feels level times the spring, and the level changes by 1 ms / fade_s a
// tick.
TEST_P(EveryRenderer, TheForceRisesAndFallsEvenly) {
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
TEST_P(EveryRenderer, TheGoalIsThatOfTheActiveFixtureWhileAnotherFades) {
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
TEST_P(EveryRenderer, TheForceFallsWhenTheTargetIsLost) {
  GuidanceSettings fading = plain();
  fading.fade_s = 0.05, fading.hold_s = 0.1;
  GuidedRenderer r = guided(GetParam(), {guide("valve")}, {}, fading);
  r.on_frame(frame({target(kLeft)}, 0));
  double before_N = 0, max_change_N = 0;
  for (int ms = 0; ms <= 400; ++ms) {
    if (ms == 200) r.on_frame(frame({GuidanceTarget{}}, 6));  // arrives then
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
}  // namespace remote_touch::guided_renderer_test
