// Images as drivers deliver them: rows of pixels with gaps between them, sometimes mirrored.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/geometry/point_cloud.h"

namespace remote_touch {

struct PixelRows {
  const void* first = nullptr;
  std::size_t bytes = 0;  // number of bytes that may be read
  int width = 0, height = 0;
  std::size_t stride = 0;  // bytes from row to row
  bool is_mirrored = false;
};

// copy_depth() and copy_rgb() undo the mirroring. They return false, and read nothing, if the image has
// another size than the camera's, or fewer bytes than it needs.
bool copy_depth(const PixelRows& rows, const CameraIntrinsics& camera, std::vector<std::uint16_t>& depth);
// Each pixel has three bytes: red, green, blue.
bool copy_rgb(const PixelRows& rows, const CameraIntrinsics& camera, std::vector<std::uint32_t>& colour);

}  // namespace remote_touch
