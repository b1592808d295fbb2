// The last stage before every write to a haptic device.
#pragma once

#include <atomic>
#include <cstdint>

#include "runners/experiment/sessions/session_file.h"
#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// Returns the limits, with max_force_N and max_torque_Nm reduced to at most 0.9 of the device's own maxima,
// if the device reports them.
SafetyLimits limits_for(const SafetyLimits& limits, const DeviceTraits& traits);

enum class GateState { waiting, ramping, engaged, latched };

// Independent rules:
// - A fault of the device, a reading or a command that is not finite, or a hand that is faster than the
//   limits sets the force to zero until rearm().
// - The force falls to zero at the slew rate if no tick came for max_command_age_s, if the command is older
//   than that, or if its newest frame is older than max_frame_age_s. It must then start again as described
//   next.
// - The force starts only while the command is below engage_force_N, and its torque is below the same
//   fraction of its limit. It then rises linearly over ramp_s, so that it does not jump when the hand is
//   inside something.
// - Force and torque are limited to their maximum magnitudes, and change no faster than the slew rates.
// The gate allocates nothing, takes no lock and has no clock of its own. It is not a certified safety
// function.
class SafetyGate {
 public:
  explicit SafetyGate(const SafetyLimits& limits) : limits_(limits) {}

  // Returns the wrench that may be written at now_s, for a command that was made at command_time_s. now_s
  // must never decrease. fault: the fault of the reading, if any. frame_age_s: time since the newest frame
  // was taken; 0 if there is none, or if frames are not expected.
  Wrench pass(double now_s, const DeviceReading& reading, const DeviceFault& fault, const Wrench& command,
              double command_time_s, double frame_age_s = 0) noexcept;
  // Sets the force to zero until rearm(), as after a fault of the device.
  void latch(const DeviceFault& reason) noexcept;
  // Starts again without force after the device was released from outside. A latch remains.
  void restart() noexcept;
  // Ends a latch at the next pass(), on request of the user. Any thread may call it.
  void rearm() noexcept { rearm_.store(true, std::memory_order_relaxed); }

  GateState state() const { return state_; }
  // Returns true if the gate is engaged, and the wrench of the last pass() differed from its command by more
  // than 1 % and 0.01 N or 0.0001 Nm: the command was above a limit, or changed faster than a slew rate.
  bool is_limiting() const { return is_limiting_; }
  const DeviceFault& reason() const { return reason_; }  // reason of the newest latch

 private:
  DeviceFault trouble(const DeviceReading& reading, const DeviceFault& fault,
                      const Wrench& command) const noexcept;
  double fraction(double now_s, const Wrench& command) noexcept;
  Wrench limited(double now_s, const DeviceReading& reading, const DeviceFault& fault, const Wrench& command,
                 double command_time_s, double frame_age_s) noexcept;

  const SafetyLimits limits_;
  GateState state_ = GateState::waiting;
  DeviceFault reason_;
  Wrench last_;
  double last_s_ = 0, ramp_began_s_ = 0;
  bool has_last_ = false, is_limiting_ = false;
  std::atomic<bool> rearm_ = false;
};

// A watchdog: a loop that hangs cannot release its device, so a separate thread does.
class Heartbeat {
 public:
  Heartbeat(HapticDevice& device, double max_s);

  // The loop calls it at the start of every tick. The first call starts the watch. Returns false if the
  // device was released since the last beat.
  bool beat(std::int64_t now_ns) noexcept;
  // Ends the watch: no more beats are expected.
  void rest() noexcept { last_ns_.store(kNone, std::memory_order_release); }

  // Releases the device if there was no beat for longer than max_s. A thread that does not depend on the loop
  // must call it about every period_s().
  void check(std::int64_t now_ns) noexcept;
  double period_s() const { return 1e-9 * static_cast<double>(max_ns_) / 5; }
  // True if the device was released and no beat has come since.
  bool is_released() const { return released_.load(std::memory_order_acquire); }
  int stalls() const { return stalls_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::int64_t kNone = -1;

  HapticDevice& device_;
  const std::int64_t max_ns_;
  std::atomic<std::int64_t> last_ns_ = kNone;
  std::int64_t stalled_at_ns_ = kNone;  // last beat before the newest stall; used by check() alone
  std::atomic<bool> released_ = false;
  std::atomic<int> stalls_ = 0;
};

}  // namespace remote_touch
