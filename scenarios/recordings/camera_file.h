// The camera of a folder of depth images: the file camera.json.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/point_cloud.h"

namespace remote_touch {

struct ImageCamera {
  CameraIntrinsics camera;
  double metres_per_unit = 0;  // size of one unit of the depth images
  bool colour_registered = false;
  std::string source;            // origin of the camera, for the user: "camera.json"
  double frame_rate_hz = 0;      // 0: not stated
  bool depth_along_ray = false;  // the images hold distances from the camera's centre
};

// camera.json is an object with the keys width, height, fx, fy, cx, cy, depth_scale_m, and, if wanted,
// frame_rate_hz, colour_registered (default false) and depth_along ("axis", the default, or "ray"). Pixels,
// metres per unit, hertz. Other keys are refused, so that a misspelt one is found. Throws InputError about
// the file if it is not as above.
ImageCamera read_camera_file(const std::filesystem::path& file);

// Returns frame_rate_hz only, which is then required, while width and the like may be missing.
double read_frame_rate(const std::filesystem::path& file);

}  // namespace remote_touch
