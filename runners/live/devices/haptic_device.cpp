#include "runners/live/devices/haptic_device.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"

namespace remote_touch {

// The start of the run fixes the times of all ticks, so that lateness does not add up. Times that pass during
// a long tick are skipped.
void HapticDevice::run(const DeviceTick& tick) {
  const std::int64_t period_ns = std::llround(1e9 / traits().tick_rate_hz);
  std::int64_t due_ns = clock_.now_ns();
  while (tick()) {
    due_ns += period_ns;
    const std::int64_t late_ns = clock_.now_ns() - due_ns;
    if (late_ns > 0) due_ns += (late_ns + period_ns - 1) / period_ns * period_ns;
    clock_.sleep_until_ns(due_ns);
  }
}

namespace {

constexpr std::int64_t kMaxCallWait_ns = 5'000'000, kCallPollPeriod_ns = 100'000;

}  // namespace

// If a call and release() overlap, release() sees that a call is in progress and waits for it, or the call
// sees at its end that it must switch the motors off, or both happen. Every order leaves the motors off,
// because a force is written only after they are on.
void GatedDevice::end_call() noexcept {
  if (released_) switch_off();
  is_call_in_progress_ = false;
}

DeviceFault GatedDevice::read(DeviceReading& reading) noexcept {
  is_call_in_progress_ = true;
  DeviceFault fault = sense(reading);
  end_call();
  if (!fault && !reading.is_finite()) fault = {"the device reports a state that is not finite", 0};
  return fault;
}

DeviceFault GatedDevice::write(const Wrench& wrench) noexcept {
  if (!wrench.force_N.allFinite() || !wrench.torque_Nm.allFinite())
    return {"the force or torque for the device is not finite", 0};
  is_call_in_progress_ = true;
  const DeviceFault fault = exert_if_on(wrench);
  end_call();
  return fault;
}

DeviceFault GatedDevice::exert_if_on(const Wrench& wrench) noexcept {
  if (released_) return kReleased;
  if (!is_on_) {
    if (const DeviceFault fault = switch_on()) return fault;
    is_on_ = true;
    if (released_) return kReleased;  // release() came during switch_on(); end_call() switches them off
  }
  return exert(wrench);
}

// Waits for a call in progress before the motors are switched off, because few vendors' functions allow calls
// from two threads. It waits at most kMaxCallWait_ns, which is longer than a call should take.
void GatedDevice::release() noexcept {
  released_ = true;
  const std::int64_t until_ns = clock().now_ns() + kMaxCallWait_ns;
  while (is_call_in_progress_ && clock().now_ns() < until_ns)
    clock().sleep_until_ns(clock().now_ns() + kCallPollPeriod_ns);
  switch_off();
}

// The next write switches the motors on, as the first one did.
bool GatedDevice::rearm() noexcept {
  is_on_ = false;
  released_ = false;
  return true;
}

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

namespace {

// Fraction of the vendor's maximum force and torque that is allowed.
constexpr double kDeviceFraction = 0.9;

// The least difference between the command and what is passed that counts as a limit.
constexpr double kSmallForce_N = 0.01, kSmallTorque_Nm = 1e-4, kSmallFraction = 0.01;

bool differs(const Vec3& passed, const Vec3& command, double least) {
  return (passed - command).norm() > kSmallFraction * command.norm() + least;
}

Vec3 towards(const Vec3& from, const Vec3& to, double max_length) {
  return from + limited_length(to - from, max_length);
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
  last_.force_N =
      limited_length(towards(last_.force_N, limited_length(part * command.force_N, limits_.max_force_N),
                             limits_.force_slew_N_per_s * step_s),
                     limits_.max_force_N);
  last_.torque_Nm =
      limited_length(towards(last_.torque_Nm, limited_length(part * command.torque_Nm, limits_.max_torque_Nm),
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
