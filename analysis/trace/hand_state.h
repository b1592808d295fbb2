#pragma once

#include <optional>

#include "core/geometry/vector.h"

namespace remote_touch {

// The state of a simulated hand: its intended pose, and the force and torque that it felt.
struct HandState {
  struct Pose {
    Vec3 position_W = Vec3::Zero();
    Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  };
  Vec3 intended_W = Vec3::Zero();
  Eigen::Quaterniond intended_orientation_W = Eigen::Quaterniond::Identity();
  Vec3 force_N = Vec3::Zero(), torque_Nm = Vec3::Zero();  // exerted by the device on the hand
  // The pose of the hand. Present if the device rounds it; otherwise it is the pose that the device measures.
  std::optional<Pose> true_pose = {};
};

}  // namespace remote_touch
