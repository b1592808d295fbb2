// The interface of every haptic device, which an adapter implements with the vendor's library. SI units.
// Adapters convert the vendor's axes to those of the dissertation's figures: x to the right, y up, z towards
// the user. They do not know the pose of the device in the world.
#pragma once

#include <cstdint>
#include <string>

#include "core/geometry/vector.h"
#include "core/tool/dynamics/wrench_coupling.h"
#include "runners/live/timing/clock.h"

namespace remote_touch {

// Why a reading or a command failed; what: a text that lives as long as the program.
struct DeviceFault {
  const char* what = nullptr;
  int code = 0;  // the vendor's, where there is one

  explicit operator bool() const { return what != nullptr; }
};

inline constexpr DeviceFault kReleased{"the device was let go"};

struct DeviceReading {
  Vec3 position_m = Vec3::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // takes the handle's axes to the device's
  Vec3 velocity_m_per_s = Vec3::Zero();
  Vec3 angular_velocity_rad_per_s = Vec3::Zero();
  std::uint32_t buttons = 0;  // those that are down, a bit each
};

// What a device can do; 0 where the vendor does not tell.
struct DeviceTraits {
  std::string name;
  int sensed_axes = 3, actuated_axes = 3;  // 0, 3 or 6; an input device has no motors
  double max_force_N = 0;
  double continuous_force_N = 0;
  double max_torque_Nm = 0;
  double max_stiffness_N_per_m = 0;
  double tick_rate_hz = 1000;  // of its own loop
};

// One tick: reads, renders and writes.
class DeviceCycle {
 public:
  virtual ~DeviceCycle() = default;
  // False: no more.
  virtual bool tick() noexcept = 0;
};

// run() is called once, in a thread of its own, which the adapter or its vendor's library drives; tick() of
// the cycle calls read() and then write(), once each. The constructor opens the device and throws InputError
// with what is absent and what would help; the force is off until the first write().
class HapticDevice {
 public:
  explicit HapticDevice(Clock& clock) : clock_(clock) {}
  virtual ~HapticDevice() = default;  // release() and closed

  virtual const DeviceTraits& traits() const = 0;

  // Calls tick() at the device's rate until it is told to stop; by default every millisecond of its clock. A
  // tick that is late is not made up for.
  virtual void run(DeviceCycle& cycle);

  // Both within a tick; no allocation, no lock, no wait beyond what the vendor's call takes.
  virtual DeviceFault read(DeviceReading& reading) noexcept = 0;
  // Force on the hand; the caller has already limited it.
  virtual DeviceFault write(const Wrench& wrench) noexcept = 0;

  // Zero force from now on, even if another thread hangs in a tick; read() and write() may return kReleased.
  // Can be called from any thread, more than once.
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
