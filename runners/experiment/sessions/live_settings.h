// Settings of a live run: the poses of device and camera, and the limits of the safety gate.
#pragma once

#include <string>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"

namespace remote_touch {

// The poses of device and camera in the world, as settings.

struct LiveSettings {
  Vec3 device_position_m = Vec3::Zero();
  Vec3 device_rotation_deg = Vec3::Zero();
  double device_scale = 1;
  Vec3 camera_position_m = Vec3::Zero();
  Vec3 camera_rotation_deg = Vec3::Zero();
};

Parameters parameters(LiveSettings& s);
inline std::string validate(const LiveSettings&) {
  return {};
}

// Registration X_WC of the camera from these settings; applied to the camera pose that its source reports.
RigidTransform camera_registration(const LiveSettings& s);

// The limits of a live run's safety gate, as settings.

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
