// Depth images, colour images and point clouds in files: PNG, NumPy and PCD.
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

// Point cloud files of the Point Cloud Library: PCD versions 0.5 to 0.7, DATA ascii, binary or
// binary_compressed.

// width * height points. An organised cloud (height > 1) is row-major: pixel (u, v) is point v * width + u.
struct PcdCloud {
  PointCloud cloud;
  int width = 0;
  int height = 0;  // 1: not organised
  // Pose of the camera in the coordinates of the file. It is the identity unless VIEWPOINT is used, see
  // below.
  RigidTransform X_FC = RigidTransform::Identity();
  bool has_unused_viewpoint = false;  // seen from the file's VIEWPOINT, the points form no image
};

// Reads the fields x, y, z (floats of 4 or 8 bytes, metres) and rgb or rgba (4 bytes, 0xAARRGGBB). The alpha
// is dropped, but see colour_of_float() for TYPE F. Other fields are skipped, with any SIZE, TYPE and COUNT.
// A colour that is NaN is kNoColour. The camera's frame is the world frame. A point with a coordinate that is
// not finite, or at exactly (0, 0, 0), is a missing measurement: it keeps its index, and its three
// coordinates are NaN.
//
// An organised cloud gets cloud.image if a pinhole camera explains it: u = fx x/z + cx and v = fy y/z + cy
// are fitted by least squares, and every point must be less than 0.5 px off its pixel. pixel_slack is then
// the largest residual plus 1e-6 px. The camera is at the origin, or at VIEWPOINT if the points form an image
// when seen from there. In the latter case the cloud is in the camera's frame, and X_FC transforms it back to
// the file's. A VIEWPOINT at the origin may still rotate the camera. Programs disagree about the direction of
// view (along z of VIEWPOINT or against it) and about which row and column come first. Therefore both
// directions are tried, each with the rows, the columns, both or neither reversed. If the cloud forms no
// image at VIEWPOINT, or is in no order, has_unused_viewpoint is set.
//
// Throws InputError if the header or the data cannot be used. Memory is allocated only in proportion to the
// bytes in the file, regardless of the sizes in the header. Bytes behind the last point of binary data
// (padding) are ignored.
PcdCloud read_pcd(const std::filesystem::path& file);

}  // namespace remote_touch
