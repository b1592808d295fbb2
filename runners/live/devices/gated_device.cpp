#include "runners/live/devices/gated_device.h"

#include <time.h>

#include "runners/live/timing/steady_clock.h"

namespace remote_touch {

namespace {

constexpr double kPatience_s = 5e-3;

bool is_finite(const DeviceReading& r) {
  return r.position_m.allFinite() && r.orientation.coeffs().allFinite() && r.velocity_m_per_s.allFinite() &&
         r.angular_velocity_rad_per_s.allFinite();
}

}  // namespace

// Either release() sees that a call is under way, or that call sees at its end that it must switch off; both
// where they overlap. Every order leaves the motors off, since a force is told only after they are on.
void GatedDevice::leave_vendor() noexcept {
  if (released_) switch_off();
  in_vendor_ = false;
}

DeviceFault GatedDevice::read(DeviceReading& reading) noexcept {
  in_vendor_ = true;
  DeviceFault fault = sense(reading);
  leave_vendor();
  if (!fault && !is_finite(reading)) fault = {"the device tells of a state that is no number", 0};
  return fault;
}

DeviceFault GatedDevice::write(const Wrench& wrench) noexcept {
  if (!wrench.force_N.allFinite() || !wrench.torque_Nm.allFinite())
    return {"the force for the device is no number", 0};
  in_vendor_ = true;
  const DeviceFault fault = exert_if_on(wrench);
  leave_vendor();
  return fault;
}

DeviceFault GatedDevice::exert_if_on(const Wrench& wrench) noexcept {
  if (released_) return kReleased;
  if (!is_on_) {
    if (const DeviceFault fault = switch_on()) return fault;
    is_on_ = true;
    if (released_) return kReleased;  // the motors went on after they were switched off
  }
  return exert(wrench);
}

// Vendors' calls rarely expect company: one under way may end, but is not waited for longer than it should
// take.
void GatedDevice::release() noexcept {
  released_ = true;
  const timespec nap{0, 100'000};
  for (const double until_s = steady_s() + kPatience_s; in_vendor_ && steady_s() < until_s;)
    nanosleep(&nap, nullptr);
  switch_off();
}

// The next write switches the motors on, as the first one did.
bool GatedDevice::rearm() noexcept {
  is_on_ = false;
  released_ = false;
  return true;
}

}  // namespace remote_touch
