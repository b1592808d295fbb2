// Poses of a rigid tool, the wrench of its coupling, and the motions that contacts allow it: small cases
// worked out by hand.
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/tool_parameters.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "core/dissertation/tool_motion/motion_program.h"
#include "tests/support/box_tool.h"

namespace remote_touch::rigid_tool_test {
namespace {

Vec3 draw(std::mt19937& random, double half_width) {
  std::uniform_real_distribution<double> along(-half_width, half_width);
  const double x = along(random), y = along(random), z = along(random);
  return {x, y, z};
}

TEST(ToolPose, TheExponentialIsTheRotationOfTheVector) {
  const Vec3 rotated = rotation({0, 0, 0.5 * M_PI}) * Vec3::UnitX();
  EXPECT_LT((rotated - Vec3::UnitY()).norm(), 1e-15);
}

// displacement() leads from one pose to the other, with the shorter rotation.
TEST(ToolPose, MovingByTheDisplacementReachesTheTarget) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const ToolPose from{draw(random, 1), rotation(draw(random, 3))},
        to{draw(random, 1), rotation(draw(random, 3))};
    const Vector6 a_gu = displacement(from, to);
    EXPECT_LE(a_gu.tail<3>().norm(), M_PI + 1e-12);
    const ToolPose there = moved(from, a_gu);
    EXPECT_LT((there.p_W - to.p_W).norm(), 1e-14);
    EXPECT_GT(std::abs(there.q_WT.dot(to.q_WT)), 1 - 1e-14);
  }
}

// No point of the tool moves farther than max_point_displacement_m() returns.
TEST(ToolPose, TheWayBoundsTheWayOfEveryPoint) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const ToolPose pose{draw(random, 1), rotation(draw(random, 3))};
    Vector6 a_g;
    a_g << draw(random, 0.1), draw(random, 1);
    const Vec3 p_T = 0.05 * draw(random, 1).normalized();
    const ToolPose there = moved(pose, a_g);
    const double went = (there.p_W + there.q_WT * p_T - pose.p_W - pose.q_WT * p_T).norm();
    EXPECT_LE(went, max_point_displacement_m(a_g, 0.05) + 1e-14);
    const Vector6 shorter = capped(a_g, 0.05, 0.001);
    EXPECT_LE(max_point_displacement_m(shorter, 0.05), 0.001 * (1 + 1e-12));
    EXPECT_LT((shorter.normalized() - a_g.normalized()).norm(), 1e-12);
  }
  const Vector6 small = Vector6::Constant(1e-6);
  EXPECT_EQ(capped(small, 0.05, 0.001), small);
}

// --- the wrench of the coupling ---

Eigen::Matrix3d uneven_inertia() {
  return Vec3(1e-4, 9e-4, 4e-4).asDiagonal();
}

ToolParameters without_limits() {
  ToolParameters p;
  p.max_force_N = 1000, p.max_torque_Nm = 100;
  return p;
}

// K with a different stiffness along and about each axis.
ToolParameters with_uneven_K() {
  ToolParameters p = without_limits();
  p.stiffness_ratio = {0.5, 1, 2}, p.rotational_stiffness_ratio = {0.3, 1, 2.5};
  return p;
}

// Potential of the spring, 6.2.6 with a diagonal K.
double energy(const ToolParameters& p, const ToolPose& tool, const ToolPose& device) {
  const Vector6 a = displacement(tool, device);
  const Vec3 u = a.head<3>(), phi = a.tail<3>();
  return 0.5 * p.stiffness_N_per_m *
         (u.dot(p.stiffness_ratio.cwiseProduct(u)) +
          std::pow(p.gyration_radius_m, 2) * phi.dot(p.rotational_stiffness_ratio.cwiseProduct(phi)));
}

// Device pose on a closed loop, s from 0 to 1.
ToolPose on_loop(double s) {
  const double w = 2 * M_PI * s;
  return {{0.01 * std::cos(w), 0.02 * std::sin(2 * w), 0.01 * std::sin(w)},
          rotation({0.6 * std::sin(w), 0.8 * std::cos(w) - 0.3, 0.5 * std::sin(2 * w)})};
}

Wrench wrench_of(const ToolParameters& p, const Eigen::Matrix3d& inertia_m2, const ToolPose& tool,
                 const ToolPose& device) {
  return coupling_wrench(coupling_of(p, p.stiffness_N_per_m), inertia_m2, tool, device);
}

// Work of a wrench on the hand around the loop, relative to the largest energy on it. Gauss quadrature of
// two nodes on every step, with the device's twist by central differences in the group.
using WrenchOf = std::function<Wrench(const ToolPose& tool, const ToolPose& device)>;
double relative_loop_work(const ToolParameters& p, const ToolPose& tool, int steps, const WrenchOf& wrench) {
  double work = 0, peak = 0;
  for (int i = 0; i < steps; ++i) {
    for (const double node : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)}) {
      const double s = (i + node) / steps, h = 1e-4;
      const auto difference = [&](double d) {
        return Vector6(displacement(on_loop(s - d), on_loop(s + d)) / (2 * d));
      };
      const Vector6 twist = (4 * difference(h / 2) - difference(h)) / 3;
      const Wrench w = wrench(tool, on_loop(s));
      work += 0.5 / steps * (w.force_N.dot(twist.head<3>()) + w.torque_Nm.dot(twist.tail<3>()));
      peak = std::max(peak, energy(p, tool, on_loop(s)));
    }
  }
  return work / peak;
}

TEST(WrenchCoupling, IsMinusTheDerivativeOfTheEnergyAlsoForADiagonalK) {
  for (const ToolParameters& p : {without_limits(), with_uneven_K()}) {
    const ToolPose tool{{0.01, 0, 0}, rotation({0.2, -0.4, 0.9})};
    for (int i = 0; i < 20; ++i) {
      const ToolPose device = on_loop(i / 20.0);
      const Wrench w = wrench_of(p, uneven_inertia(), tool, device);
      for (int axis = 0; axis < 6; ++axis) {
        Vector6 nudge = Vector6::Zero();
        nudge[axis] = 1e-6;
        const double slope =
            (energy(p, tool, moved(device, nudge)) - energy(p, tool, moved(device, -nudge))) / 2e-6;
        EXPECT_NEAR(axis < 3 ? w.force_N[axis] : w.torque_Nm[axis - 3], -slope, 1e-7);
      }
    }
  }
}

TEST(WrenchCoupling, JacobianIsThatOfTheLogarithm) {
  const Vec3 phi(0.7, -1.1, 0.4);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 nudge = 1e-6 * Vec3::Unit(axis);
    const Vec3 slope = (rotation_vector(rotation(nudge) * rotation(phi)) -
                        rotation_vector(rotation(-nudge) * rotation(phi))) /
                       2e-6;
    EXPECT_LT((inverse_left_jacobian(phi).col(axis) - slope).norm(), 1e-9);
  }
  // both sides of the switch to the series
  EXPECT_LT((inverse_left_jacobian({0.99e-4, 0, 0}) - inverse_left_jacobian({1.01e-4, 0, 0})).norm(), 1e-5);
}

// If K is the same about all axes, J^-T phi = phi and the Jacobian has no effect. The torque of a diagonal K
// derives from an energy only with the Jacobian. The printed torque of an uneven inertia derives from none:
// the loop does work of more than 1 % of the peak energy.
TEST(WrenchCoupling, DoesNoWorkAroundAClosedLoopUnlikeThePrintedTorque) {
  const ToolPose tool{{0.002, 0, -0.01}, rotation({0.2, -0.4, 0.3})};
  const ToolParameters even = without_limits(), uneven = with_uneven_K();
  ToolParameters printed = without_limits();
  printed.torque_rule = TorqueRule::printed;
  const auto work = [&](const ToolParameters& p, int steps, bool has_jacobian) {
    return std::abs(relative_loop_work(p, tool, steps, [&](const ToolPose& at, const ToolPose& device) {
      Wrench w = wrench_of(p, uneven_inertia(), at, device);
      const double rotational = p.stiffness_N_per_m * std::pow(p.gyration_radius_m, 2);
      const Vec3 phi = displacement(at, device).tail<3>();
      if (!has_jacobian) w.torque_Nm = -rotational * p.rotational_stiffness_ratio.cwiseProduct(phi);
      return w;
    }));
  };
  for (const ToolParameters& p : {even, uneven}) EXPECT_LT(work(p, 4000, true), 1e-9);
  EXPECT_LT(work(even, 4000, false), 1e-9);
  EXPECT_GT(work(uneven, 400, false), 0.01);
  EXPECT_GT(work(printed, 400, true), 0.01);
}

TEST(WrenchCoupling, IsCutToItsLimits) {
  ToolParameters p;
  p.max_force_N = 3, p.max_torque_Nm = 0.1;
  const Wrench w = wrench_of(p, uneven_inertia(), {}, {{1, 2, 0}, rotation({0, 0, 3})});
  EXPECT_NEAR(w.force_N.norm(), 3, 1e-12);
  EXPECT_NEAR(w.torque_Nm.norm(), 0.1, 1e-12);
  EXPECT_LT(w.force_N.normalized().dot(Vec3(1, 2, 0).normalized()), -1 + 1e-12);
}

// --- the motions that contacts allow ---

const auto kTool = scenes::box_tool({0.02, 0.005, 0.01});

Vector6 desired(const Vec3& a, const Vec3& alpha = Vec3::Zero()) {
  Vector6 both;
  both << a, alpha;
  return both;
}

double gap_speed(const ToolContact& c, const Vector6& a_g) {  // the left side of (6.3)
  return c.n_T.dot(a_g.head<3>()) + c.r_T.cross(c.n_T).dot(a_g.tail<3>());
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
}  // namespace remote_touch::rigid_tool_test
