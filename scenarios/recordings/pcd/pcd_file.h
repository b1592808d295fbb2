// Point cloud files of the Point Cloud Library: PCD version 0.7, DATA ascii, binary or binary_compressed.
#pragma once

#include <filesystem>

#include "core/cloud/point_cloud.h"

namespace remote_touch {

// width * height points. An organised cloud (height > 1) is row-major: pixel (u, v) is point v * width + u.
struct PcdCloud {
  PointCloud cloud;
  int width = 0;
  int height = 0;  // 1: not organised
};

// Reads the fields x, y, z (floats of 4 or 8 bytes, metres) and rgb or rgba (4 bytes, 0xAARRGGBB; the alpha
// is dropped); other fields are skipped, whatever their SIZE, TYPE and COUNT. The sensor's frame is the world
// frame: VIEWPOINT is not applied. A point with a coordinate that is not finite, or at exactly (0, 0, 0), is
// a missing measurement: NaN in all three coordinates, in its place.
//
// An organised cloud gets cloud.image if a pinhole camera explains it: u = fx x/z + cx and v = fy y/z + cy,
// fitted by least squares, leave every point less than 0.5 px off its pixel. pixel_slack is then the largest
// residual plus 1e-6 px.
//
// Throws InputError if the header or the data cannot be used. Memory is allocated only in proportion to the
// bytes in the file, whatever the header claims. Bytes behind the last point of binary data (padding) are
// ignored.
PcdCloud read_pcd(const std::filesystem::path& file);

}  // namespace remote_touch
