// A haptic device that senses all six axes and has motors for some of them, such as the five of the device of
// 7.5.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

struct MotorSettings {
  bool force_x = true, force_y = true, force_z = true;
  bool torque_x = true, torque_y = true, torque_z = true;
  double max_force_N = 0;
  double max_torque_Nm = 0;
};

Parameters parameters(MotorSettings& s);

// Returns the wrench that the device exerts on the hand for a commanded one. Forces act along the base axes,
// and torques about the axes of the handle, which are those of the tool. Components on axes without a motor
// are 0. The force is limited to max_force_N and the torque to max_torque_Nm; 0: no limit.
Wrench exerted(const MotorSettings& motors, const Eigen::Quaterniond& handle_W, const Wrench& commanded);

}  // namespace remote_touch
