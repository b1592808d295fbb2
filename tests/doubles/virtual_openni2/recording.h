#pragma once

#include <string>

namespace remote_touch::virtual_camera {

// Records depth of the virtual camera with the library's own recorder until so many frames were seen,
// mirrored as the camera is at first. Returns the problem, or an empty text.
std::string record_virtual_camera(const std::string& file, int frames);

}  // namespace remote_touch::virtual_camera
