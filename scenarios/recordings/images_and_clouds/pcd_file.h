// Point cloud files of the Point Cloud Library: PCD versions 0.5 to 0.7, DATA ascii, binary or
// binary_compressed.
#pragma once

#include <filesystem>
#include <string>

#include "core/geometry/point_cloud.h"

namespace remote_touch {

// width * height points. An organised cloud (height > 1) is row-major: pixel (u, v) is point v * width + u.
struct PcdCloud {
  PointCloud cloud;
  int width = 0;
  int height = 0;  // 1: not organised
  // The camera in the coordinates of the file: the identity but where VIEWPOINT is used, see below.
  RigidTransform X_FC = RigidTransform::Identity();
  bool has_unused_viewpoint = false;  // seen from the file's VIEWPOINT, the points form no image
};

// Reads the fields x, y, z (floats of 4 or 8 bytes, metres) and rgb or rgba (4 bytes, 0xAARRGGBB; the alpha
// is dropped, but see colour_of_float() for TYPE F); other fields are skipped, whatever their SIZE, TYPE and
// COUNT. A colour that is NaN is kNoColour. The camera's frame is the world frame. A point with a coordinate
// that is not finite, or at exactly (0, 0, 0), is a missing measurement: NaN in all three coordinates, in its
// place.
//
// An organised cloud gets cloud.image if a pinhole camera explains it: u = fx x/z + cx and v = fy y/z + cy,
// fitted by least squares, leave every point less than 0.5 px off its pixel. pixel_slack is then the largest
// residual plus 1e-6 px. The camera is at the origin, or at VIEWPOINT if an image can be seen from there:
// then the cloud is in its frame, and X_FC leads back. A VIEWPOINT at the origin may turn the camera.
// Programs disagree whether a VIEWPOINT looks along its z or against it, and which row and column come first:
// the image may be turned round, its last row or column first. Without an image at VIEWPOINT,
// has_unused_viewpoint is set.
//
// Throws InputError if the header or the data cannot be used. Memory is allocated only in proportion to the
// bytes in the file, whatever the header claims. Bytes behind the last point of binary data (padding) are
// ignored.
PcdCloud read_pcd(const std::filesystem::path& file);

}  // namespace remote_touch
