#include "runners/experiment/sessions/live_settings.h"

#include "core/points/vector.h"

namespace remote_touch {

Parameters parameters(LiveSettings& s) {
  return {
      {"device_position_m", &s.device_position_m, -100, 100,
       "position of the centre of the device's workspace, world frame"},
      {"device_rotation_deg", &s.device_rotation_deg, -360, 360,
       "rotation vector (axis times angle) of the device, world frame; zero: x right, y up, z towards the user"},
      {"device_scale", &s.device_scale, 0.01, 100,
       "motion scale: displacement in the world per displacement of the hand"},
      {"camera_position_m", &s.camera_position_m, -100, 100,
       "position of the camera, added to the one that its source reports"},
      {"camera_rotation_deg", &s.camera_rotation_deg, -360, 360,
       "rotation vector (axis times angle) of the camera, added in the same way"},
  };
}

RigidTransform camera_registration(const LiveSettings& s) {
  return RigidTransform(Eigen::Translation3d(s.camera_position_m) *
                        rotation(kRadiansPerDegree * s.camera_rotation_deg));
}

namespace {

// Longest time in which the slew rate must bring the largest force to zero.
constexpr double kMaxRampDown_s = 0.01;

std::string too_slow(const char* slew, const char* max, double value, double min) {
  if (value >= min) return {};
  return std::string(slew) + " = " + std::to_string(value) + ": expected " + max +
         " / 0.01 s = " + std::to_string(min) + " or more, so that the maximum can fall to 0 in that time";
}

}  // namespace

Parameters parameters(SafetyLimits& s) {
  return {
      {"max_force_N", &s.max_force_N, 0, 100,
       "maximum force; also limited to 0.9 of the maximum force of the device"},
      {"max_torque_Nm", &s.max_torque_Nm, 0, 10,
       "maximum torque; also limited to 0.9 of the maximum torque of the device"},
      {"force_slew_N_per_s", &s.force_slew_N_per_s, 1, 1e5, "maximum rate of change of the force"},
      {"torque_slew_Nm_per_s", &s.torque_slew_Nm_per_s, 0.01, 1e4, "maximum rate of change of the torque"},
      {"max_speed_m_per_s", &s.max_speed_m_per_s, 0.01, 100,
       "maximum speed of the hand; above it the force is switched off until the safety gate is re-armed"},
      {"max_angular_speed_rad_per_s", &s.max_angular_speed_rad_per_s, 0.1, 1000,
       "maximum angular speed of the handle; above it the force is switched off until the safety gate is re-armed"},
      {"engage_force_N", &s.engage_force_N, 1e-3, 10,
       "force starts only when the commanded force is below this"},
      {"ramp_s", &s.ramp_s, 0, 10,
       "after it starts, the force rises linearly to its full value over this time"},
      {"max_command_age_s", &s.max_command_age_s, 0.002, 1, "commands older than this are ignored"},
      {"max_frame_age_s", &s.max_frame_age_s, 0, 100,
       "there is no force while the newest frame was taken longer ago than this, such as after a camera has stopped; 0: no limit, and none with frame_link.least_motion_m, which sends frames only when something moves"},
  };
}

std::string validate(const SafetyLimits& s) {
  const std::string force =
      too_slow("force_slew_N_per_s", "max_force_N", s.force_slew_N_per_s, s.max_force_N / kMaxRampDown_s);
  if (!force.empty()) return force;
  return too_slow("torque_slew_Nm_per_s", "max_torque_Nm", s.torque_slew_Nm_per_s,
                  s.max_torque_Nm / kMaxRampDown_s);
}

}  // namespace remote_touch
