#pragma once

#include "core/geometry/vector.h"

namespace remote_touch {

// The state of a simulated hand: its intended pose, and the force and torque that it felt.
struct HandState {
  Vec3 intended_W = Vec3::Zero();
  Eigen::Quaterniond intended_orientation_W = Eigen::Quaterniond::Identity();
  Vec3 force_N = Vec3::Zero(), torque_Nm = Vec3::Zero();  // exerted by the device on the hand
};

}  // namespace remote_touch
