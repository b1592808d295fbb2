#pragma once

#include <cstdint>

#include "core/geometry/vector.h"

namespace remote_touch {

// The slave of a run with teleoperation, and the packets that were sent to it and by it.
struct SlaveState {
  Vec3 command_W = Vec3::Zero();   // where the command that it has received last sends it
  Vec3 position_W = Vec3::Zero();  // centre of its ball
  Vec3 force_N = Vec3::Zero();     // mean force of the scene on it in the last tick
  double peak_force_N = 0;         // largest magnitude of that force in the last tick
  double clearance_m = 0;          // distance of its ball from the true surface, negative in contact
  // Sent so far. Frames are counted when they arrive.
  std::int32_t command_packets = 0, force_packets = 0, frame_packets = 0;
};

}  // namespace remote_touch
