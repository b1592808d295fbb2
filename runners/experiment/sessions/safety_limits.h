// The limits of a live run's safety gate, as settings.
#pragma once

#include <string>

#include "core/parameters/parameter.h"

namespace remote_touch {

struct SafetyLimits {
  double max_force_N = 5;
  double max_torque_Nm = 0.2;
  double force_slew_N_per_s = 1000;
  double torque_slew_Nm_per_s = 40;
  double max_speed_m_per_s = 3;
  double max_angular_speed_rad_per_s = 40;
  double engage_force_N = 0.3;
  double ramp_s = 0.5;
  double max_command_age_s = 0.02;
  double max_frame_age_s = 0;
};

Parameters parameters(SafetyLimits& s);
std::string validate(const SafetyLimits& s);

}  // namespace remote_touch
