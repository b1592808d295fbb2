#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "core/geometry/vector.h"

namespace remote_touch {

// The pose and the contact of a slave's tool.
struct SlaveToolState {
  Eigen::Quaterniond orientation_W{Eigen::Vector4d::Constant(std::numeric_limits<double>::quiet_NaN())};
  Vec3 torque_Nm = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());  // see the columns of a trace
};

// The slave of a run with teleoperation, and the packets that were sent to it and by it.
struct SlaveState {
  Vec3 command_W = Vec3::Zero();   // goal of the command that it has received last
  Vec3 position_W = Vec3::Zero();  // centre of its ball, or centre of mass of its tool
  Vec3 force_N = Vec3::Zero();     // mean force of the scene on it in the last tick
  double peak_force_N = 0;         // largest magnitude of that force in the last tick
  double clearance_m = 0;          // distance of ball or tool from the true surface, negative in contact
  // Sent so far. Frames are counted when they arrive.
  std::int32_t command_packets = 0, force_packets = 0, frame_packets = 0;
  std::optional<SlaveToolState> tool;  // present in all ticks of a run whose slave has a tool
};

}  // namespace remote_touch
