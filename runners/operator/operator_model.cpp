#include "runners/operator/operator_model.h"

#include "core/parameters/schedule.h"

namespace remote_touch {

namespace {

constexpr double kMaxTick_s = 0.01;  // of the haptic rates that an experiment may have

// The velocity a tick later of a mass with a damper of c towards a reference, under the rest of the force.
Vec3 next_velocity(const Vec3& velocity, const Vec3& force, double mass, double c, const Vec3& reference,
                   double tick_s) {
  return (velocity + tick_s / mass * (force + c * reference)) / (1 + tick_s * c / mass);
}

}  // namespace

Parameters parameters(OperatorSettings& s) {
  return {
      {"mass_kg", &s.mass_kg, 0.01, 100, "mass of hand and handle"},
      {"inertia_kg_m2", &s.inertia_kg_m2, 1e-5, 10,
       "moment of inertia of hand and handle, the same about all axes"},
      {"stiffness_N_per_m", &s.stiffness_N_per_m, 0, 10000,
       "stiffness of the spring from the intended position to the hand"},
      {"damping_Ns_per_m", &s.damping_Ns_per_m, 0, 1000, "damping parallel to that spring"},
      {"rotational_stiffness_Nm_per_rad", &s.rotational_stiffness_Nm_per_rad, 0, 1000,
       "stiffness of the rotational spring from the intended orientation to that of the hand"},
      {"rotational_damping_Nms_per_rad", &s.rotational_damping_Nms_per_rad, 0, 100,
       "damping parallel to that spring"},
      {"grip", Rows{{"time_s", "fraction"}, &s.grip}, 0, 86400,
       "strength of these springs over time, 0 (the hand follows the device) to 1; linear between rows; no rows: always 1"},
      {"presses", Rows{{"time_s", "button", "duration_s"}, &s.presses}, 0, 86400,
       "button presses: start, button 0 to 31, duration of at least 0.01 s"},
  };
}

std::string validate(const OperatorSettings& s) {
  const double t2 = kMaxTick_s * kMaxTick_s;
  if (s.stiffness_N_per_m * t2 >= 4 * s.mass_kg)
    return "stiffness_N_per_m = " + std::to_string(s.stiffness_N_per_m) + ": expected below " +
           std::to_string(4 * s.mass_kg / t2) + " for this mass";
  if (s.rotational_stiffness_Nm_per_rad * t2 >= 4 * s.inertia_kg_m2)
    return "rotational_stiffness_Nm_per_rad = " + std::to_string(s.rotational_stiffness_Nm_per_rad) +
           ": expected below " + std::to_string(4 * s.inertia_kg_m2 / t2) + " for this inertia";
  if (const std::string wrong = validate_schedule(s.grip, "grip", "fraction"); !wrong.empty()) return wrong;
  for (std::size_t i = 0; i < s.presses.size(); i += 3) {
    if (const double button = s.presses[i + 1]; button > 31 || button != static_cast<int>(button))
      return "presses: button " + std::to_string(button) + ": expected integers 0 to 31";
    if (s.presses[i + 2] < kMaxTick_s)  // no tick might see it
      return "presses: duration " + std::to_string(s.presses[i + 2]) + ": expected 0.01 or more";
  }
  return {};
}

OperatorModel::OperatorModel(const OperatorSettings& settings, double tick_s)
    : s_(settings), tick_s_(tick_s) {}

std::uint32_t OperatorModel::buttons(double time_s) const {
  std::uint32_t down = 0;
  for (std::size_t i = 0; i < s_.presses.size(); i += 3)
    if (s_.presses[i] <= time_s && time_s < s_.presses[i] + s_.presses[i + 2])
      down |= std::uint32_t{1} << static_cast<int>(s_.presses[i + 1]);
  return down;
}

DeviceState OperatorModel::move(const DeviceState& path, double time_s, const Wrench& device_wrench) {
  const ToolPose intended{path.position_W, path.orientation_W};
  if (!placed_) pose_ = intended_ = intended, placed_ = true;
  const double g = scheduled(s_.grip, time_s);
  const Vector6 path_velocity = displacement(intended_, intended) / tick_s_;
  const Vector6 apart = displacement(pose_, intended_);
  velocity_ = next_velocity(velocity_, device_wrench.force_N + g * s_.stiffness_N_per_m * apart.head<3>(),
                            s_.mass_kg, s_.damping_Ns_per_m, g * path_velocity.head<3>(), tick_s_);
  angular_velocity_ = next_velocity(
      angular_velocity_, device_wrench.torque_Nm + g * s_.rotational_stiffness_Nm_per_rad * apart.tail<3>(),
      s_.inertia_kg_m2, s_.rotational_damping_Nms_per_rad, g * path_velocity.tail<3>(), tick_s_);
  Vector6 motion;
  motion << tick_s_ * velocity_, tick_s_ * angular_velocity_;
  const Eigen::Quaterniond before = pose_.q_WT;
  pose_ = moved(pose_, motion);
  if (angular_velocity_.isZero(0)) pose_.q_WT = before;  // to which rounding would add
  intended_ = intended;
  return {pose_.p_W, pose_.q_WT, buttons(time_s)};
}

}  // namespace remote_touch
