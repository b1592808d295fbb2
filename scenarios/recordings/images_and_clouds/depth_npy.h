// Depth images in NumPy files (.npy), whose values may be floats.
#pragma once

#include <filesystem>

#include "core/geometry/camera.h"

namespace remote_touch {

// Reads an array of the shape (height, width) and the type float32, float64 or uint16, in any byte order and
// any order of its elements: z = value * metres_per_unit, exactly. The values 0, NaN, infinity and, of
// integers, 65535 (no measurement) and every z beyond max_depth_m (may be infinite) become NaN. Pre:
// metres_per_unit > 0 and finite. Throws InputError if the file is missing, cut short, longer than its header
// says, of another shape or type, or has a negative depth.
DepthImage read_depth_npy(const std::filesystem::path& file, double metres_per_unit, double max_depth_m);

// Replaces distances from the camera's centre by depths along its axis. Pre: the image has the camera's size.
void distances_to_depths(const CameraIntrinsics& camera, DepthImage& image);

}  // namespace remote_touch
