// Azure Kinect, and Orbbec's Femto cameras through Orbbec's wrapper: depth through the k4a C interface.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

// address: CAMERA[?MODE]. CAMERA is a number (0: the first, also if left out) or a serial number; MODE is
// nfov (640 x 576 pixels, also if left out), nfov-binned (320 x 288), wfov-binned (512 x 512), all three at
// 30 Hz, or wfov (1024 x 1024 at 15 Hz). Numbers have one or two digits; longer ones are serial numbers.
//
// The lens's distortion is removed from the depth (undistortion.h) with the calibration in the camera; the
// view is that of a pinhole camera. There is no colour. If several frames come between two calls of next(),
// only the newest is kept. The camera does not count its frames: their numbers follow from its time stamps,
// so that gaps are visible.
std::unique_ptr<DepthSource> open_k4a(const std::string& address, Clock& clock);

Availability k4a_availability();

}  // namespace remote_touch
