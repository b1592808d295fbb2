// Depth and colour images in files: PNG and NumPy.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/points/point_cloud.h"

namespace remote_touch {

// Missing points, and intrinsics recovered from an organised cloud, for files that store only the points.

inline constexpr double kMaxFitResidual_px = 0.5;  // beyond it a point would belong to another pixel
// Margin for a reader that evaluates the projection in another order of operations.
inline constexpr double kPixelRounding_px = 1e-6;

// Sets all three coordinates of a missing point to NaN. Sensors mark a hole by nan or by the origin.
void mark_missing_points(PointCloud& cloud);

// Returns the pinhole camera that explains a cloud in its camera's frame, in which point v * width + u
// belongs to pixel (u, v): u = fx x/z + cx and v = fy y/z + cy, each fitted by least squares over the valid
// points. pixel_slack is the largest residual plus 1e-6 px. Missing points are NaN. Returns none if a point
// is behind the camera or 0.5 px or more off its pixel, if the image is mirrored, or if the valid points do
// not cover two columns and two rows. Pre: width * height points.
std::optional<ImageLayout> fit_pinhole(const PointCloud& cloud, int width, int height);

// Depth and colour images in PNG files, as RGB-D recordings store them.

// Reads a 16-bit PNG of one channel: z = value * metres_per_unit along the optical axis. The value 0 (no
// measurement) and every z beyond max_depth_m (may be infinite) become NaN. Pre: metres_per_unit > 0 and
// finite. Throws InputError if the file is missing, cut short, damaged or of another pixel format.
DepthImage read_depth_png(const std::filesystem::path& file, double metres_per_unit, double max_depth_m);

// Pixel (u, v) is element v * width + u.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<std::uint16_t> values;
};

// Decodes a 16-bit PNG of one channel that is in memory. name: what an InputError is about.
GreyImage decode_grey_png(std::string_view bytes, const std::string& name);

// Returns pixel (u, v) as element v * width + u, 0xRRGGBB, and sets width and height. A fully transparent
// pixel is kNoColour: an image that was warped to another camera has such pixels where it saw nothing. Other
// values of alpha are ignored. Allowed are RGB and grey of up to 8 bits a channel, with or without alpha, and
// palettes. Samples are used as stored: no gamma or colour profile is applied. Throws InputError as above.
std::vector<std::uint32_t> read_colour_png(const std::filesystem::path& file, int& width, int& height);

// Returns the number whose bytes begin there.
template <class Value>
Value number_at(const char* bytes, bool big_endian = false) {
  static_assert(std::endian::native == std::endian::little);
  std::array<char, sizeof(Value)> own;
  std::copy_n(bytes, own.size(), own.begin());
  if (big_endian) std::reverse(own.begin(), own.end());
  return std::bit_cast<Value>(own);
}

// Depth images in NumPy files (.npy), whose values may be floats. Reads an array of the shape (height, width)
// and the type float32, float64 or uint16, in any byte order and any order of its elements: z = value *
// metres_per_unit, exactly. The values 0, NaN, infinity and, of integers, 65535 (no measurement) and every z
// beyond max_depth_m (may be infinite) become NaN. Pre: metres_per_unit > 0 and finite. Throws InputError if
// the file is missing, cut short, longer than its header says, of another shape or type, or has a negative
// depth.
DepthImage read_depth_npy(const std::filesystem::path& file, double metres_per_unit, double max_depth_m);

// Replaces distances from the camera's centre by depths along its axis. Pre: the image has the camera's size.
void distances_to_depths(const CameraIntrinsics& camera, DepthImage& image);

}  // namespace remote_touch
