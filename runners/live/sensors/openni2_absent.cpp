// Stands in for openni2_camera.cpp where its library is not installed.
#include "core/parameters/parameter.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

std::unique_ptr<DepthSource> open_openni2(const std::string&, Clock&) {
  throw InputError("openni2", openni2_availability().detail);
}

Availability openni2_availability() {
  return {.compiled_in = false,
          .found = false,
          .detail = "not compiled in: install libopenni2-dev and build again"};
}

}  // namespace remote_touch
