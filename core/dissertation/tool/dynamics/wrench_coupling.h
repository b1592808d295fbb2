// Force and torque between tool and device, 6.2.6.
#pragma once

#include "core/dissertation/tool/dynamics/tool_parameters.h"
#include "core/dissertation/tool/dynamics/tool_pose.h"
#include "core/rendering/wrench.h"

namespace remote_touch {

// A spring between two poses.
struct WrenchSpring {
  double stiffness_N_per_m = 0;
  double gyration_radius_m = 0;  // rotational stiffness = stiffness times this squared
  double max_force_N = 0, max_torque_Nm = 0;
  TorqueRule torque_rule = TorqueRule::inverse_jacobian;
  Vec3 ratio{1, 1, 1}, rotational_ratio{1, 1, 1};  // stiffness factors along and about x, y, z of the world
};

// The coupling (6.9) between tool and device, with this stiffness.
inline WrenchSpring coupling_of(const ToolParameters& p, double stiffness_N_per_m) {
  return {stiffness_N_per_m, p.gyration_radius_m,         p.max_force_N, p.max_torque_Nm, p.torque_rule,
          p.stiffness_ratio, p.rotational_stiffness_ratio};
}

// The inverse left Jacobian J^-1 of a rotation vector phi: R(phi') = exp(delta) R(phi) gives phi' - phi =
// J^-1 delta. Its transpose takes the derivative of an energy by phi to a torque. pre: |phi| < 2 pi.
Eigen::Matrix3d inverse_left_jacobian(const Vec3& phi);

// (6.9), f = K M a_gu: a spring that pulls the hand from the device's pose towards the tool's. K is diagonal
// in world axes: k A along them, k r^2 B about them, r the gyration radius, A and B the diagonal matrices of
// the ratios. With p from tool to device and phi = log(R_device R_tool^T) the spring has the energy
// k p.A p / 2 + k r^2 phi.B phi / 2, and its torque on the hand is - J^-T k r^2 B phi; J^-T changes nothing
// while B = I. As printed the torque is - k B I_W phi, I_W the inertia for 1 kg in world axes, which derives
// from no energy. Force and torque are limited to max_force_N and max_torque_Nm.
Wrench coupling_wrench(const WrenchSpring& spring, const Eigen::Matrix3d& inertia_m2, const ToolPose& tool,
                       const ToolPose& device);

}  // namespace remote_touch
