#include "core/tool/dynamics/wrench_coupling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

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

// Potential of the spring, 6.2.6 with K = k I.
double energy(const ToolParameters& p, const ToolPose& tool, const ToolPose& device) {
  const Vector6 a = displacement(tool, device);
  return 0.5 * p.stiffness_N_per_m *
         (a.head<3>().squaredNorm() + std::pow(p.gyration_radius_m, 2) * a.tail<3>().squaredNorm());
}

// A loop of the device, s from 0 to 1, that returns to where it began.
ToolPose on_loop(double s) {
  const double w = 2 * M_PI * s;
  return {{0.01 * std::cos(w), 0.02 * std::sin(2 * w), 0.01 * std::sin(w)},
          rotation({0.6 * std::sin(w), 0.8 * std::cos(w) - 0.3, 0.5 * std::sin(2 * w)})};
}

Wrench wrench_of(const ToolParameters& p, const Eigen::Matrix3d& inertia_m2, const ToolPose& tool,
                 const ToolPose& device) {
  return coupling_wrench(coupling_of(p, p.stiffness_N_per_m), inertia_m2, tool, device);
}

// Work of the wrench on the hand around the loop, relative to the largest energy on it. Gauss quadrature of
// two nodes on every step, with the device's twist by central differences in the group.
double relative_loop_work(const ToolParameters& p, const ToolPose& tool, int steps) {
  double work = 0, peak = 0;
  for (int i = 0; i < steps; ++i) {
    for (const double node : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)}) {
      const double s = (i + node) / steps, h = 1e-4;
      const auto difference = [&](double d) {
        return Vector6(displacement(on_loop(s - d), on_loop(s + d)) / (2 * d));
      };
      const Vector6 twist = (4 * difference(h / 2) - difference(h)) / 3;
      const Wrench w = wrench_of(p, uneven_inertia(), tool, on_loop(s));
      work += 0.5 / steps * (w.force_N.dot(twist.head<3>()) + w.torque_Nm.dot(twist.tail<3>()));
      peak = std::max(peak, energy(p, tool, on_loop(s)));
    }
  }
  return work / peak;
}

TEST(WrenchCoupling, PullsTheHandTowardsTheTool) {
  const ToolParameters p = without_limits();
  const Wrench w = wrench_of(p, uneven_inertia(), {}, {{0.001, 0, 0}, rotation({0, 0.1, 0})});
  EXPECT_LT((w.force_N - Vec3(-0.6, 0, 0)).norm(), 1e-12);
  EXPECT_LT((w.torque_Nm - Vec3(0, -0.1 * 600 * 9e-4, 0)).norm(), 1e-12);
}

TEST(WrenchCoupling, TorqueIsMinusTheDerivativeOfTheEnergy) {
  const ToolParameters p = without_limits();
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
}

// As printed the torque of an uneven inertia has no energy: the loop gains or loses a good part of the peak.
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
