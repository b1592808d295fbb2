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
#include "core/rendering/renderer.h"
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

}  // namespace remote_touch
