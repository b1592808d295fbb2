#include "runners/live/devices/device_placement.h"

#include <cmath>
#include <string>
#include <utility>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"

namespace remote_touch {

double force_scale(double stiffness_N_per_m, double device_scale, double device_limit_N_per_m) {
  const std::pair<const char*, double> all[] = {{"stiffness of the renderer", stiffness_N_per_m},
                                                {"device_scale", device_scale},
                                                {"largest stiffness of the device", device_limit_N_per_m}};
  for (const auto& [name, value] : all)
    if (!(value >= 0 && std::isfinite(value)))
      throw InputError(std::string(name) + " = " + std::to_string(value),
                       "expected a finite number, 0 or more");
  const double felt = stiffness_N_per_m * device_scale;
  return device_limit_N_per_m > 0 && felt > device_limit_N_per_m ? device_limit_N_per_m / felt : 1;
}

DevicePlacement::DevicePlacement(const LiveSettings& s, double force_scale)
    : q_WD_(rotation(kRadiansPerDegree * s.device_rotation_deg)),
      R_DW_(q_WD_.conjugate().toRotationMatrix()),
      p_W_(s.device_position_m),
      scale_(s.device_scale),
      force_scale_(force_scale) {}

DeviceState DevicePlacement::in_world(const DeviceReading& reading) const {
  return {p_W_ + scale_ * (R_DW_.transpose() * reading.position_m), q_WD_ * reading.orientation,
          reading.buttons};
}

Wrench DevicePlacement::to_device(const Wrench& wrench_W) const {
  return {force_scale_ * (R_DW_ * wrench_W.force_N), force_scale_ * (R_DW_ * wrench_W.torque_Nm)};
}

DeviceReading DevicePlacement::of_device(const DeviceState& state) const {
  DeviceReading reading;
  reading.position_m = R_DW_ * (state.position_W - p_W_) / scale_;
  reading.orientation = q_WD_.conjugate() * state.orientation_W;
  reading.buttons = state.buttons;
  return reading;
}

Wrench DevicePlacement::in_world(const Wrench& wrench_D) const {
  return {R_DW_.transpose() * wrench_D.force_N, R_DW_.transpose() * wrench_D.torque_Nm};
}

}  // namespace remote_touch
