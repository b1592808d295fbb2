// The placement of a device in the world. Converts poses to the world and forces to the device.
#pragma once

#include "core/rendering/frame.h"
#include "core/rendering/renderer.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// Returns a factor for all forces with which no spring exceeds the maximum stiffness of the device; 1 if no
// spring exceeds it, or if the limit is 0 (unknown). The motion scale device_scale makes springs stiffer by
// that factor. Throws InputError if an argument is not finite, or negative: it must not switch the scaling
// off.
double force_scale(double stiffness_N_per_m, double device_scale, double device_limit_N_per_m);

// Transforms device coordinates D to the world and back: p_W = device_position_m + scale R_WD p_D. Forces and
// torques are rotated but not divided by `scale`, so the hand feels `scale` times the stiffness. to_device()
// also multiplies them by `force_scale`, see force_scale().
class DevicePlacement {
 public:
  explicit DevicePlacement(const LiveSettings& s, double force_scale = 1);

  DeviceState in_world(const DeviceReading& reading) const;
  Wrench to_device(const Wrench& wrench_W) const;
  // The inverse functions, for simulated devices. in_world(wrench_D) does not undo `force_scale`.
  DeviceReading of_device(const DeviceState& state) const;
  Wrench in_world(const Wrench& wrench_D) const;
  double scale() const { return scale_; }

 private:
  Eigen::Quaterniond q_WD_;
  Eigen::Matrix3d R_DW_;
  Vec3 p_W_;
  double scale_, force_scale_;
};

}  // namespace remote_touch
