// The interface of every haptic device; an adapter implements it on top of its vendor's library. SI units.
// Adapters convert the vendor's axes to those of the dissertation's figures, x to the right, y up, z towards
// the user; DevicePlacement converts to the world.
#pragma once

#include <cstdint>
#include <string>

#include "core/geometry/vector.h"
#include "core/rendering/wrench.h"
#include "runners/live/devices/clock.h"

namespace remote_touch {

// Why a reading or a command failed; what: a text that lives as long as the device.
struct DeviceFault {
  const char* what = nullptr;
  int code = 0;  // the vendor's, if there is one

  explicit operator bool() const { return what != nullptr; }
};

inline constexpr DeviceFault kReleased{"the device was released"};

struct DeviceReading {
  Vec3 position_m = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // takes the handle's axes to the device's
  Vec3 velocity_m_per_s = Vec3::Zero();
  Vec3 angular_velocity_rad_per_s = Vec3::Zero();
  std::uint32_t buttons = 0;  // one bit for each button, set while it is down
};

// The capabilities of a device; 0 if the vendor does not report them.
struct DeviceTraits {
  std::string name;
  int sensed_axes = 3, actuated_axes = 3;  // 0, 3 or 6; an input device has no motors
  double max_force_N = 0;
  double continuous_force_N = 0;
  double max_torque_Nm = 0;
  double max_stiffness_N_per_m = 0;
  double tick_rate_hz = 1000;  // rate of the device's own loop
};

// One tick: reads, renders and writes.
class DeviceCycle {
 public:
  virtual ~DeviceCycle() = default;
  // False: no more ticks.
  virtual bool tick() noexcept = 0;
};

// run() is called once, in its own thread, which the adapter or its vendor's library drives; tick() of the
// cycle calls read() and then write(), once each. The constructor opens the device and throws InputError with
// what is missing and what would help; the force is off until the first write().
class HapticDevice {
 public:
  explicit HapticDevice(Clock& clock) : clock_(clock) {}
  virtual ~HapticDevice() = default;  // an adapter's destructor releases and closes the device

  virtual const DeviceTraits& traits() const = 0;

  // Calls tick() at the device's rate until that returns false; by default every millisecond of its clock. A
  // missed tick is not made up for.
  virtual void run(DeviceCycle& cycle);

  // read() and write() are called within a tick; no allocation, no lock, no wait beyond the vendor's call.
  virtual DeviceFault read(DeviceReading& reading) noexcept = 0;
  // Wrench on the hand, device axes; the caller has already limited it.
  virtual DeviceFault write(const Wrench& wrench) noexcept = 0;

  // Sets the force to zero from now on, even if another thread hangs in a tick; read() and write() may then
  // return kReleased. Any thread may call it, more than once.
  virtual void release() noexcept = 0;
  // Called from a tick: undoes release() if the device can exert forces again. False: the device has to be
  // opened again.
  virtual bool rearm() noexcept { return false; }

 protected:
  Clock& clock() const noexcept { return clock_; }

 private:
  Clock& clock_;
};

}  // namespace remote_touch
