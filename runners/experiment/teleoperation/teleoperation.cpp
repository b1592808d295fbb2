#include "runners/experiment/teleoperation/teleoperation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace remote_touch {

namespace {

SlaveState unknown_state() {
  SlaveState state;
  state.command_W = state.position_W = state.force_N =
      Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  state.peak_force_N = state.clearance_m = std::numeric_limits<double>::quiet_NaN();
  return state;
}

// Displacement of a mass in a tick per force that is held for the tick; 0 for an unknown mass.
double response_m_per_N(double mass_kg, double tick_s) {
  return mass_kg > 0 ? tick_s * tick_s / (2 * mass_kg) : 0;
}

}  // namespace

// A packet per tick is in transit, and those that the slave sends in missed ticks.
Teleoperation::Link::Link(const LinkSettings& settings, const NoiseKey& key, NoiseUse use, double tick_s,
                          double reach_m)
    : channel(settings.channel, key, use), sender(settings.dead_band, reach_m) {
  const double longest_s = settings.channel.delay_s + settings.channel.jitter_s;
  channel.reserve(static_cast<std::size_t>(longest_s / tick_s) + kMaxMissedTicks + 2);
}

void Teleoperation::Link::send(const Vec3& value, const Eigen::Quaterniond& orientation_W, Packet rest,
                               double time_s) {
  const std::optional<DeadBandSample> sample = sender.send(value, time_s, orientation_W);
  if (!sample) return;
  rest.sample = *sample;
  channel.send(time_s, rest);
}

void Teleoperation::Link::receive(double time_s) {
  const std::optional<Packet> packet = channel.receive(time_s);
  if (!packet) return;
  receiver.receive(packet->sample, time_s);
  newest = *packet;
}

Teleoperation::Teleoperation(const TeleoperationSettings& settings, const NoiseKey& key, double tick_s,
                             const SlaveScene& scene)
    : s_(settings),
      X_registration_(registration_of(settings.registration, key)),
      tick_s_(tick_s),
      slave_(settings.slave, tick_s, scene),
      commands_(settings.commands, key, NoiseUse::command_channel, tick_s,
                settings.tool ? settings.tool->reach_m : 0),
      forces_(settings.forces, key, NoiseUse::force_channel, tick_s, 0),
      hand_port_(settings.feedback.passivity, tick_s, response_m_per_N(settings.hand_mass_kg, tick_s)),
      slave_port_(settings.feedback.passivity, tick_s),
      state_(unknown_state()) {
  if (!settings.tool) return;
  tool_slave_.emplace(settings.slave, *settings.tool, tick_s, scene);
  state_.tool.emplace();
}

void Teleoperation::move_slave(double time_s) {
  const Vec3 goal_W = X_registration_ * *command_W_;
  const Eigen::Quaterniond turn(X_registration_.linear());
  const Slave::State& slave = tool_slave_ ? tool_slave_->move({goal_W, turn * command_orientation_W_}, time_s)
                                          : slave_.move(goal_W, time_s);
  if (tool_slave_) state_.tool = {tool_slave_->state().orientation_W, tool_slave_->state().torque_Nm};
  state_.command_W = goal_W;
  state_.position_W = slave.position_W, state_.force_N = slave.force_N;
  state_.peak_force_N = slave.peak_force_N, state_.clearance_m = slave.clearance_m;
  if (slave.is_force_known) return;
  state_.peak_force_N = std::numeric_limits<double>::quiet_NaN();
  state_.force_N = Vec3::Constant(state_.peak_force_N);
  if (state_.tool) state_.tool->torque_Nm = state_.force_N;
}

double Teleoperation::ticks_since_last(double time_s) const {
  return std::max(1.0, std::round((time_s - last_s_) / tick_s_));
}

// ticks: since the last tick. All but the last of them were missed.
void Teleoperation::move_slave_until(double time_s, double ticks) {
  double peak_N = 0;
  for (int left = static_cast<int>(std::min(ticks - 1, 1.0 * kMaxMissedTicks)); left > 0; --left) {
    const double at_s = time_s - left * tick_s_;
    move_slave(at_s);
    peak_N = std::max(state_.peak_force_N, peak_N);  // keeps NaN
    if (is_passive()) slave_port_.observe(slave_force());
    receive_command(at_s);
    send_force(at_s);
  }
  move_slave(time_s);
  state_.peak_force_N = std::max(state_.peak_force_N, peak_N);
}

// Returns the motion of the hand since the last tick.
Vec3 Teleoperation::displacement_m(const DeviceState& device) {
  if (!device.position_W.allFinite()) return Vec3::Zero();
  const Vec3 before_W = hand_W_.value_or(device.position_W);
  hand_W_ = device.position_W;
  return device.position_W - before_W;
}

void Teleoperation::receive_command(double time_s) {
  commands_.receive(time_s);
  command_orientation_W_ = commands_.receiver.shown_orientation(time_s).value_or(command_orientation_W_);
  if (const std::optional<Vec3> received = commands_.receiver.shown(time_s))
    command_W_ =
        is_passive() ? slave_port_.command(*received, slave_force(), commands_.newest.in_J) : *received;
}

void Teleoperation::send_force(double time_s) {
  if (!feels_slave()) return;
  const Vec3 torque_Nm = tool_slave_ ? in_axes_of_hand(tool_slave_->state().torque_Nm) : Vec3(Vec3::Zero());
  forces_.send(slave_force(), Eigen::Quaterniond::Identity(),
               {.in_J = slave_port_.energy().in_J, .torque_Nm = torque_Nm}, time_s);
}

// Returns the force on the hand for the coming tick.
Vec3 Teleoperation::receive_force(double time_s) {
  if (!feels_slave()) return Vec3::Zero();
  forces_.receive(time_s);
  return forces_.receiver.shown(time_s).value_or(Vec3::Zero());
}

// last_displacement_m: of the hand, in the tick that has ended.
Vec3 Teleoperation::passive_force(const Vec3& force_N, const Vec3& last_displacement_m) {
  const Vec3 expected_m = s_.hand_mass_kg > 0 ? hand_port_.free_displacement() : last_displacement_m;
  return hand_port_.force(force_N, expected_m, forces_.newest.in_J);
}

Vec3 Teleoperation::command(const DeviceState& device, const RenderOutput& out) const {
  return s_.feedback.force == Feedback::rendered ? out.slave_W : device.position_W;
}

Eigen::Quaterniond Teleoperation::command_orientation(const DeviceState& device,
                                                      const RenderOutput& out) const {
  if (!tool_slave_) return Eigen::Quaterniond::Identity();
  const bool is_tool = s_.feedback.force == Feedback::rendered && out.tool && out.slave_W == out.proxy_W;
  const Eigen::Quaterniond q = is_tool ? out.tool->orientation_W : device.orientation_W;
  return Eigen::Quaterniond(q.coeffs() / q.norm());
}

Wrench Teleoperation::tick(const DeviceState& device, const RenderOutput& out, double time_s) {
  const bool is_rendered = s_.feedback.force == Feedback::rendered;
  const Vec3 command_W = command(device, out);
  const Eigen::Quaterniond orientation_W = command_orientation(device, out);
  const bool is_valid = command_W.allFinite() && orientation_W.coeffs().allFinite();
  const bool is_first = !command_W_ && is_valid;
  if (is_first) command_W_ = command_W, command_orientation_W_ = orientation_W;
  if (!command_W_) return is_rendered ? rendered_wrench(out) : Wrench{};

  const double ticks = is_first ? 1 : ticks_since_last(time_s);
  move_slave_until(time_s, ticks);
  last_s_ = time_s;
  const Vec3 moved_m = displacement_m(device);
  if (is_passive() && !is_first) {
    slave_port_.observe(slave_force());
    hand_port_.observe(moved_m);
  }
  if (is_valid) commands_.send(command_W, orientation_W, {.in_J = hand_port_.energy().in_J}, time_s);
  receive_command(time_s);
  send_force(time_s);
  Wrench wrench =
      is_rendered ? rendered_wrench(out) : Wrench{receive_force(time_s), forces_.newest.torque_Nm};
  if (s_.feedback.force == Feedback::slave_force)
    wrench.force_N *= s_.feedback.gain, wrench.torque_Nm *= s_.feedback.gain;
  if (is_passive()) wrench.force_N = passive_force(wrench.force_N, moved_m / ticks);
  state_.command_packets = static_cast<std::int32_t>(commands_.sender.packets());
  state_.force_packets = static_cast<std::int32_t>(forces_.sender.packets());
  return wrench;
}

Wrench commanded_wrench(Teleoperation* remote, const DeviceState& device, RenderOutput& out, double time_s) {
  if (!remote) return rendered_wrench(out);
  out.slave_W = remote->command(device, out);
  return remote->tick(device, out, time_s);
}

}  // namespace remote_touch
