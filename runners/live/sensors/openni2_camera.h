// Depth cameras that OpenNI 2 drives (Kinect, Xtion, Carmine, Astra), and its recordings (.oni).
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/availability.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

// address: "any" or nothing for the first camera, the URI of a camera, or an .oni file. The camera looks with
// its widest image of up to 640 x 480 pixels at 30 Hz and without mirroring; intrinsics are those of the
// driver's field of view. Colour comes where the camera registers depth to it, from the frame next in time.
// Of frames that nobody waits for only the newest is kept.
//
// A recording plays at its own speed, once. It has no colour, since it does not tell whether its depth was
// registered.
//
// The first one open changes the process's working folder for a moment, while the library loads its drivers:
// open it before other threads look for files by relative paths. Frames are to be taken in one thread of the
// process, whatever camera they are of: the library remembers the threads that waited, and crashes when it
// looks for one that has ended.
std::unique_ptr<DepthSource> open_openni2(const std::string& address, Clock& clock);

Availability openni2_availability();

}  // namespace remote_touch
