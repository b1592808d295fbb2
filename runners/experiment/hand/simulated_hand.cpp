#include "runners/experiment/hand/simulated_hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/points/vector.h"
#include "core/rendering/renderer.h"

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
