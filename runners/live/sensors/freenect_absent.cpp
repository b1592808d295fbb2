// Stands in for freenect_camera.cpp where its library is not installed.
#include "core/parameters/parameter.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

std::unique_ptr<DepthSource> open_freenect(const std::string&, Clock&) {
  throw InputError("freenect", freenect_availability().detail);
}

Availability freenect_availability() {
  return {.compiled_in = false,
          .found = false,
          .detail = "not compiled in: install libfreenect-dev and build again"};
}

}  // namespace remote_touch
