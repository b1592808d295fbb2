// Depth cameras that OpenNI 2 drives (Kinect, Xtion, Carmine, Astra), and its recordings (.oni).
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

// address: "any" or nothing for the first camera, the URI of a camera, or an .oni file. The camera delivers
// its widest image of up to 640 x 480 pixels at 30 Hz, not mirrored; intrinsics follow from the driver's
// field of view. Colour is used if the camera registers depth to it: that of the newest colour frame, if its
// time differs from that of the depth by at most 1.1 periods. If several frames come between two calls of
// next(), only the newest is kept.
//
// A recording plays at its own speed, once. Its colour is not used, because the file does not state whether
// its depth was registered.
//
// Opening the first camera changes the working folder of the process for a moment, while the library loads
// its drivers: open it before other threads use relative paths. The frames may be taken in any thread: the
// camera calls the library only in a thread that lasts until the process ends, because the library crashes
// when it uses a thread that has ended.
std::unique_ptr<DepthSource> open_openni2(const std::string& address, Clock& clock);

Availability openni2_availability();

}  // namespace remote_touch
