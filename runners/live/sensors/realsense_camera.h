// Intel RealSense cameras: depth through the rs2 C interface of librealsense 2.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

// address: a serial number, or nothing for the first camera. Depth comes with 640 x 480 pixels at 30 Hz, in
// the unit of the camera. If the lens distorts, the distortion is removed (undistortion.h); the view is that
// of a pinhole camera. There is no colour. If several frames come between two calls of next(), only the
// newest is kept.
//
// The library is polled for frames every millisecond. It could wait for one, but then it tries for many
// seconds to reopen a camera that was unplugged, and nothing would end that wait.
std::unique_ptr<DepthSource> open_realsense(const std::string& address, Clock& clock);

Availability realsense_availability();

}  // namespace remote_touch
