// Force and torque between tool and device, 6.2.6.
#pragma once

#include "core/tool/tool_parameters.h"
#include "core/tool/tool_pose.h"

namespace remote_touch {

// On the hand, about the device, world frame.
struct Wrench {
  Vec3 force_N = Vec3::Zero();
  Vec3 torque_Nm = Vec3::Zero();
};

// The transpose of the inverse left Jacobian of a turn phi, which takes the derivative of an energy by phi to
// a torque: with R(phi') = exp(delta) R(phi), phi' - phi = J^-1 delta. pre: shorter than 2 pi.
Eigen::Matrix3d inverse_left_jacobian(const Vec3& phi);

// (6.9), f = K M a_gu: a spring from the device to the tool, so that the hand is pulled towards the tool. By
// default it has the energy k |p|^2 / 2 + k r^2 |phi|^2 / 2, r the gyration radius and phi = log(R_device
// R_tool^T); as printed the torque is k I_W phi, I_W the inertia of the turned tool for 1 kg, which has no
// energy. Both are cut to their largest length.
Wrench coupling_wrench(const ToolParameters& parameters, const Eigen::Matrix3d& inertia_m2,
                       const ToolPose& tool, const ToolPose& device);

}  // namespace remote_touch
