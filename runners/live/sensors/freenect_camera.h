// The first Kinect (Xbox 360) through libfreenect.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

// address: the number of the camera, or nothing for the first. Depth is registered to colour if the library
// supports that. Intrinsics are the nominal ones of a Kinect, because the library that plays its recordings
// (fakenect) does not have those of the device. If several frames come between two calls of next(), only the
// newest is kept.
//
// The library does not distinguish a lost camera from the end of a recording: both are failures.
std::unique_ptr<DepthSource> open_freenect(const std::string& address, Clock& clock);

Availability freenect_availability();

}  // namespace remote_touch
