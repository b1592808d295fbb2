// A simulated haptic device between the hand and the renderer: what it measures of the hand's pose, and which
// wrench it exerts for the commanded one.
#pragma once

#include <cstddef>
#include <vector>

#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/hand/device_settings.h"

namespace remote_touch {

class DeviceModel {
 public:
  // pre: validate(settings) is empty, tick_s > 0.
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
