#include "core/dissertation/tool_motion/motion_program.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/box_tool.h"

namespace remote_touch::motion_program_test {
namespace {

const auto kTool = scenes::box_tool({0.02, 0.005, 0.01});

Vector6 desired(const Vec3& a, const Vec3& alpha = Vec3::Zero()) {
  Vector6 both;
  both << a, alpha;
  return both;
}

double gap_speed(const ToolContact& c, const Vector6& a_g) {  // the left side of (6.3)
  return c.n_T.dot(a_g.head<3>()) + c.r_T.cross(c.n_T).dot(a_g.tail<3>());
}

TEST(MotionProgram, GrantsTheDesiredMotionIfThereAreNoContacts) {
  MotionProgram program({}, *kTool);
  const Vector6 wanted = desired({1e-3, -2e-3, 5e-4}, {0.01, 0, -0.02});
  const ConstrainedMotion motion = program.solve(wanted, {});
  EXPECT_LT((motion.a_g - wanted).norm(), 1e-15);
  EXPECT_EQ(motion.active_count, 0);
}

// A contact below the centre stops the downward motion and leaves the rest of the motion.
TEST(MotionProgram, ACentralContactTakesOnlyTheFall) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{0, -0.005, 0}, Vec3::UnitY(), 0, 1}};
  const ConstrainedMotion motion = program.solve(desired({1e-3, -2e-3, 0}), contacts);
  EXPECT_LT((motion.a_g - desired({1e-3, 0, 0})).norm(), 1e-12);
  EXPECT_EQ(motion.active_count, 1);
  EXPECT_NEAR(motion.push_T.y(), 2e-3, 1e-12);
  EXPECT_GT(motion.side, 0);
}

// The tool tips over an off-centre point: Gauss' principle by hand. The row is (n, r x n), M = diag(1, I),
// and a = wish + M^-1 row^T lambda, lambda = -row.wish / (row M^-1 row^T).
TEST(MotionProgram, AnOffCentreContactTipsTheTool) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{0.02, -0.005, 0}, Vec3::UnitY(), 0, 1}};
  const Vec3 lever = contacts[0].r_T.cross(contacts[0].n_T);
  const Vec3 rotated = kTool->inertia_m2.inverse() * lever;
  const double lambda = 2e-3 / (1 + lever.dot(rotated));
  const ConstrainedMotion motion = program.solve(desired({0, -2e-3, 0}), contacts);
  EXPECT_LT((motion.a_g - desired({0, -2e-3 + lambda, 0}, lambda * rotated)).norm(), 1e-12);
  EXPECT_NEAR(gap_speed(contacts[0], motion.a_g), 0, 1e-14);
}

TEST(MotionProgram, PenetrationIsResolvedByItsDepth) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{-0.02, -0.005, 0}, Vec3::UnitY(), 3e-4, 1},
                                             {{0.02, -0.005, 0}, Vec3::UnitY(), 3e-4, 1},
                                             {{0, 0.005, 0}, -Vec3::UnitY(), -1e-3, 1}};
  const ConstrainedMotion motion = program.solve(Vector6::Zero(), contacts);
  EXPECT_LT((motion.a_g - desired({0, 3e-4, 0})).norm(), 1e-12);
  EXPECT_FALSE(motion.is_relaxed);
}

// Two walls close in by 0.4 mm each. No motion resolves both, so each is loosened by as much, and the tool
// still follows the device along the wedge.
TEST(MotionProgram, AWedgeIsLoosenedAndTheToolFollowsAlongIt) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{0.02, -0.005, 0}, Vec3::UnitY(), 4e-4, 1},
                                             {{-0.02, -0.005, 0}, Vec3::UnitY(), 4e-4, 1},
                                             {{0.02, 0.005, 0}, -Vec3::UnitY(), 4e-4, 1},
                                             {{-0.02, 0.005, 0}, -Vec3::UnitY(), 4e-4, 1}};
  const ConstrainedMotion motion = program.solve(desired({1e-3, -2e-3, 5e-4}), contacts);
  EXPECT_TRUE(motion.is_relaxed);
  EXPECT_FALSE(motion.failed);
  EXPECT_NEAR(motion.a_g[0], 1e-3, 1e-9);
  EXPECT_NEAR(motion.a_g[2], 5e-4, 1e-9);
  EXPECT_NEAR(motion.a_g[1], 0, 1e-6);
}

// A desired motion too long for the program has no result.
TEST(MotionProgram, AProgramWithoutAResultHasFailedAndMovesNothing) {
  MotionProgram program({}, *kTool);
  const std::vector<ToolContact> contacts = {{{0, -0.005, 0}, Vec3::UnitY(), 0, 1}};
  const ConstrainedMotion motion = program.solve(desired({0, -1e200, 0}), contacts);
  EXPECT_TRUE(motion.failed);
  EXPECT_TRUE(motion.a_g.isZero(0));
  EXPECT_FALSE(program.solve(desired({0, -2e-3, 0}), contacts).failed);
}

TEST(MotionProgram, NanContactsAreLeftOut) {
  MotionProgram program({}, *kTool);
  std::vector<ToolContact> contacts = {{{0, -0.005, 0}, Vec3::Constant(std::nan("")), 0, 1},
                                       {{0, -0.005, 0}, Vec3::UnitY(), std::nan(""), 1},
                                       {{0, -0.005, 0}, Vec3::UnitY(), 0, 1}};
  const ConstrainedMotion motion = program.solve(desired({1e-3, -2e-3, 0}), contacts);
  EXPECT_LT((motion.a_g - desired({1e-3, 0, 0})).norm(), 1e-12);
  EXPECT_NEAR(motion.push_T.y(), 2e-3, 1e-12);  // the multiplier belongs to the last of the three
}

// The coupling turns the blocked part of the desired motion into a wrench. A single contact can exert this
// wrench: a force f n and the torque f r x n. It cannot if the metric is the inertia of the tool.
TEST(MotionProgram, CouplingWrenchOnACornerIsThatOfTheContact) {
  const std::vector<ToolContact> contacts = {{{0.02, -0.005, 0.004}, Vec3(0.1, 1, 0.2).normalized(), 0, 1}};
  const Vector6 wish = desired({1e-4, -2e-3, 0}, {0.01, 0, -0.02});
  const auto torque_error = [&](MotionMetric metric) {
    ToolParameters p;
    p.motion_metric = metric;
    MotionProgram program(p, *kTool);
    const Vector6 left = program.solve(wish, contacts).a_g - wish;
    const double squared_m2 = p.gyration_radius_m * p.gyration_radius_m,
                 force = left.head<3>().dot(contacts[0].n_T);
    const Vec3 of_contact = force * contacts[0].r_T.cross(contacts[0].n_T);
    EXPECT_GT(force, 1e-4);
    EXPECT_LT((left.head<3>() - force * contacts[0].n_T).norm(), 1e-12);
    return (squared_m2 * left.tail<3>() - of_contact).norm() / of_contact.norm();
  };
  EXPECT_LT(torque_error(MotionMetric::coupling), 1e-9);
  EXPECT_GT(torque_error(MotionMetric::tool), 0.5);
}

}  // namespace
}  // namespace remote_touch::motion_program_test
