// Stands in for openni2_camera.cpp where its library is not installed.
#include "core/parameters/input_error.h"
#include "runners/live/sensors/openni2_camera.h"

namespace remote_touch {

namespace {

constexpr const char* kNoOpenni2 = "not compiled in: install libopenni2-dev and build again";

}  // namespace

std::unique_ptr<DepthSource> open_openni2(const std::string&, Clock&) {
  throw InputError("openni2", kNoOpenni2);
}

Availability openni2_availability() {
  return {.compiled_in = false, .found = false, .detail = kNoOpenni2};
}

}  // namespace remote_touch
