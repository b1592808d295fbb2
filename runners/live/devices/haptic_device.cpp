#include "runners/live/devices/haptic_device.h"

#include <cmath>

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

}  // namespace remote_touch
