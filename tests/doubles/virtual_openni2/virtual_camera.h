// Functions that read how many frames the virtual camera has sent, and that unplug it, for tests that must
// not depend on how long anything takes.
#pragma once

#include <dlfcn.h>

#include <memory>

namespace remote_touch::virtual_camera {

// Calls the driver's function of this name if OpenNI 2 has loaded the driver. Otherwise returns Result().
template <class Result>
Result call_driver([[maybe_unused]] const char* function) {
#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2
  const char* const file = REMOTE_TOUCH_VIRTUAL_OPENNI2 "/OpenNI2/Drivers/libVirtualCamera.so.0";
  const auto close = [](void* driver) { dlclose(driver); };
  const std::unique_ptr<void, decltype(close)> driver(dlopen(file, RTLD_LAZY | RTLD_NOLOAD), close);
  if (driver) return reinterpret_cast<Result (*)()>(dlsym(driver.get(), function))();
#endif
  return Result();
}

// Returns the number of the newest frame, depth and colour, that the library has received from the driver, or
// 0 if it has received none since the camera was opened.
inline int sent_frames() {
  return call_driver<int>("virtual_camera_sent");
}

// Makes the camera send no more frames and report that it was unplugged. A camera that is opened later is
// plugged in.
inline void unplug() {
  call_driver<void>("virtual_camera_unplug");
}

}  // namespace remote_touch::virtual_camera
