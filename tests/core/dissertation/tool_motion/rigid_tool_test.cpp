#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/tool_parameters.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace remote_touch::tool_pose_test {
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

// Rotation into the tool's axes and back keeps lengths, so a bound of the displacement holds in either frame.
TEST(ToolPose, ATurnedDisplacementIsTheSameInOtherAxes) {
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Quaterniond q = rotation(draw(random, 3));
    Vector6 a_g;
    a_g << draw(random, 0.1), draw(random, 1);
    const Vector6 other = rotated(q, a_g);
    EXPECT_LT((other.head<3>() - q.toRotationMatrix() * a_g.head<3>()).norm(), 1e-15);
    EXPECT_LT((other.tail<3>() - q.toRotationMatrix() * a_g.tail<3>()).norm(), 1e-14);
    EXPECT_LT((rotated(q.conjugate(), other) - a_g).norm(), 1e-14);
    EXPECT_NEAR(max_point_displacement_m(other, 0.05), max_point_displacement_m(a_g, 0.05), 1e-15);
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

}  // namespace
}  // namespace remote_touch::tool_pose_test

namespace remote_touch::wrench_coupling_test {
namespace {

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
double relative_loop_work(const ToolParameters& p, const ToolPose& tool, int steps) {
  return relative_loop_work(p, tool, steps, [&](const ToolPose& at, const ToolPose& device) {
    return wrench_of(p, uneven_inertia(), at, device);
  });
}

TEST(WrenchCoupling, PullsTheHandTowardsTheTool) {
  const ToolParameters p = without_limits();
  const Wrench w = wrench_of(p, uneven_inertia(), {}, {{0.001, 0, 0}, rotation({0, 0.1, 0})});
  EXPECT_LT((w.force_N - Vec3(-0.6, 0, 0)).norm(), 1e-12);
  EXPECT_LT((w.torque_Nm - Vec3(0, -0.1 * 600 * 9e-4, 0)).norm(), 1e-12);
}

void expect_the_derivative_of_the_energy(const ToolParameters& p) {
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

TEST(WrenchCoupling, IsMinusTheDerivativeOfTheEnergy) {
  expect_the_derivative_of_the_energy(without_limits());
}

TEST(WrenchCoupling, IsMinusTheDerivativeOfTheEnergyForADiagonalK) {
  expect_the_derivative_of_the_energy(with_uneven_K());
}

TEST(WrenchCoupling, HasAnotherStiffnessAlongAndAboutEachAxisOfTheWorld) {
  const ToolParameters p = with_uneven_K();
  // The tool is turned: the axes are the world's, not its own.
  const ToolPose tool{Vec3::Zero(), rotation({0, 0, 1})};
  for (int axis = 0; axis < 3; ++axis) {
    const ToolPose device{0.001 * Vec3::Unit(axis), rotation(0.01 * Vec3::Unit(axis)) * tool.q_WT};
    const Wrench w = wrench_of(p, uneven_inertia(), tool, device);
    EXPECT_LT((w.force_N + 600 * p.stiffness_ratio[axis] * 0.001 * Vec3::Unit(axis)).norm(), 1e-12);
    const double torque_Nm = 600 * 9e-4 * p.rotational_stiffness_ratio[axis] * 0.01;
    EXPECT_LT((w.torque_Nm + torque_Nm * Vec3::Unit(axis)).norm(), 1e-12);
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

TEST(WrenchCoupling, DoesNoWorkAroundAClosedLoop) {
  const ToolPose tool{{0.002, 0, -0.01}, rotation({0.2, -0.4, 0.3})};
  EXPECT_LT(std::abs(relative_loop_work(without_limits(), tool, 4000)), 1e-9);
  EXPECT_LT(std::abs(relative_loop_work(with_uneven_K(), tool, 4000)), 1e-9);
}

// If K is the same about all axes, J^-T phi = phi and the Jacobian has no effect. The torque of a diagonal K
// derives from an energy only with the Jacobian.
TEST(WrenchCoupling, ADiagonalKDoesWorkIfTheJacobianIsLeftOut) {
  const ToolPose tool{{0.002, 0, -0.01}, rotation({0.2, -0.4, 0.3})};
  const auto without_jacobian = [](const ToolParameters& p) {
    return [&p](const ToolPose& at, const ToolPose& device) {
      Wrench w = wrench_of(p, uneven_inertia(), at, device);
      const double rotational = p.stiffness_N_per_m * std::pow(p.gyration_radius_m, 2);
      const Vec3 phi = displacement(at, device).tail<3>();
      w.torque_Nm = -rotational * p.rotational_stiffness_ratio.cwiseProduct(phi);
      return w;
    };
  };
  const ToolParameters even = without_limits(), uneven = with_uneven_K();
  EXPECT_LT(std::abs(relative_loop_work(even, tool, 4000, without_jacobian(even))), 1e-9);
  EXPECT_GT(std::abs(relative_loop_work(uneven, tool, 400, without_jacobian(uneven))), 0.01);
}

// The printed torque of an uneven inertia derives from no energy: the loop does work of more than 1 % of the
// peak energy.
TEST(WrenchCoupling, ThePrintedTorqueDoesWork) {
  ToolParameters p = without_limits();
  p.torque_rule = TorqueRule::printed;
  const ToolPose tool{{0.002, 0, -0.01}, rotation({0.2, -0.4, 0.3})};
  EXPECT_GT(std::abs(relative_loop_work(p, tool, 400)), 0.01);
}

TEST(WrenchCoupling, IsCutToItsLimits) {
  ToolParameters p;
  p.max_force_N = 3, p.max_torque_Nm = 0.1;
  const Wrench w = wrench_of(p, uneven_inertia(), {}, {{1, 2, 0}, rotation({0, 0, 3})});
  EXPECT_NEAR(w.force_N.norm(), 3, 1e-12);
  EXPECT_NEAR(w.torque_Nm.norm(), 0.1, 1e-12);
  EXPECT_LT(w.force_N.normalized().dot(Vec3(1, 2, 0).normalized()), -1 + 1e-12);
}

}  // namespace
}  // namespace remote_touch::wrench_coupling_test
