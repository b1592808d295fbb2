#include "runners/live/devices/haptic_device.h"

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

}  // namespace remote_touch
