#include "runners/experiment/hand/device_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/points/vector.h"

namespace remote_touch {
namespace {

Vec3 with_motors(const Vec3& v, bool x, bool y, bool z) {
  return {x ? v.x() : 0, y ? v.y() : 0, z ? v.z() : 0};
}

Vec3 cut(const Vec3& v, double max_length) {
  return max_length > 0 ? limited_length(v, max_length) : v;
}

// Returns the nearest multiples of the step; the vector itself without a step.
Vec3 rounded(const Vec3& v, double step) {
  if (!(step > 0)) return v;
  return v.unaryExpr([step](double x) { return std::round(x / step) * step; });
}

}  // namespace

Parameters parameters(MotorSettings& s) {
  return {
      {"force_x", &s.force_x, 0, 0, "the device can exert a force along x of the base frame"},
      {"force_y", &s.force_y, 0, 0, "the device can exert a force along y"},
      {"force_z", &s.force_z, 0, 0, "the device can exert a force along z"},
      {"torque_x", &s.torque_x, 0, 0,
       "the device can exert a torque about x of the handle, which is that of the tool"},
      {"torque_y", &s.torque_y, 0, 0, "the device can exert a torque about y of the handle"},
      {"torque_z", &s.torque_z, 0, 0, "the device can exert a torque about z of the handle"},
      {"max_force_N", &s.max_force_N, 0, 1000, "maximum force of the device; 0: no limit"},
      {"max_torque_Nm", &s.max_torque_Nm, 0, 100, "maximum torque of the device; 0: no limit"},
  };
}

Wrench exerted(const MotorSettings& m, const Eigen::Quaterniond& handle_W, const Wrench& commanded) {
  const Vec3 torque_T = handle_W.conjugate() * commanded.torque_Nm;
  return {cut(with_motors(commanded.force_N, m.force_x, m.force_y, m.force_z), m.max_force_N),
          handle_W * cut(with_motors(torque_T, m.torque_x, m.torque_y, m.torque_z), m.max_torque_Nm)};
}

Parameters parameters(DeviceSettings& s) {
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
  return appended(parameters(s.motors), more);
}

std::string validate(const DeviceSettings& s) {
  if (s.velocity_ticks != 1 && s.contact_damping_Ns_per_m == 0)
    return "velocity_ticks = " + std::to_string(s.velocity_ticks) +
           ": expected 1 without contact_damping_Ns_per_m, because nothing else uses the velocity";
  return {};
}

DeviceModel::DeviceModel(const DeviceSettings& settings, double tick_s)
    : s_(settings),
      tick_s_(tick_s),
      positions_(static_cast<std::size_t>(settings.velocity_ticks) + 1, Vec3::Zero()),
      commands_(static_cast<std::size_t>(settings.delay_ticks) + 1) {}

DeviceState DeviceModel::measured(const DeviceState& hand) {
  DeviceState state = hand;
  state.position_W = rounded(hand.position_W, s_.position_resolution_m);
  if (s_.angle_resolution_deg > 0)
    state.orientation_W = rotation(
        rounded(rotation_vector(hand.orientation_W), s_.angle_resolution_deg * std::numbers::pi / 180));
  handle_W_ = state.orientation_W;
  positions_[position_count_++ % positions_.size()] = state.position_W;
  return state;
}

// Returns the mean velocity over velocity_ticks, or over all ticks if there were fewer.
Vec3 DeviceModel::measured_velocity() const {
  const std::size_t ticks = std::min(position_count_, positions_.size()) - 1;
  if (ticks == 0) return Vec3::Zero();
  const std::size_t newest = position_count_ - 1;
  const Vec3 way = positions_[newest % positions_.size()] - positions_[(newest - ticks) % positions_.size()];
  return way / (static_cast<double>(ticks) * tick_s_);
}

Wrench DeviceModel::exerted_for(const Wrench& command) {
  Wrench sum = command;
  if (s_.contact_damping_Ns_per_m != 0 && !command.force_N.isZero(0))
    sum.force_N -= s_.contact_damping_Ns_per_m * measured_velocity();
  const std::size_t newest = command_count_++;
  commands_[newest % commands_.size()] = sum;
  // The entry after the newest one is the oldest. Before the ring is full it is a zero wrench.
  return exerted(s_.motors, handle_W_, commands_[command_count_ % commands_.size()]);
}

}  // namespace remote_touch
