// Tasks played tick by tick, targets that are lost, the goal of guidance, and how it pulls.
#include "core/dissertation/virtual_fixtures/guided_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/points/vector.h"

namespace remote_touch::guidance_test {
namespace {

SequenceStep step(StepStart start, StepEnd end, int button = 0) {
  SequenceStep s;
  s.start = start, s.end = end, s.button = button;
  return s;
}

SequenceStep with_deadline(SequenceStep s, double deadline_s) {
  s.deadline_s = deadline_s;
  return s;
}

SequenceStep not_before(SequenceStep s, double time_s) {
  s.not_before_s = time_s;
  return s;
}

const SequenceStep kAtOnce = step(StepStart::previous, StepEnd::immediately);
const SequenceStep kReach = step(StepStart::previous, StepEnd::reached);

// Input of one tick, and the state expected after it.
struct Tick {
  double time_s;
  std::uint32_t buttons;  // one bit per button
  bool reached;
  int current;
  bool running;
  int missed;
  std::vector<int> begun = {};  // the steps that begin in this tick
};

void play(std::vector<SequenceStep> steps, const std::vector<Tick>& ticks) {
  FixtureSequence sequence(std::move(steps));
  for (const Tick& tick : ticks) {
    SCOPED_TRACE("at " + std::to_string(tick.time_s) + " s");
    std::vector<int> begun;
    sequence.set_buttons(tick.buttons);
    while (true) {
      if (sequence.begins(tick.time_s)) begun.push_back(sequence.current());
      if (!sequence.ends(tick.time_s, tick.reached)) break;
    }
    EXPECT_EQ(sequence.current(), tick.current);
    EXPECT_EQ(sequence.is_running(), tick.running);
    EXPECT_EQ(sequence.missed(), tick.missed);
    EXPECT_EQ(begun, tick.begun);
  }
}

TEST(FixtureSequence, IsOverIfItHasNoSteps) {
  FixtureSequence sequence({});
  EXPECT_TRUE(sequence.is_over());
  play({}, {{0, 1, true, 0, false, 0}});
}

TEST(FixtureSequence, StepsThatEndAtOnceAllRunInOneTick) {
  play({kAtOnce, kAtOnce, kAtOnce}, {{0, 0, false, 3, false, 0, {0, 1, 2}}, {0.001, 0, false, 3, false, 0}});
  play(
      {kAtOnce, kReach, kAtOnce},
      {{0, 0, false, 1, true, 0, {0, 1}}, {0.001, 0, false, 1, true, 0}, {0.002, 0, true, 3, false, 0, {2}}});
  play({kReach, kReach}, {{0, 0, true, 2, false, 0, {0, 1}}});  // done in the tick that it begins in
}

TEST(FixtureSequence, BeginsWithAPressOfItsButtonAlone) {
  play({step(StepStart::button, StepEnd::immediately, 3)}, {{0, 0, false, 0, false, 0},
                                                            {0.001, 0b0111, false, 0, false, 0},
                                                            {0.002, 0b1111, false, 1, false, 0, {0}}});
  play({step(StepStart::button, StepEnd::immediately, 31)},
       {{0, 0, false, 0, false, 0}, {0.001, 0x80000000, false, 1, false, 0, {0}}});
}

TEST(FixtureSequence, OnePressIsTakenByOneStep) {
  const SequenceStep press = step(StepStart::button, StepEnd::immediately);
  play({press, press, press}, {{0, 1, false, 1, false, 0, {0}},
                               {0.001, 1, false, 1, false, 0},  // still down
                               {0.002, 0, false, 1, false, 0},
                               {0.003, 1, false, 2, false, 0, {1}},
                               {0.004, 0, false, 2, false, 0},
                               {0.005, 1, false, 3, false, 0, {2}}});
}

TEST(FixtureSequence, OnePressDoesNotBeginAndEndAStep) {
  play({step(StepStart::button, StepEnd::button)}, {{0, 1, false, 0, true, 0, {0}},
                                                    {0.001, 1, false, 0, true, 0},
                                                    {0.002, 0, false, 0, true, 0},
                                                    {0.003, 1, false, 1, false, 0}});
}

TEST(FixtureSequence, TwoButtonsThatGoDownTogetherAreTwoPresses) {
  play({step(StepStart::button, StepEnd::immediately, 0), step(StepStart::button, StepEnd::immediately, 5)},
       {{0, 0b100001, false, 2, false, 0, {0, 1}}});
}

TEST(FixtureSequence, APressBeforeItsStepIsUpDoesNotCount) {
  play({kReach, step(StepStart::button, StepEnd::immediately)}, {{0, 0, false, 0, true, 0, {0}},
                                                                 {0.001, 1, false, 0, true, 0},
                                                                 {0.002, 1, true, 1, false, 0},  // only held
                                                                 {0.003, 0, false, 1, false, 0},
                                                                 {0.004, 1, false, 2, false, 0, {1}}});
  // A press counts if it comes in the tick that ends the previous step.
  play({kReach, step(StepStart::button, StepEnd::immediately)},
       {{0, 0, false, 0, true, 0, {0}}, {0.001, 1, true, 2, false, 0, {1}}});
}

TEST(FixtureSequence, APressBeforeTheTimeOfItsStepDoesNotCount) {
  play({not_before(step(StepStart::button, StepEnd::immediately), 0.002)},
       {{0, 0, false, 0, false, 0},
        {0.001, 1, false, 0, false, 0},
        {0.002, 1, false, 0, false, 0},
        {0.003, 0, false, 0, false, 0},
        {0.004, 1, false, 1, false, 0, {0}}});
}

TEST(FixtureSequence, BeginsAtItsTimeAndNotBefore) {
  play({not_before(kAtOnce, 0.7)}, {{0, 0, false, 0, false, 0},
                                    {0.699, 0, true, 0, false, 0},
                                    {700 / 1000.0, 0, false, 1, false, 0, {0}}});
  // A start time that has already passed does not delay a step.
  play({not_before(kReach, 0.002), not_before(kAtOnce, 0.001)},
       {{0, 0, true, 0, false, 0}, {0.002, 0, true, 2, false, 0, {0, 1}}});
}

TEST(FixtureSequence, EveryTickThatIsADeadlineMissesExactlyThen) {
  for (int begun = 0; begun < 2000; begun += 7) {
    FixtureSequence sequence({not_before(with_deadline(kReach, 0.1), begun / 1000.0)});
    int tick = 0;
    while (!sequence.is_over()) {
      sequence.set_buttons(0), sequence.begins(tick / 1000.0), sequence.ends(tick / 1000.0, false);
      ASSERT_LE(++tick, begun + 101);
    }
    EXPECT_EQ(tick - 1, begun + 100);
  }
}

TEST(FixtureSequence, ReachedAtTheDeadlineIsDone) {
  play({with_deadline(kReach, 0.5)}, {{0, 0, false, 0, true, 0, {0}}, {0.5, 0, true, 1, false, 0}});
  play({with_deadline(kReach, 0.5)}, {{0, 0, false, 0, true, 0, {0}}, {0.5, 0, false, 1, false, 1}});
  play({with_deadline(step(StepStart::previous, StepEnd::button), 0.5)},
       {{0, 0, false, 0, true, 0, {0}}, {0.5, 1, false, 1, false, 0}});
}

TEST(FixtureSequence, AMissedDeadlineBeginsTheNextStepWithItsOwnDeadline) {
  const SequenceStep s = with_deadline(kReach, 0.5);
  play({s, s, s}, {{0, 0, false, 0, true, 0, {0}},
                   {0.5, 0, false, 1, true, 1, {1}},
                   {0.999, 0, false, 1, true, 1},
                   {1.0, 0, false, 2, true, 2, {2}},
                   {1.25, 0, true, 3, false, 2}});
}

TEST(FixtureSequence, AStepWithoutADeadlineOrBeforeItsBeginningIsNotMissed) {
  play({kReach}, {{0, 0, false, 0, true, 0, {0}}, {86400, 0, false, 0, true, 0}});
  play({with_deadline(step(StepStart::button, StepEnd::reached), 0.5)},
       {{0, 0, false, 0, false, 0}, {10, 0, true, 0, false, 0}});
}

TEST(FixtureSequence, OnlyActivateAndWaitCanReachAGoal) {
  SequenceStep s = kReach;
  s.fixture = "valve";
  for (const FixtureAction action : {FixtureAction::activate, FixtureAction::wait, FixtureAction::lock}) {
    s.action = action;
    EXPECT_EQ(validate(s), action != FixtureAction::lock
                               ? ""
                               : "done = reached: expected only with action = activate or wait");
  }
}

// --- time for which a lost target is remembered; all times are exact in binary ---

constexpr std::size_t kMinPoints = 20;
constexpr double kHold_s = 0.125;

GuidanceTarget seen(std::size_t points, double x_m = 0) {
  GuidanceTarget target;
  target.points = points, target.mean_W = Vec3(x_m, 0, 0);
  return target;
}

TEST(GuidancePresence, HoldsFromTheArrivalOfTheFirstFrameWithoutIt) {
  GuidancePresence presence(kMinPoints, kHold_s, 0);
  presence.on_frame(seen(kMinPoints, 1), 0);
  EXPECT_NE(presence.target(1000), nullptr) << "seen still";
  presence.on_frame(seen(0), 2);
  presence.on_frame(seen(0), 2.0625);
  ASSERT_NE(presence.target(2 + 0.75 * kHold_s), nullptr);
  EXPECT_EQ(presence.target(2 + 0.75 * kHold_s)->mean_W.x(), 1);
  EXPECT_EQ(presence.target(2 + kHold_s), nullptr);
  presence.on_frame(seen(kMinPoints, 3), 4);
  presence.on_frame(seen(0), 5);
  ASSERT_NE(presence.target(5 + 0.75 * kHold_s), nullptr) << "and anew";
  EXPECT_EQ(presence.target(5)->mean_W.x(), 3);
}

TEST(GuidancePresence, FewerPointsLoseItAndTheLastGoodTargetIsHeld) {
  GuidancePresence presence(kMinPoints, kHold_s, 0);
  EXPECT_EQ(presence.target(0), nullptr);
  presence.on_frame(seen(kMinPoints - 1), 0);
  EXPECT_EQ(presence.target(0), nullptr) << "what never had enough points is not held";
  presence.on_frame(seen(kMinPoints, 1), 0);
  presence.on_frame(seen(kMinPoints - 1, 2), 1);
  ASSERT_NE(presence.target(1), nullptr);
  EXPECT_EQ(presence.target(1)->mean_W.x(), 1);
  EXPECT_EQ(presence.target(1 + kHold_s), nullptr);
}

// A schedule that falls to 0 says that the fixture has ended; nothing is lost.
TEST(GuidancePresence, ATargetOfStrengthZeroEndsItWithoutAHold) {
  for (const std::size_t points : {std::size_t{0}, kMinPoints}) {
    GuidancePresence presence(kMinPoints, kHold_s, 0);
    presence.on_frame(seen(kMinPoints, 1), 0);
    GuidanceTarget off = seen(points, 2);
    off.strength = 0;
    presence.on_frame(off, 1);
    EXPECT_EQ(presence.target(1), nullptr) << points;
    presence.on_frame(seen(0), 1.0625);
    EXPECT_EQ(presence.target(1.0625), nullptr) << "what was switched off is not held";
    presence.on_frame(seen(kMinPoints, 3), 2);
    ASSERT_NE(presence.target(2), nullptr);
    EXPECT_EQ(presence.target(2)->mean_W.x(), 3);
  }
}

// Ticks continue while the frame is on its way, so its time may be later than that of the tick it arrives in.
TEST(GuidancePresence, AFrameEndsItAtAnyTimeIfThereIsNoHold) {
  GuidancePresence presence(kMinPoints, 0, 0);
  presence.on_frame(seen(kMinPoints), 0);
  presence.on_frame(seen(0), 1);
  for (const double time_s : {0.5, 1.0, 1.5}) EXPECT_EQ(presence.target(time_s), nullptr) << time_s;
}

// --- goal ---

constexpr double kDegree = 3.14159265358979323846 / 180;

GuidanceTarget target(const Vec3& mean_W, const Vec3& normal_W = Vec3::Zero()) {
  return {100, mean_W, normal_W};
}

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

GuidanceSettings against_the_plane() {
  GuidanceSettings s;
  s.orientation = GuidedOrientation::plane;
  s.rotation_deg = {10, -50, 120};
  s.approach_axis = {0.2, 0.3, -0.9};
  return s;
}

TEST(GuidanceGoal, FixedLiesBeforeTheTargetAgainstTheTurnedAxis) {
  GuidanceSettings s;
  s.rotation_deg = {0, 0, 90}, s.approach_axis = {0.5, 0, 0};  // turned to y
  s.standoff_m = 0.1, s.offset_m = {0, 0, 0.01};
  const auto goal = guidance_goal(s, target({1, 2, 3}, {0, 0, 1}), {0.02, 0, 0});
  ASSERT_TRUE(goal);
  EXPECT_LT((goal->p_W - Vec3(1.02, 1.9, 3.01)).norm(), 1e-15);
  EXPECT_LT((goal->q_WT * Vec3::UnitX() - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((goal->q_WT * Vec3::UnitZ() - Vec3::UnitZ()).norm(), 1e-15);
}

TEST(GuidanceGoal, AgainstAPlaneTheAxisPointsAtItByTheShortestWay) {
  std::mt19937 random(1);
  const GuidanceSettings s = against_the_plane();
  const Vec3 axis = s.approach_axis.normalized();
  GuidanceSettings plain = s;
  plain.orientation = GuidedOrientation::fixed;
  const Eigen::Quaterniond fixed = guidance_goal(plain, target({0, 0, 0}))->q_WT;
  for (int i = 0; i < 200; ++i) {
    const Vec3 normal = direction(random), mean(0.1 * i, 1, -2);
    const auto goal = guidance_goal(s, target(mean, normal));
    EXPECT_LT((goal->q_WT * axis + normal).norm(), 1e-12);
    EXPECT_LT((goal->p_W - (mean + s.standoff_m * normal)).norm(), 1e-13);
    EXPECT_NEAR(goal->q_WT.norm(), 1, 1e-15);
    // No turn is shorter than the angle between where the axis was and where it goes.
    const double angle = std::acos(std::clamp((fixed * axis).dot(-normal), -1.0, 1.0));
    EXPECT_NEAR(fixed.angularDistance(goal->q_WT), angle, 1e-7);
  }
}

// The plane faces away: the goal is half a turn, about any axis. Close to that case the goal is still a
// rotation.
TEST(GuidanceGoal, TheAxisTurnsToAPlaneBehind) {
  std::mt19937 random(2);
  for (const double aside : {0.0, 1e-16, 1e-12, 1e-9, 1e-7, 1e-5, 4.4e-5, 4.6e-5, 1e-4, 1e-2}) {
    for (int i = 0; i < 20; ++i) {
      GuidanceSettings s = against_the_plane();
      s.rotation_deg.setZero(), s.approach_axis = i < 3 ? Vec3(Vec3::Unit(i)) : direction(random);
      const Vec3 axis = s.approach_axis.normalized();
      const Vec3 normal = (axis + aside * axis.cross(direction(random)).normalized()).normalized();
      const auto goal = guidance_goal(s, target({1, 2, 3}, normal));
      EXPECT_NEAR(goal->q_WT.norm(), 1, 1e-15) << aside;
      EXPECT_LT((goal->q_WT * axis + normal).norm(), 5e-5) << aside;
      EXPECT_NEAR(goal->q_WT.w(), 0, 1e-2) << aside;
      EXPECT_LT((goal->p_W - (Vec3(1, 2, 3) + s.standoff_m * normal)).norm(), 1e-14) << aside;
    }
  }
}

TEST(GuidanceGoal, HasTheFixedOrientationIfThereIsNoPlaneAndNeedsEnoughPoints) {
  GuidanceSettings s = against_the_plane();
  s.min_points = 7;
  GuidanceTarget seen = target({1, 2, 3});
  seen.points = 6;
  EXPECT_FALSE(guidance_goal(s, seen));
  seen.points = 7;
  const auto goal = guidance_goal(s, seen);
  s.orientation = GuidedOrientation::fixed;
  const auto fixed = guidance_goal(s, target({1, 2, 3}, {0, 1, 0}));
  EXPECT_EQ(goal->p_W, fixed->p_W);
  EXPECT_EQ(goal->q_WT.coeffs(), fixed->q_WT.coeffs());
  EXPECT_FALSE(guidance_goal({}, {}));
}

TEST(GuidanceGoal, AnAxisWithoutLengthIsRefused) {
  GuidanceSettings s;
  EXPECT_EQ(validate(s), "");
  s.approach_axis = {5e-4, 0, 0};
  EXPECT_EQ(validate(s), "approach_axis: expected a vector of length 0.001 or more");
}

// --- wrench ---

// The spring is that of the coupling: rigid_tool_test.cpp derives its wrench from its energy.
TEST(GuidanceWrench, PullsTowardsTheGoalWithTheStiffnessOfTheFixtureOrOfTheSettings) {
  GuidanceSettings s;
  s.max_force_N = s.max_torque_Nm = 1e9;
  const ToolPose goal{{0.1, 0, 0}, rotation({0, 0.2, 0})};
  for (const auto& [own, stiffness] : {std::pair(-1.0, 200.0), {50.0, 50.0}, {0.0, 0.0}}) {
    const Wrench wrench = guidance_wrench(s, own, goal, {});
    EXPECT_LT((wrench.force_N - stiffness * Vec3(0.1, 0, 0)).norm(), 1e-12) << own;
    EXPECT_LT((wrench.torque_Nm - Vec3(0, 0.2 * stiffness * 9e-4, 0)).norm(), 1e-12) << own;
    const Wrench there = guidance_wrench(s, own, goal, goal);
    EXPECT_EQ(there.force_N, Vec3::Zero());
    EXPECT_LT(there.torque_Nm.norm(), 1e-14);
  }
}

TEST(GuidanceWrench, IsCutToItsLargestLengths) {
  GuidanceSettings s;
  s.max_force_N = 3, s.max_torque_Nm = 0.1;
  const ToolPose goal{{1, 2, 0}, rotation({0, 0, 150 * kDegree})};
  const Wrench wrench = guidance_wrench(s, -1, goal, {});
  EXPECT_LT((wrench.force_N - 3 * Vec3(1, 2, 0).normalized()).norm(), 1e-12);
  EXPECT_LT((wrench.torque_Nm - Vec3(0, 0, 0.1)).norm(), 1e-12);
  s.max_force_N = s.max_torque_Nm = 0;
  EXPECT_EQ(guidance_wrench(s, -1, goal, {}).force_N, Vec3::Zero());
  EXPECT_EQ(guidance_wrench(s, -1, goal, {}).torque_Nm, Vec3::Zero());
}

}  // namespace
}  // namespace remote_touch::guidance_test
