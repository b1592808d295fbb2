// Common part of the adapters of vendors' libraries: the force is off until the first write() and after
// release(), and no value that is not finite passes in either direction.
#pragma once

#include <atomic>

#include "runners/live/devices/haptic_device.h"

namespace remote_touch {

// An adapter's destructor calls release() before it closes.
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

}  // namespace remote_touch
