// The first Kinect (Xbox 360) through libfreenect.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/availability.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

// address: the number of the camera, or nothing for the first. Depth is registered to colour where the
// library does that. Intrinsics are the nominal ones of a Kinect: the library that plays its recordings
// (fakenect) does not know those of the device. Of frames that nobody waits for only the newest is kept.
//
// The library tells no lost camera from the end of a recording: both are failures.
std::unique_ptr<DepthSource> open_freenect(const std::string& address, Clock& clock);

Availability freenect_availability();

}  // namespace remote_touch
