#include "runners/live/devices/safety_gate.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {
namespace {

// Fraction of the vendor's maximum force and torque that is allowed.
constexpr double kDeviceFraction = 0.9;

Vec3 shortened(const Vec3& v, double max_length) {
  const double length = v.norm();
  return length > max_length ? Vec3(v * (max_length / length)) : v;
}

// The least difference between the command and what is passed that counts as a limit.
constexpr double kSmallForce_N = 0.01, kSmallTorque_Nm = 1e-4, kSmallFraction = 0.01;

bool differs(const Vec3& passed, const Vec3& command, double least) {
  return (passed - command).norm() > kSmallFraction * command.norm() + least;
}

Vec3 towards(const Vec3& from, const Vec3& to, double max_length) {
  return from + shortened(to - from, max_length);
}

}  // namespace

SafetyLimits limits_for(const SafetyLimits& limits, const DeviceTraits& traits) {
  SafetyLimits all = limits;
  const auto cap = [](double& limit, double of_device) {
    if (of_device > 0) limit = std::min(limit, kDeviceFraction * of_device);
  };
  cap(all.max_force_N, traits.max_force_N);
  cap(all.max_torque_Nm, traits.max_torque_Nm);
  return all;
}

void SafetyGate::latch(const DeviceFault& reason) noexcept {
  state_ = GateState::latched;
  reason_ = reason;
  last_ = {};
}

void SafetyGate::restart() noexcept {
  last_ = {};
  if (state_ != GateState::latched) state_ = GateState::waiting;
}

DeviceFault SafetyGate::trouble(const DeviceReading& reading, const DeviceFault& fault,
                                const Wrench& command) const noexcept {
  if (fault) return fault;
  if (!reading.is_finite()) return {"the device reported a number that is not finite"};
  if (reading.velocity_m_per_s.norm() > limits_.max_speed_m_per_s) return {"the hand is too fast"};
  if (reading.angular_velocity_rad_per_s.norm() > limits_.max_angular_speed_rad_per_s)
    return {"the handle turns too fast"};
  if (!command.force_N.allFinite() || !command.torque_Nm.allFinite())
    return {"the commanded force or torque is not finite"};
  return {};
}

// Returns the fraction of the command to apply, 0 to 1, and advances the state.
double SafetyGate::fraction(double now_s, const Wrench& command) noexcept {
  if (state_ == GateState::waiting) {
    const double engage_torque_Nm =
        limits_.max_force_N > 0 ? limits_.engage_force_N * limits_.max_torque_Nm / limits_.max_force_N : 0;
    // If the limit of the torque is 0, no torque reaches the device, so it cannot jump. If the limit of the
    // force is 0, the threshold is 0, and a command without torque must still engage.
    const double torque_Nm = command.torque_Nm.norm();
    const bool has_torque = limits_.max_torque_Nm > 0 && torque_Nm > 0 && torque_Nm >= engage_torque_Nm;
    if (command.force_N.norm() >= limits_.engage_force_N || has_torque) return 0;
    state_ = GateState::ramping;
    ramp_began_s_ = now_s;
  }
  if (state_ == GateState::ramping) {
    const double gone_s = now_s - ramp_began_s_;
    if (gone_s < limits_.ramp_s) return gone_s / limits_.ramp_s;
    state_ = GateState::engaged;
  }
  return 1;
}

Wrench SafetyGate::pass(double now_s, const DeviceReading& reading, const DeviceFault& fault,
                        const Wrench& command, double command_time_s, double frame_age_s) noexcept {
  const Wrench passed = limited(now_s, reading, fault, command, command_time_s, frame_age_s);
  is_limiting_ =
      state_ == GateState::engaged && (differs(passed.force_N, command.force_N, kSmallForce_N) ||
                                       differs(passed.torque_Nm, command.torque_Nm, kSmallTorque_Nm));
  return passed;
}

Wrench SafetyGate::limited(double now_s, const DeviceReading& reading, const DeviceFault& fault,
                           const Wrench& command, double command_time_s, double frame_age_s) noexcept {
  const double gap_s = has_last_ ? now_s - last_s_ : 0;
  last_s_ = now_s, has_last_ = true;
  if (rearm_.exchange(false, std::memory_order_relaxed) && state_ == GateState::latched)
    state_ = GateState::waiting;
  if (const DeviceFault found = trouble(reading, fault, command); found && state_ != GateState::latched)
    latch(found);
  if (state_ == GateState::latched) return {};
  const bool is_stale = gap_s > limits_.max_command_age_s ||
                        now_s - command_time_s > limits_.max_command_age_s ||
                        (limits_.max_frame_age_s > 0 && frame_age_s > limits_.max_frame_age_s);
  if (is_stale) state_ = GateState::waiting;
  const double part = is_stale ? 0 : fraction(now_s, command);
  // The last written force is old after a gap, so a step is never larger than that of a tick of 2 ms.
  const double step_s = std::min(gap_s, 0.002);
  last_.force_N = shortened(towards(last_.force_N, shortened(part * command.force_N, limits_.max_force_N),
                                    limits_.force_slew_N_per_s * step_s),
                            limits_.max_force_N);
  last_.torque_Nm =
      shortened(towards(last_.torque_Nm, shortened(part * command.torque_Nm, limits_.max_torque_Nm),
                        limits_.torque_slew_Nm_per_s * step_s),
                limits_.max_torque_Nm);
  return last_;
}

Heartbeat::Heartbeat(HapticDevice& device, double max_s)
    : device_(device), max_ns_(std::llround(1e9 * max_s)) {}

bool Heartbeat::beat(std::int64_t now_ns) noexcept {
  last_ns_.store(now_ns, std::memory_order_release);
  return !released_.exchange(false, std::memory_order_acq_rel);
}

// A beat may come between the check of the time and the release: the device is released then too, and the
// next beat reports it.
void Heartbeat::check(std::int64_t now_ns) noexcept {
  const std::int64_t last_ns = last_ns_.load(std::memory_order_acquire);
  const bool is_known = last_ns == kNone || last_ns == stalled_at_ns_;  // one release per stall
  if (is_known || now_ns - last_ns <= max_ns_) return;
  device_.release();
  released_.store(true, std::memory_order_release);
  stalls_.fetch_add(1, std::memory_order_relaxed);
  stalled_at_ns_ = last_ns;
}

}  // namespace remote_touch
