// The states of the hand and of the slave in a tick, as a trace keeps them.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "core/points/vector.h"

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

// The orientation and the contact of a slave's tool, world frame.
struct SlaveToolState {
  Eigen::Quaterniond orientation_W{Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN())};
  // Mean torque of the scene about the centre of mass in the last tick.
  Vec3 torque_Nm = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
};

// Energies of the channel between hand and slave since the start of a run, J. None of them falls. in - out of
// both ends is the energy in the channel; it is negative if the channel has given more than it received.
struct ChannelEnergy {
  double hand_in_J = 0, hand_out_J = 0;    // entered and left at the hand
  double slave_in_J = 0, slave_out_J = 0;  // entered and left at the slave
  double dissipated_J = 0;                 // kept from leaving by passivity control, not part of the balance
};

// The slave of a run with teleoperation, world frame, and the packets that were sent to it and by it.
struct SlaveState {
  Vec3 command_W = Vec3::Zero();   // position to which the command that it has received last sends it
  Vec3 position_W = Vec3::Zero();  // centre of its ball, or centre of mass of its tool
  Vec3 force_N = Vec3::Zero();     // mean force of the scene on it in the last tick
  double peak_force_N = 0;         // largest magnitude of that force in the last tick
  double clearance_m = 0;          // distance of ball or tool from the true surface, negative behind it
  // Packets so far: commands and forces that were sent, and frames that have arrived.
  std::int32_t command_packets = 0, force_packets = 0, frame_packets = 0;
  std::optional<ChannelEnergy> energy;  // present in all ticks of a run whose hand is to feel the slave
  std::optional<SlaveToolState> tool;   // present in all ticks of a run whose slave has a tool
};

}  // namespace remote_touch
