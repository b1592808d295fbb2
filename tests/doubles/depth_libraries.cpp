#include "tests/doubles/depth_libraries.h"

#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>

#include "runners/live/sensors/k4a_camera.h"
#include "runners/live/sensors/realsense_camera.h"

namespace remote_touch {

const DepthLibrary kK4a{.name = "k4a",
                        .double_file = REMOTE_TOUCH_DOUBLE_K4A,
                        .variable = "REMOTE_TOUCH_LIBK4A",
                        .library = "libk4a.so.1.4",
                        .open = open_k4a,
                        .availability = k4a_availability};

const DepthLibrary kRealSense{.name = "realsense",
                              .double_file = REMOTE_TOUCH_DOUBLE_REALSENSE,
                              .variable = "REMOTE_TOUCH_LIBREALSENSE",
                              .library = "librealsense2.so",
                              .open = open_realsense,
                              .availability = realsense_availability};

const DepthLibrary kOldRealSense{.name = "old_realsense",
                                 .double_file = REMOTE_TOUCH_DOUBLE_OLD_REALSENSE,
                                 .variable = "REMOTE_TOUCH_LIBREALSENSE",
                                 .library = "librealsense2.so",
                                 .open = open_realsense,
                                 .availability = realsense_availability};

void PrintTo(const DepthLibrary* library, std::ostream* out) {
  *out << library->name;
}

CameraInstalled::CameraInstalled(const DepthLibrary& library, SimulatedClock* clock)
    : variable_(library.variable) {
  void* loaded = dlopen(library.double_file, RTLD_NOW | RTLD_LOCAL);
  if (loaded == nullptr) throw std::runtime_error(dlerror());
  camera_ = reinterpret_cast<CameraDouble* (*)()>(dlsym(loaded, "camera_double"))();
  camera_->reset();
  camera_->follow(clock);
  setenv(variable_, library.double_file, 1);
}

CameraInstalled::~CameraInstalled() {
  camera_->reset();
  camera_->follow(nullptr);
  unsetenv(variable_);
}

}  // namespace remote_touch
