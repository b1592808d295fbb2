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
  // Fills in all that the vendor reports; the caller checks that it is finite. Called in the thread of the
  // ticks.
  virtual DeviceFault sense(DeviceReading& reading) noexcept = 0;
  // Called once, before any force command.
  virtual DeviceFault switch_on() noexcept = 0;
  virtual DeviceFault exert(const Wrench& wrench) noexcept = 0;
  // Zero force and motors off; called from any thread, more than once, also while one of the others hangs.
  virtual void switch_off() noexcept = 0;

  DeviceFault exert_if_on(const Wrench& wrench) noexcept;
  void leave_vendor() noexcept;

  std::atomic<bool> released_{false}, in_vendor_{false};
  bool is_on_ = false;
};

}  // namespace remote_touch
