// Layout that all frames of a recording share: images of one camera, or organised clouds without a camera, or
// clouds in no order.
#pragma once

#include <optional>
#include <string>

#include "core/geometry/point_cloud.h"

namespace remote_touch {

struct FrameLayout {
  bool is_organised = false;
  // Camera of images; camera of organised clouds, if a pinhole explains their first frame.
  std::optional<CameraIntrinsics> camera;
};

FrameLayout layout_of(const PointCloud& cloud);

// Makes a later frame, in its camera's frame, one of the layout:
// - With a camera, it must have as many rows and columns, and the camera must see every point less than 1 px
//   off its pixel: the fit of each frame allows 0.5 px. A frame that has no fit of its own, because it has
//   too few points, gets the camera of the layout; it is refused if the camera that its file states was not
//   used, since its points are then in coordinates of the file. A frame without any point becomes an image of
//   holes.
// - An organised cloud without a camera must be organised, or empty. Its size may change, as that of a lidar
//   does, because nothing relates the rows of one frame to those of another.
// - A cloud in no order must be in no order. Its size may change.
// Throws InputError about the subject otherwise.
void conform(const FrameLayout& layout, const std::string& subject, PointCloud& cloud);

// Sets the points of an image beyond max_depth_m, along the axis of its camera, to NaN. A cloud without a
// camera has no depth and stays as it is. Pre: the cloud is in its camera's frame.
void drop_beyond(double max_depth_m, PointCloud& cloud);

}  // namespace remote_touch
