// A force with a torque, as a renderer commands it and a device exerts it.
#pragma once

#include "core/geometry/vector.h"

namespace remote_touch {

// Force on the hand, and torque about the device's position; world frame.
struct Wrench {
  Vec3 force_N = Vec3::Zero();
  Vec3 torque_Nm = Vec3::Zero();
};

}  // namespace remote_touch
