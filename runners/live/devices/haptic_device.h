// The interface of every haptic device; an adapter implements it on top of its vendor's library. SI units.
// Adapters convert the vendor's axes to those of the dissertation's figures, x to the right, y up, z towards
// the user; DevicePlacement converts to the world.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "core/rendering/frames_and_outputs.h"
#include "runners/experiment/sessions/session_file.h"
#include "runners/live/devices/clock.h"

namespace remote_touch {

// The reason why a reading or a command failed; no fault if `what` is null. what: a text that lives as long
// as the device.
struct DeviceFault {
  const char* what = nullptr;
  int code = 0;  // the vendor's error code, if there is one

  explicit operator bool() const { return what != nullptr; }
};

inline constexpr DeviceFault kReleased{"the device was released"};

struct DeviceReading {
  Vec3 position_m = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // rotates handle axes to device axes
  Vec3 velocity_m_per_s = Vec3::Zero();
  Vec3 angular_velocity_rad_per_s = Vec3::Zero();
  std::uint32_t buttons = 0;  // one bit for each button, set while it is down

  bool is_finite() const {
    return position_m.allFinite() && orientation.coeffs().allFinite() && velocity_m_per_s.allFinite() &&
           angular_velocity_rad_per_s.allFinite();
  }
};

// The capabilities of a device. A force, torque or stiffness is 0 if the vendor does not report it.
struct DeviceTraits {
  std::string name;
  int sensed_axes = 3, actuated_axes = 3;  // 0, 3 or 6; an input device has no motors
  double max_force_N = 0;
  double continuous_force_N = 0;
  double max_torque_Nm = 0;
  double max_stiffness_N_per_m = 0;
  double tick_rate_hz = 1000;  // rate of the ticks; the device's own loop may have another
};

// One cycle of the haptic loop: reads the device, renders and writes the force. Returns false after the last
// tick. It must not throw.
using DeviceTick = std::function<bool()>;

// run() is called once, in a thread of its own. The adapter or its vendor's library then calls the
// tick, which calls read() and then write(), once each. The constructor opens the device. It throws
// InputError, which says what is missing and what would help. The force is off until the first write().
class HapticDevice {
 public:
  explicit HapticDevice(Clock& clock, DeviceTraits traits = {}) : traits_(std::move(traits)), clock_(clock) {}
  virtual ~HapticDevice() = default;  // an adapter's destructor releases and closes the device

  const DeviceTraits& traits() const { return traits_; }

  // Called at most once, before run(): the run begins at start_ns, a time of the clock. A simulated device
  // counts its time from there; a real one ignores it.
  virtual void start_at([[maybe_unused]] std::int64_t start_ns) {}
  // Calls the tick at the device's rate until it returns false. The default version uses the clock and
  // traits().tick_rate_hz. A tick that was missed is skipped, not made later.
  virtual void run(const DeviceTick& tick);

  // read() and write() are called within a tick. They must not allocate, lock, or wait beyond the vendor's
  // call.
  virtual DeviceFault read(DeviceReading& reading) noexcept = 0;
  // wrench: on the hand, in the device's axes. The caller has already limited it.
  virtual DeviceFault write(const Wrench& wrench) noexcept = 0;

  // Sets the force to zero from now on, even if another thread hangs in a tick; read() and write() may then
  // return kReleased. Any thread may call it, more than once.
  virtual void release() noexcept = 0;
  // Called from a tick. Undoes release() if the device can exert forces again. Returns false if the device
  // has to be opened again.
  virtual bool rearm() noexcept { return false; }

 protected:
  Clock& clock() const noexcept { return clock_; }

  DeviceTraits traits_;  // fixed when the constructor of the adapter ends

 private:
  Clock& clock_;
};

// The availability of a device, as `remote-touch devices` prints it.
struct Availability {
  bool compiled_in = true;
  bool found = false;  // a device that can be opened is present now
  std::string detail;  // the device found, or the reason why there is none and what would help; one line
  bool was_searched = true;  // false: only opening tells whether there is a device; found is then false
};

inline Availability always(const char* what) {
  return {true, true, what};
}

// Returns what look() finds, or the reason if it throws InputError.
template <class Look>
Availability availability_of(Look look) {
  try {
    return look();
  } catch (const InputError& error) {
    return {.detail = error.what()};
  }
}

// Common part of the adapters of vendors' libraries: the force is off until the first write() and after
// release(), and no value that is not finite passes in either direction. An adapter's destructor calls
// release() before it closes.
class GatedDevice : public HapticDevice {
 public:
  using HapticDevice::HapticDevice;
  DeviceFault read(DeviceReading& reading) noexcept final;
  DeviceFault write(const Wrench& wrench) noexcept final;
  void release() noexcept final;
  bool rearm() noexcept final;

 protected:
  bool is_released() const { return released_; }

 private:
  // Stores everything that the vendor reports. The caller checks that the values are finite. Called in the
  // thread of the ticks.
  virtual DeviceFault sense(DeviceReading& reading) noexcept = 0;
  // write() calls it before the first force command, and again after each rearm(). If it fails, the next
  // write() calls it again.
  virtual DeviceFault switch_on() noexcept = 0;
  virtual DeviceFault exert(const Wrench& wrench) noexcept = 0;
  // Switches the motors off. Any thread may call it, more than once, even while another thread hangs in one
  // of the functions above.
  virtual void switch_off() noexcept = 0;

  DeviceFault exert_if_on(const Wrench& wrench) noexcept;
  void end_call() noexcept;

  std::atomic<bool> released_{false}, is_call_in_progress_{false};
  bool is_on_ = false;
};

// The placement of a device in the world. Converts poses to the world and forces to the device.

// Returns a factor for all forces with which no spring exceeds the maximum stiffness of the device; 1 if no
// spring exceeds it, or if the limit is 0 (unknown). The motion scale device_scale makes springs stiffer by
// that factor. Throws InputError if an argument is not finite, or negative: it must not switch the scaling
// off.
double force_scale(double stiffness_N_per_m, double device_scale, double device_limit_N_per_m);

// Transforms device coordinates D to the world and back: p_W = device_position_m + scale R_WD p_D. Forces and
// torques are rotated but not divided by `scale`, so the hand feels `scale` times the stiffness. to_device()
// also multiplies them by `force_scale`, see force_scale().
class DevicePlacement {
 public:
  explicit DevicePlacement(const LiveSettings& s, double force_scale = 1);

  DeviceState in_world(const DeviceReading& reading) const;
  Wrench to_device(const Wrench& wrench_W) const;
  // The inverse functions, for simulated devices. in_world(wrench_D) does not undo `force_scale`.
  DeviceReading of_device(const DeviceState& state) const;
  Wrench in_world(const Wrench& wrench_D) const;
  double scale() const { return scale_; }

 private:
  Eigen::Quaterniond q_WD_;
  Eigen::Matrix3d R_DW_;
  Vec3 p_W_;
  double scale_, force_scale_;
};

// The last stage before every write to a haptic device.

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
