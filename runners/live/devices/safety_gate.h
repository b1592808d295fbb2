// The last stage before every write to a haptic device.
#pragma once

#include <atomic>

#include "runners/live/devices/haptic_device.h"
#include "runners/sessions/safety_limits.h"

namespace remote_touch {

// No more than 0.9 of what the device can do.
SafetyLimits limits_for(const SafetyLimits& limits, const DeviceTraits& traits);

enum class GateState { waiting, ramping, engaged, latched };

// Rules, each for itself:
// - A fault of the device, a reading or a command that is no number, or a hand faster than the limits: no
//   force, until rearm().
// - No tick for max_command_age_s, or a command older than that: down to nothing at the slew rate, then as at
// the start.
// - Force begins only while the command is below engage_force_N and a torque of the same share, and rises
//   evenly over ramp_s, so that nothing jumps at a hand that is inside something.
// - Force and torque are cut to their largest length, and change no faster than the slew rates.
// No allocation, no lock, no clock of its own. Not a certified safety function.
class SafetyGate {
 public:
  explicit SafetyGate(const SafetyLimits& limits) : limits_(limits) {}

  // What may be written at now_s, which never decreases, of a command made at command_time_s. fault: of the
  // reading.
  Wrench pass(double now_s, const DeviceReading& reading, const DeviceFault& fault, const Wrench& command,
              double command_time_s) noexcept;
  // As after a fault of the device: no force, until rearm().
  void latch(const DeviceFault& reason) noexcept;
  // The device was let go by someone else: as at the start.
  void restart() noexcept;
  // After a latch, on request of the user; from any thread.
  void rearm() noexcept { rearm_.store(true, std::memory_order_relaxed); }

  GateState state() const { return state_; }
  const DeviceFault& reason() const { return reason_; }  // of a latch

 private:
  DeviceFault trouble(const DeviceReading& reading, const DeviceFault& fault,
                      const Wrench& command) const noexcept;
  double fraction(double now_s, const Wrench& command) noexcept;

  const SafetyLimits limits_;
  GateState state_ = GateState::waiting;
  DeviceFault reason_;
  Wrench last_;
  double last_s_ = 0, ramp_began_s_ = 0;
  bool has_last_ = false;
  std::atomic<bool> rearm_ = false;
};

}  // namespace remote_touch
