#include "runners/experiment/hand/simulated_hand.h"

namespace remote_touch {
namespace {

constexpr double kMaxTick_s = 0.01;  // longest tick at the haptic rates that an experiment may have
// The maximum of stiffness / mass * kMaxTick_s^2. HeldForceStep keeps its error bound up to this value. A
// hand at the limit already oscillates five times in a tick.
constexpr double kMaxNormalisedStiffness = 1000;

std::string validate_spring(const char* name, double stiffness, double mass, const char* mass_name) {
  const double max = kMaxNormalisedStiffness * mass / (kMaxTick_s * kMaxTick_s);
  if (stiffness <= max) return {};
  return name + (" = " + std::to_string(stiffness)) + ": expected at most " + std::to_string(max) +
         " for this " + mass_name;
}

}  // namespace

Parameters parameters(OperatorSettings& s) {
  return {
      {"mass_kg", &s.mass_kg, 0.01, 100, "mass of hand and handle"},
      {"inertia_kg_m2", &s.inertia_kg_m2, 1e-5, 10,
       "moment of inertia of hand and handle, the same about all axes"},
      {"stiffness_N_per_m", &s.stiffness_N_per_m, 0, 100000,
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
  std::string wrong = validate_spring("stiffness_N_per_m", s.stiffness_N_per_m, s.mass_kg, "mass");
  if (wrong.empty())
    wrong = validate_spring("rotational_stiffness_Nm_per_rad", s.rotational_stiffness_Nm_per_rad,
                            s.inertia_kg_m2, "inertia");
  if (wrong.empty()) wrong = validate_schedule(s.grip, "grip", "fraction");
  if (!wrong.empty()) return wrong;
  for (std::size_t i = 0; i < s.presses.size(); i += 3) {
    if (const double button = s.presses[i + 1]; button > 31 || button != static_cast<int>(button))
      return "presses: button " + std::to_string(button) + ": expected integers 0 to 31";
    if (s.presses[i + 2] < kMaxTick_s)  // a shorter press may lie between two ticks
      return "presses: duration " + std::to_string(s.presses[i + 2]) + ": expected 0.01 or more";
  }
  return {};
}

OperatorModel::Step OperatorModel::step(const MassOnSpring& system, double friction, double duration_s) {
  if (friction > 0) return DryFrictionStep(system, friction, duration_s);
  return HeldForceStep(system, duration_s);
}

OperatorModel::OperatorModel(const OperatorSettings& settings, double tick_s, const DeviceResistance& device)
    : s_(settings), device_(device), tick_s_(tick_s) {}

std::uint32_t OperatorModel::buttons(double time_s) const {
  std::uint32_t down = 0;
  for (std::size_t i = 0; i < s_.presses.size(); i += 3)
    if (s_.presses[i] <= time_s && time_s < s_.presses[i] + s_.presses[i + 2])
      down |= std::uint32_t{1} << static_cast<int>(s_.presses[i + 1]);
  return down;
}

// Computes the coefficients of the step, unless they are still valid. They change only with the grip and
// after missed ticks.
void OperatorModel::prepare(double grip, double duration_s) {
  if (step_ && grip == grip_ && duration_s == duration_s_) return;
  grip_ = grip, duration_s_ = duration_s;
  const double open = 1 - grip;
  step_ = step({s_.mass_kg, grip * s_.stiffness_N_per_m, grip * s_.damping_Ns_per_m,
                open * s_.damping_Ns_per_m + device_.damping_Ns_per_m},
               device_.friction_N, duration_s);
  turning_step_ = step(
      {s_.inertia_kg_m2, grip * s_.rotational_stiffness_Nm_per_rad, grip * s_.rotational_damping_Nms_per_rad,
       open * s_.rotational_damping_Nms_per_rad + device_.rotational_damping_Nms_per_rad},
      device_.friction_torque_Nm, duration_s);
}

DeviceState OperatorModel::move(const DeviceState& intended, double time_s, const Wrench& device_wrench) {
  const ToolPose intended_pose{intended.position_W, intended.orientation_W};
  if (last_time_s_) {
    const double duration_s = tick_s_ * elapsed_ticks(*last_time_s_, time_s, 1 / tick_s_);
    prepare(scheduled(s_.grip, time_s), duration_s);
    const Vector6 path_velocity = displacement(intended_, intended_pose) / duration_s;
    const Vector6 apart = displacement(pose_, intended_);
    start_ = {apart.head<3>(), velocity_, path_velocity.head<3>(), device_wrench.force_N};
    turning_start_ = {apart.tail<3>(), angular_velocity_, path_velocity.tail<3>(), device_wrench.torque_Nm};
    const auto moving = std::visit([&](const auto& step) { return step.motion(start_); }, *step_);
    const auto turning =
        std::visit([&](const auto& step) { return step.motion(turning_start_); }, *turning_step_);
    velocity_ = moving.velocity, angular_velocity_ = turning.velocity;
    Vector6 motion;
    motion << moving.displacement, turning.displacement;
    const Eigen::Quaterniond before = pose_.q_WT;
    pose_ = moved(pose_, motion);
    if (turning.displacement.isZero(0)) pose_.q_WT = before;  // rounding would change it
  } else {
    pose_ = intended_pose;
  }
  intended_ = intended_pose, last_time_s_ = time_s;
  return {pose_.p_W, pose_.q_WT, buttons(time_s)};
}

StepEnergy OperatorModel::last_energy() const {
  if (!step_) return {};
  StepEnergy energy = std::visit([&](const auto& step) { return step.energy(start_); }, *step_);
  return energy += std::visit([&](const auto& step) { return step.energy(turning_start_); }, *turning_step_);
}

SimulatedHand::SimulatedHand(const std::optional<OperatorSettings>& operator_settings,
                             const std::optional<DeviceSettings>& device, double tick_s)
    : has_device_(device.has_value()),
      rounds_(device && (device->position_resolution_m > 0 || device->angle_resolution_deg > 0)),
      device_(device.value_or(DeviceSettings{}), tick_s) {
  if (operator_settings)
    operator_model_.emplace(*operator_settings, tick_s, device ? device->resistance : DeviceResistance{});
}

DeviceState SimulatedHand::move(const DeviceState& intended, double time_s) {
  intended_ = {intended.position_W, intended.orientation_W};
  const DeviceState hand =
      operator_model_ ? operator_model_->move(intended, time_s, device_wrench_) : intended;
  hand_ = {hand.position_W, hand.orientation_W};
  return device_.measured(hand);
}

void SimulatedHand::apply(const Wrench& command) {
  device_wrench_ = device_.exerted_for(command);
}

std::optional<HandState> SimulatedHand::state() const {
  if (!operator_model_ && !has_device_) return {};
  HandState state{intended_.p_W, intended_.q_WT, device_wrench_.force_N, device_wrench_.torque_Nm};
  if (rounds_) state.true_pose = HandState::Pose{hand_.p_W, hand_.q_WT};
  return state;
}

}  // namespace remote_touch
