#include "runners/live/sensors/depth_source.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/parameters/parameter.h"

namespace remote_touch {
namespace {

// Rate at which two crystals may drift apart. The offset rises at this rate. Otherwise the frames of a sensor
// with the slower clock would appear older and older.
constexpr double kDrift = 1e-4;
// No frame arrives later than this after its capture. If one seems to, the sensor's clock has stood still.
constexpr double kLatest_s = 1;

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

using Eigen::Vector2d;

// Positions closer than this are the same. It is below the resolution of a library that computes in floats,
// and too small to matter for a point: 1 um at 0.5 m with a focal length of 500 pixels.
constexpr double kSamePlace_px = 1e-3;
// Largest error of a library's search for the ray of a pixel.
constexpr double kMaxContradiction_px = 0.05;
// Largest relative difference of neighbours on one surface: that of a surface seen at 75 degrees with a focal
// length of 320 pixels or more.
constexpr float kMaxStep = 0.02f;

constexpr int kMaxSide_px = 8192;

// The first and the last of `count` pixels that see something, with their rays.
struct SeenEnds {
  int first = 0, last = 0;
  Vector2d first_ray = Vector2d::Zero(), last_ray = Vector2d::Zero();
};

template <class PixelAt>
std::optional<SeenEnds> ends_of(int count, const Lens& lens, PixelAt pixel_at) {
  SeenEnds ends{0, count - 1};
  std::optional<Vector2d> first, last;
  while (ends.first < count && !(first = lens.ray_of_pixel(pixel_at(ends.first)))) ++ends.first;
  while (ends.last > ends.first && !(last = lens.ray_of_pixel(pixel_at(ends.last)))) --ends.last;
  if (!first || !last) return {};
  ends.first_ray = *first, ends.last_ray = *last;
  return ends;
}

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

Undistortion::Undistortion(const std::string& name, int width, int height, const Lens& lens) {
  if (width < 2 || height < 2 || width > kMaxSide_px || height > kMaxSide_px)
    throw InputError(name, "has images of " + std::to_string(width) + " x " + std::to_string(height) +
                               " pixels: expected 2 to " + std::to_string(kMaxSide_px) + " on a side");
  camera_.width = width, camera_.height = height;
  choose_camera(name, lens);
  places_.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  bool is_same = true;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const std::optional<Vector2d> seen = seen_at(u, v, lens);
      is_same = is_same && seen && (*seen - Vector2d(u, v)).cwiseAbs().maxCoeff() < kSamePlace_px;
      places_.push_back(place_of(seen));
    }
  if (is_same) places_ = {};
}

void Undistortion::choose_camera(const std::string& name, const Lens& lens) {
  const int middle_u = (camera_.width - 1) / 2, middle_v = (camera_.height - 1) / 2;
  const auto row = ends_of(camera_.width, lens, [&](int u) { return Vector2d(u, middle_v); });
  const auto column = ends_of(camera_.height, lens, [&](int v) { return Vector2d(middle_u, v); });
  const double across = row ? row->last_ray.x() - row->first_ray.x() : 0;
  const double down = column ? column->last_ray.y() - column->first_ray.y() : 0;
  if (!(across > 0 && down > 0 && std::isfinite(across) && std::isfinite(down)))
    throw InputError(
        name,
        "has no calibration that can be used: its pixels have no rays from left to right and top to bottom");
  for (const auto& [pixel, ray] : {std::pair(Vector2d(row->first, middle_v), row->first_ray),
                                   std::pair(Vector2d(row->last, middle_v), row->last_ray),
                                   std::pair(Vector2d(middle_u, column->first), column->first_ray),
                                   std::pair(Vector2d(middle_u, column->last), column->last_ray)}) {
    const std::optional<Vector2d> again = lens.pixel_of_ray(ray);
    if (!again || !((*again - pixel).norm() < kMaxContradiction_px))
      throw InputError(
          name, "has a calibration that contradicts itself: the ray of a pixel leads to another pixel");
  }
  camera_.fx = (row->last - row->first) / across;
  camera_.fy = (column->last - column->first) / down;
  camera_.cx = row->first - row->first_ray.x() * camera_.fx;
  camera_.cy = column->first - column->first_ray.y() * camera_.fy;
}

std::optional<Vector2d> Undistortion::seen_at(int u, int v, const Lens& lens) const {
  return lens.pixel_of_ray({(u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy});
}

// Returns pixel -1 for positions outside the centres of the outermost pixels, because no depth is known
// there.
Undistortion::Place Undistortion::place_of(const std::optional<Vector2d>& seen) const {
  const Vector2d last(camera_.width - 1, camera_.height - 1);
  if (!seen ||
      !((seen->array() >= -kSamePlace_px).all() && (seen->array() <= last.array() + kSamePlace_px).all()))
    return {-1, 0, 0};
  const double left = std::clamp(std::floor(seen->x()), 0.0, camera_.width - 2.0);
  const double top = std::clamp(std::floor(seen->y()), 0.0, camera_.height - 2.0);
  return {static_cast<std::int32_t>(top) * camera_.width + static_cast<std::int32_t>(left),
          static_cast<float>(std::clamp(seen->x() - left, 0.0, 1.0)),
          static_cast<float>(std::clamp(seen->y() - top, 0.0, 1.0))};
}

std::uint16_t Undistortion::depth_at(const std::vector<std::uint16_t>& seen, const Place& place) const {
  if (place.pixel < 0) return 0;
  const std::uint16_t* upper = seen.data() + place.pixel;
  const std::uint16_t* lower = upper + camera_.width;
  const int a = upper[0], b = upper[1], c = lower[0], d = lower[1];
  const int least = std::min(std::min(a, b), std::min(c, d)), most = std::max(std::max(a, b), std::max(c, d));
  const float step = static_cast<float>(most - least);
  if (least == 0 || (step > 1 && step > kMaxStep * static_cast<float>(least)))
    return (place.down < 0.5f ? upper : lower)[place.right < 0.5f ? 0 : 1];
  const float above = static_cast<float>(a) + place.right * static_cast<float>(b - a);
  const float below = static_cast<float>(c) + place.right * static_cast<float>(d - c);
  const float raised = above + place.down * (below - above) + 0.5f;  // std::lround takes 1.5 times as long
  return static_cast<std::uint16_t>(raised);
}

void Undistortion::apply(const std::vector<std::uint16_t>& seen, std::vector<std::uint16_t>& depth) const {
  if (places_.empty()) {
    depth = seen;
    return;
  }
  depth.resize(places_.size());
  for (std::size_t i = 0; i < places_.size(); ++i) depth[i] = depth_at(seen, places_[i]);
}

}  // namespace remote_touch
