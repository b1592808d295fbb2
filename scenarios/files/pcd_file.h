// Point cloud files of the Point Cloud Library: PCD versions 0.5 to 0.7, DATA ascii, binary or
// binary_compressed.
#pragma once

#include <filesystem>
#include <string>

#include "core/points/point_cloud.h"

namespace remote_touch {

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
