#include "runners/experiment/hand/device_settings.h"

namespace remote_touch {

Parameters parameters(DeviceSettings& s) {
  Parameters all = parameters(s.motors);
  const Parameters more{
      {"friction_N", &s.resistance.friction_N, 0, 100,
       "dry (Coulomb) friction along each axis of the base frame; needs an operator"},
      {"friction_torque_Nm", &s.resistance.friction_torque_Nm, 0, 10,
       "dry friction of turns about each axis; needs an operator"},
      {"damping_Ns_per_m", &s.resistance.damping_Ns_per_m, 0, 1000,
       "viscous friction of the device; needs an operator"},
      {"rotational_damping_Nms_per_rad", &s.resistance.rotational_damping_Nms_per_rad, 0, 100,
       "viscous friction of turns; needs an operator"},
      {"position_resolution_m", &s.position_resolution_m, 0, 0.01,
       "step of the measured position along each axis; 0: exact"},
      {"angle_resolution_deg", &s.angle_resolution_deg, 0, 10,
       "step of the measured rotation vector along each axis; 0: exact"},
      {"delay_ticks", &s.delay_ticks, 0, 1000,
       "ticks from a measured pose to the wrench that is computed for it"},
      {"contact_damping_Ns_per_m", &s.contact_damping_Ns_per_m, -1000, 1000,
       "damping that the device adds while the renderer commands a force, from measured positions; negative: the device drives the hand"},
      {"velocity_ticks", &s.velocity_ticks, 1, 1000,
       "ticks between the two positions whose difference is the measured velocity"},
  };
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

std::string validate(const DeviceSettings& s) {
  if (s.velocity_ticks != 1 && s.contact_damping_Ns_per_m == 0)
    return "velocity_ticks = " + std::to_string(s.velocity_ticks) +
           ": expected 1 without contact_damping_Ns_per_m, because nothing else uses the velocity";
  return {};
}

}  // namespace remote_touch
