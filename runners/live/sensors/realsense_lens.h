// The lens of a RealSense camera.
#pragma once

#include "runners/live/sensors/realsense_library.h"
#include "runners/live/sensors/undistortion.h"

namespace remote_touch::rs2 {

// True if the image is distorted; false for a pinhole camera.
bool has_distortion(const Intrinsics& intrinsics);

// Returns a lens that calls the library's own functions, because the meaning of a model's coefficients has
// changed between versions. Throws InputError, with this name, for a model that some versions cannot invert,
// and for versions before 2.46, which lack these functions. The library must outlive the lens.
Lens lens_of(const std::string& name, const RealSenseLibrary& rs2, const Intrinsics& intrinsics);

}  // namespace remote_touch::rs2
