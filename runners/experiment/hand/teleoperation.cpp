#include "runners/experiment/hand/teleoperation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/trace/interval_estimates.h"

namespace remote_touch {

Parameters parameters(LinkSettings& s) {
  return appended(parameters(s.channel), parameters(s.dead_band));
}

std::string validate(const LinkSettings& s) {
  const std::string problem = validate(s.channel);
  return problem.empty() ? validate(s.dead_band) : problem;
}

namespace {

SlaveState unknown_state() {
  SlaveState state;
  state.command_W = state.position_W = state.force_N =
      Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  state.peak_force_N = state.clearance_m = std::numeric_limits<double>::quiet_NaN();
  return state;
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
      ends_(make_ends(settings.feedback, settings.slave, settings.hand_mass_kg, tick_s)),
      state_(unknown_state()) {
  if (feels_slave(settings.feedback.force)) state_.energy.emplace();
  if (!settings.tool) return;
  tool_slave_.emplace(settings.slave, *settings.tool, tick_s, scene);
  state_.tool.emplace();
}

void Teleoperation::move_slave(double time_s) {
  const Vec3 goal_W = X_registration_ * *command_W_;
  const Eigen::Quaterniond turn(X_registration_.linear());
  std::optional<Slave::Wave> wave = ends_.slave->wave();
  if (wave) wave->value_W = X_registration_.linear() * wave->value_W;
  const Slave::State& slave = tool_slave_ ? tool_slave_->move({goal_W, turn * command_orientation_W_}, time_s)
                              : wave      ? slave_.move(*wave, time_s)
                                          : slave_.move(goal_W, time_s);
  if (tool_slave_) state_.tool = {tool_slave_->state().orientation_W, tool_slave_->state().torque_Nm};
  state_.command_W = wave ? slave.reference_W : goal_W;
  state_.position_W = slave.position_W, state_.force_N = slave.force_N;
  state_.peak_force_N = slave.peak_force_N, state_.clearance_m = slave.clearance_m;
  if (slave.is_force_known) return;
  state_.peak_force_N = std::numeric_limits<double>::quiet_NaN();
  state_.force_N = Vec3::Constant(state_.peak_force_N);
  if (state_.tool) state_.tool->torque_Nm = state_.force_N;
}

double Teleoperation::ticks_since_last(double time_s) const {
  return std::max(1.0, std::round((time_s - last_s_) / tick_s_));  // no NaN: times
}

// ticks: since the last tick. All but the last of them were missed.
void Teleoperation::move_slave_until(double time_s, double ticks) {
  double peak_N = 0;
  const double missed = std::min(ticks - 1, 1.0 * kMaxMissedTicks);  // no NaN: ticks are counted
  for (int left = static_cast<int>(missed); left > 0; --left) {
    const double at_s = time_s - left * tick_s_;
    move_slave(at_s);
    peak_N = max_or_nan(peak_N, state_.peak_force_N);
    observe_slave();
    receive_command(at_s);
    send_force(at_s);
  }
  move_slave(time_s);
  state_.peak_force_N = max_or_nan(state_.peak_force_N, peak_N);
}

// Returns the motion of the hand since the last tick.
Vec3 Teleoperation::displacement_m(const DeviceState& device) {
  if (!device.position_W.allFinite()) return Vec3::Zero();
  const Vec3 before_W = hand_W_.value_or(device.position_W);
  hand_W_ = device.position_W;
  return device.position_W - before_W;
}

void Teleoperation::observe_slave() {
  if (!feels_slave(s_.feedback.force)) return;
  const Slave::State& s = slave();
  ends_.slave->observe({slave_force(), in_frame_of_hand(s.position_W), in_axes_of_hand(s.velocity_W),
                        in_axes_of_hand(s.reference_displacement_m), in_axes_of_hand(s.drive_N),
                        s.reference_work_J, s.drive_work_J});
}

// ticks: since the last tick.
void Teleoperation::observe_hand(const DeviceState& device, double ticks) {
  const Vec3 moved_m = displacement_m(device);
  if (!feels_slave(s_.feedback.force)) return;
  ends_.hand->observe({hand_W_.value_or(Vec3::Zero()), moved_m, exerted_N_, ticks});
  const PortEnergy &hand = hand_energy(), &slave = slave_energy();
  state_.energy =
      ChannelEnergy{hand.in_J, hand.out_J, slave.in_J, slave.out_J, hand.dissipated_J + slave.dissipated_J};
}

void Teleoperation::receive_command(double time_s) {
  commands_.receive(time_s);
  command_orientation_W_ = commands_.receiver.shown_orientation(time_s).value_or(command_orientation_W_);
  if (const std::optional<Vec3> received = commands_.receiver.shown(time_s))
    command_W_ = ends_.slave->command(*received, commands_.newest.message);
}

void Teleoperation::send_force(double time_s) {
  if (!feels_slave(s_.feedback.force)) return;
  const Vec3 torque_Nm = tool_slave_ ? in_axes_of_hand(tool_slave_->state().torque_Nm) : Vec3(Vec3::Zero());
  forces_.send(slave_force(), Eigen::Quaterniond::Identity(),
               {.message = ends_.slave->message(), .torque_Nm = torque_Nm}, time_s);
}

// Returns the wrench on the hand for the coming tick.
Wrench Teleoperation::receive_wrench(double time_s) {
  if (!feels_slave(s_.feedback.force)) return {};
  forces_.receive(time_s);
  HandEnd::Arrival arrival{.message = forces_.newest.message};
  if (const std::optional<Vec3> shown_N = forces_.receiver.shown(time_s)) {
    const std::optional<double> due_s = longest_silence_s(s_.forces.dead_band);
    const double overdue_s = due_s ? forces_.receiver.silence_s(time_s) - *due_s : 0;
    arrival.force_N = *shown_N, arrival.has_come = true;
    arrival.share = held_share(s_.feedback.hold, overdue_s);
  }
  return {ends_.hand->force(arrival), s_.feedback.gain * arrival.share * forces_.newest.torque_Nm};
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
  if (is_first) command_W_ = ends_.slave->command(command_W, {}), command_orientation_W_ = orientation_W;
  if (!command_W_) return is_rendered ? rendered_wrench(out) : Wrench{};

  const double ticks = is_first ? 1 : ticks_since_last(time_s);
  move_slave_until(time_s, ticks);
  last_s_ = time_s;
  observe_slave();
  observe_hand(device, ticks);
  if (is_valid) commands_.send(command_W, orientation_W, {.message = ends_.hand->message()}, time_s);
  receive_command(time_s);
  send_force(time_s);
  const Wrench wrench = is_rendered ? rendered_wrench(out) : receive_wrench(time_s);
  exerted_N_ = wrench.force_N;
  state_.command_packets = static_cast<std::int32_t>(commands_.sender.packets());
  state_.force_packets = static_cast<std::int32_t>(forces_.sender.packets());
  return wrench;
}

// Forgets older positions: a frame that is older than another one is dropped, so they are not asked for.
std::optional<Vec3> FrameSender::slave_at(double time_s) {
  while (slave_.size() > 1 && slave_[1].first <= time_s + kSameArrival_s) slave_.pop_front();
  if (slave_.empty() || slave_.front().first > time_s + kSameArrival_s) return {};
  return slave_.front().second;
}

}  // namespace remote_touch
