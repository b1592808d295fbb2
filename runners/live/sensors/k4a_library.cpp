#include "runners/live/sensors/k4a_library.h"

#include <mutex>
#include <utility>

namespace remote_touch::k4a {

namespace {

const SharedLibrary::Lookup kK4aLibrary{
    {"libk4a.so.1.4", "libk4a.so"},
    "REMOTE_TOUCH_LIBK4A",
    "the Azure Kinect Sensor SDK (libk4a1.4), or of Orbbec's K4A wrapper"};

// The log is never freed, because a thread of the library may write to it at any time.
struct Log {
  std::mutex mutex;
  std::string first_error;
};
Log& k4a_log() {
  static Log& one = *new Log;
  return one;
}

void keep_first_error(void*, LogLevel, const char*, int, const char* message) {
  const std::lock_guard lock(k4a_log().mutex);
  if (k4a_log().first_error.empty() && message != nullptr) k4a_log().first_error = message;
}

}  // namespace

K4aLibrary::K4aLibrary() : library(kK4aLibrary) {
  library.find("k4a_device_get_installed_count", device_get_installed_count);
  library.find("k4a_device_open", device_open);
  library.find("k4a_device_close", device_close);
  library.find("k4a_device_get_serialnum", device_get_serialnum);
  library.find("k4a_device_get_calibration", device_get_calibration);
  library.find("k4a_device_start_cameras", device_start_cameras);
  library.find("k4a_device_stop_cameras", device_stop_cameras);
  library.find("k4a_device_get_capture", device_get_capture);
  library.find("k4a_calibration_2d_to_3d", calibration_2d_to_3d);
  library.find("k4a_calibration_3d_to_2d", calibration_3d_to_2d);
  library.find("k4a_capture_get_depth_image", capture_get_depth_image);
  library.find("k4a_capture_release", capture_release);
  library.find("k4a_image_get_buffer", image_get_buffer);
  library.find("k4a_image_get_size", image_get_size);
  library.find("k4a_image_get_format", image_get_format);
  library.find("k4a_image_get_width_pixels", image_get_width_pixels);
  library.find("k4a_image_get_height_pixels", image_get_height_pixels);
  library.find("k4a_image_get_stride_bytes", image_get_stride_bytes);
  library.find("k4a_image_get_device_timestamp_usec", image_get_device_timestamp_us);
  library.find("k4a_image_release", image_release);
  library.find_optional("k4a_set_debug_message_handler", set_debug_message_handler);
  // The library prints its errors to standard output if it has no handler. If another part of the process has
  // set a handler before, that one stays.
  if (set_debug_message_handler != nullptr) set_debug_message_handler(keep_first_error, nullptr, log_error);
}

std::string K4aLibrary::pop_first_error() const {
  const std::lock_guard lock(k4a_log().mutex);
  return std::exchange(k4a_log().first_error, {});
}

}  // namespace remote_touch::k4a
