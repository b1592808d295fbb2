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

// Checks that a later frame, in its camera's frame, has the layout. Adds the camera of the layout if the
// frame has none of its own, and removes the frame's camera if the layout has none. Throws InputError about
// the subject in these cases:
// - The layout has a camera, and the frame has another number of rows or columns. A frame without any point
//   becomes an image of holes.
// - The layout has a camera, and it sees a point off its pixel: by 1 px or more if the frame has a camera of
//   its own, which was fitted with residuals of up to 0.5 px; by 0.5 px or more if it has none, because it
//   has too few points for a fit. A frame whose VIEWPOINT is not used has its points in coordinates of the
//   file and usually fails here.
// - The layout is organised without a camera, and the frame is neither organised nor empty. Its size may
//   differ, as with a lidar, because the rows of one frame are not related to those of another.
// - The layout is a cloud in no order, and the frame is organised. Its size may differ.
void conform(const FrameLayout& layout, const std::string& subject, PointCloud& cloud);

// Sets the points of an image beyond max_depth_m, along the axis of its camera, to NaN. A cloud without a
// camera has no depth and is not changed. Pre: the cloud is in its camera's frame.
void drop_beyond(double max_depth_m, PointCloud& cloud);

}  // namespace remote_touch
