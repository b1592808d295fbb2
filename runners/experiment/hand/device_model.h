// A simulated haptic device between the hand and the renderer: what it measures of the hand's pose, and which
// wrench it exerts for the commanded one.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// A haptic device that senses all six axes and has motors for some of them, such as the five of the device of
// 7.5.

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

// The settings of a simulated haptic device: its motors, the resistance of its joints, its sensors and the
// delay of its loop.

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

class DeviceModel {
 public:
  DeviceModel(const DeviceSettings& settings, double tick_s);

  // Returns the pose that the device measures for the pose of the hand. The coordinates of the position and
  // of the rotation vector are rounded to multiples of the resolutions. Must be called once per tick.
  DeviceState measured(const DeviceState& hand);

  // Returns the wrench that the device exerts from now to the next tick, for the command that the renderer
  // has computed from the last measured pose. Must be called once per tick, after measured(). The device adds
  // contact damping -B v, where v is the measured velocity, to a command with a force. It exerts the command
  // of delay_ticks ticks ago, and no wrench before the first command arrives. See exerted() for the motors.
  // Does not allocate memory.
  Wrench exerted_for(const Wrench& command);

 private:
  Vec3 measured_velocity() const;

  const DeviceSettings s_;
  const double tick_s_;
  Eigen::Quaterniond handle_W_ = Eigen::Quaterniond::Identity();  // measured orientation
  // Rings of the newest velocity_ticks + 1 measured positions and of the newest delay_ticks + 1 commands. The
  // entry of tick i is at i modulo the size.
  std::vector<Vec3> positions_;
  std::vector<Wrench> commands_;
  std::size_t position_count_ = 0, command_count_ = 0;  // so far
};

}  // namespace remote_touch
