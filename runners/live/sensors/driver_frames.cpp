#include "runners/live/sensors/driver_frames.h"

#include <algorithm>
#include <cstring>

namespace remote_touch {
namespace {

// Rate at which two crystals may drift apart. The offset rises at this rate. Otherwise the frames of a sensor
// with the slower clock would appear older and older.
constexpr double kDrift = 1e-4;
// No frame arrives later than this after its capture. If one seems to, the sensor's clock has stood still.
constexpr double kLatest_s = 1;

}  // namespace

double SensorClock::captured_s(double stamp_s, double arrived_s) {
  const double difference_s = arrived_s - stamp_s, passed_s = stamp_s - stamp_s_;
  // Time stamps go back if a sensor is reset or a recording starts again.
  if (!has_begun_ || passed_s < 0 || difference_s - offset_s_ > kLatest_s) {
    offset_s_ = difference_s;
  } else {
    offset_s_ = std::min(offset_s_ + kDrift * passed_s, difference_s);
  }
  double captured_s = stamp_s + offset_s_;
  // An offset that falls by more than a period would reverse the order of two frames.
  if (has_begun_ && captured_s <= captured_s_) captured_s = captured_s_ + 0.5 * (arrived_s - captured_s_);
  has_begun_ = true;
  stamp_s_ = stamp_s, captured_s_ = captured_s;
  return captured_s;
}

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
