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
  // The library prints its errors to standard output if it has no handler. If another part of the process has
  // set a handler before, that one stays.
  if (set_debug_message_handler != nullptr) set_debug_message_handler(keep_first_error, nullptr, log_error);
}

std::string K4aLibrary::pop_first_error() const {
  const std::lock_guard lock(k4a_log().mutex);
  return std::exchange(k4a_log().first_error, {});
}

}  // namespace remote_touch::k4a
