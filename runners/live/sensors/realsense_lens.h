// The lens of a RealSense camera.
#pragma once

#include "runners/live/sensors/realsense_library.h"
#include "runners/live/sensors/undistortion.h"

namespace remote_touch::rs2 {

// Without distortion the camera is a pinhole camera as it is.
bool has_distortion(const Intrinsics& intrinsics);

// Asks the library, because what the coefficients of a model mean has changed between versions: of models
// that some versions cannot invert, and of versions before 2.46, which have no such functions, a distorted
// image is refused. Throws InputError with this name. The library must outlive the lens.
Lens lens_of(const std::string& name, const RealSenseLibrary& rs2, const Intrinsics& intrinsics);

}  // namespace remote_touch::rs2
