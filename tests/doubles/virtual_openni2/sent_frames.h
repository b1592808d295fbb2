// How far the virtual camera is, for tests that must not depend on how long anything takes.
#pragma once

#include <dlfcn.h>

namespace remote_touch::virtual_camera {

// The number of the newest frame, depth and colour, that the library has from the driver; 0: none since the
// camera was opened.
inline int sent_frames() {
#ifdef REMOTE_TOUCH_VIRTUAL_OPENNI2
  const char* const file = REMOTE_TOUCH_VIRTUAL_OPENNI2 "/OpenNI2/Drivers/libVirtualCamera.so.0";
  void* const driver = dlopen(file, RTLD_LAZY | RTLD_NOLOAD);
  if (driver == nullptr) return 0;
  const int sent = reinterpret_cast<int (*)()>(dlsym(driver, "virtual_camera_sent"))();
  dlclose(driver);
  return sent;
#else
  return 0;
#endif
}

}  // namespace remote_touch::virtual_camera
