// The adapters of cameras, one source each. open_...() opens a camera; it throws InputError, which says what
// is missing. ..._availability() says whether there is one.
#pragma once

#include <memory>
#include <string>

#include "runners/live/devices/haptic_device.h"
#include "runners/live/sensors/depth_source.h"

namespace remote_touch {

// Depth cameras that OpenNI 2 drives (Kinect, Xtion, Carmine, Astra), and its recordings (.oni).
//
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

// The first Kinect (Xbox 360) through libfreenect. address: the number of the camera, or nothing for the
// first. Depth is registered to colour if the library supports that. Intrinsics are the nominal ones of a
// Kinect, because the library that plays its recordings (fakenect) does not have those of the device. If
// several frames come between two calls of next(), only the newest is kept.
//
// The library does not distinguish a lost camera from the end of a recording: both are failures.
std::unique_ptr<DepthSource> open_freenect(const std::string& address, Clock& clock);
Availability freenect_availability();

// Azure Kinect, and Orbbec's Femto cameras through Orbbec's wrapper: depth through the k4a C interface.
//
// address: CAMERA[?MODE]. CAMERA is a number (0: the first, also if left out) or a serial number; MODE is
// nfov (640 x 576 pixels, also if left out), nfov-binned (320 x 288), wfov-binned (512 x 512), all three at
// 30 Hz, or wfov (1024 x 1024 at 15 Hz). Numbers have one or two digits; longer ones are serial numbers.
//
// The lens's distortion is removed from the depth (depth_source.h) with the calibration in the camera; the
// view is that of a pinhole camera. There is no colour. If several frames come between two calls of next(),
// only the newest is kept. The camera does not count its frames: their numbers follow from its time stamps,
// so that gaps are visible.
std::unique_ptr<DepthSource> open_k4a(const std::string& address, Clock& clock);
Availability k4a_availability();

// Intel RealSense cameras: depth through the rs2 C interface of librealsense 2.
//
// address: a serial number, or nothing for the first camera. Depth comes with 640 x 480 pixels at 30 Hz, in
// the unit of the camera. If the lens distorts, the distortion is removed (depth_source.h); the view is that
// of a pinhole camera. There is no colour. If several frames come between two calls of next(), only the
// newest is kept.
//
// The library is polled for frames every millisecond. It could wait for one, but then it tries for many
// seconds to reopen a camera that was unplugged, and nothing would end that wait.
std::unique_ptr<DepthSource> open_realsense(const std::string& address, Clock& clock);
Availability realsense_availability();

}  // namespace remote_touch
