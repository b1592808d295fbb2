// The settings of a simulated haptic device: its motors, the resistance of its joints, its sensors and the
// delay of its loop.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "runners/experiment/hand/device_motors.h"

namespace remote_touch {

// Friction and damping of the joints against the ground, the same along all axes. They move only a hand that
// has a mass, so they need an operator.
struct DeviceResistance {
  double friction_N = 0, friction_torque_Nm = 0;  // dry (Coulomb) friction
  double damping_Ns_per_m = 0, rotational_damping_Nms_per_rad = 0;
};

struct DeviceSettings {
  MotorSettings motors;
  DeviceResistance resistance;
  double position_resolution_m = 0;
  double angle_resolution_deg = 0;
  int delay_ticks = 0;
  double contact_damping_Ns_per_m = 0;
  int velocity_ticks = 1;
};

Parameters parameters(DeviceSettings& s);
std::string validate(const DeviceSettings& s);

}  // namespace remote_touch
