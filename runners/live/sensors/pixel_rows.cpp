#include "runners/live/sensors/pixel_rows.h"

#include <algorithm>
#include <cstring>

namespace remote_touch {

namespace {

// Calls copy_row(source, destination) for each row.
template <class Pixel, class CopyRow>
bool copy_rows(const PixelRows& rows, const CameraIntrinsics& camera, std::size_t pixel_bytes,
               std::vector<Pixel>& pixels, CopyRow copy_row) {
  if (rows.first == nullptr || rows.width != camera.width || rows.height != camera.height) return false;
  const std::size_t width = static_cast<std::size_t>(rows.width);
  const std::size_t height = static_cast<std::size_t>(rows.height);
  const std::size_t row_bytes = width * pixel_bytes;
  if (width == 0 || height == 0 || rows.stride < row_bytes) return false;
  if (rows.bytes < row_bytes || (rows.bytes - row_bytes) / rows.stride < height - 1) return false;
  pixels.resize(width * height);
  for (std::size_t v = 0; v < height; ++v) {
    Pixel* row = pixels.data() + v * width;
    copy_row(static_cast<const std::uint8_t*>(rows.first) + v * rows.stride, row);
    if (rows.is_mirrored) std::reverse(row, row + width);
  }
  return true;
}

}  // namespace

bool copy_depth(const PixelRows& rows, const CameraIntrinsics& camera, std::vector<std::uint16_t>& depth) {
  const std::size_t bytes = static_cast<std::size_t>(rows.width) * sizeof(std::uint16_t);
  return copy_rows(rows, camera, sizeof(std::uint16_t), depth,
                   [bytes](const std::uint8_t* from, std::uint16_t* to) { std::memcpy(to, from, bytes); });
}

bool copy_rgb(const PixelRows& rows, const CameraIntrinsics& camera, std::vector<std::uint32_t>& colour) {
  return copy_rows(rows, camera, 3, colour, [&rows](const std::uint8_t* from, std::uint32_t* to) {
    for (int u = 0; u < rows.width; ++u, from += 3)
      to[u] = static_cast<std::uint32_t>(from[0] << 16 | from[1] << 8 | from[2]);
  });
}

}  // namespace remote_touch
