#include "scenarios/recordings/frame_layout.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/recordings/images_and_clouds/pinhole_fit.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {

namespace {

int rows_of(const PointCloud& cloud) {
  return cloud.columns() == 0 ? 0 : static_cast<int>(cloud.size()) / cloud.columns();
}

std::string size_text(int columns, int rows) {
  return std::to_string(columns) + " x " + std::to_string(rows) + " points";
}

// Returns the largest offset of a projected point from its pixel, along u or v (px). Returns infinity if a
// point is not in front of the camera.
double residual_px(const CameraIntrinsics& camera, const PointCloud& cloud) {
  double worst = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    if (!(cloud.z[i] > 0)) return std::numeric_limits<double>::infinity();
    const int place = static_cast<int>(i), u = place % camera.width, v = place / camera.width;
    worst = std::max({worst, std::abs(camera.fx * cloud.x[i] / cloud.z[i] + camera.cx - u),
                      std::abs(camera.fy * cloud.y[i] / cloud.z[i] + camera.cy - v)});
  }
  return worst;
}

PointCloud image_of_holes(const CameraIntrinsics& camera) {
  PointCloud cloud;
  const auto pixels = camera.pixels();
  cloud.x.assign(pixels, std::nan("")), cloud.y = cloud.x, cloud.z = cloud.x;
  cloud.grid_columns = camera.width;
  return cloud;
}

void conform_to_camera(const CameraIntrinsics& camera, const std::string& subject, PointCloud& cloud) {
  if (cloud.size() == 0) cloud = image_of_holes(camera);
  if (cloud.columns() != camera.width || rows_of(cloud) != camera.height)
    refuse(subject, "has ", size_text(cloud.columns(), rows_of(cloud)), ": expected ",
           size_text(camera.width, camera.height), ", as the first frame that is used has");
  // A depth image has the recording's camera. It is not tested, because a lens may bend its rays by more than
  // a pixel.
  if (cloud.image && cloud.image->camera == camera) return;
  const double residual = residual_px(camera, cloud);
  if (!(residual < (cloud.image ? 2 * kMaxFitResidual_px : kMaxFitResidual_px)))
    refuse(subject,
           "has another camera than the first frame that is used, or none: expected points at the "
           "pixels of the same camera");
  if (!cloud.image)
    cloud.image = ImageLayout{camera, RigidTransform::Identity(), residual + kPixelRounding_px};
}

}  // namespace

FrameLayout layout_of(const PointCloud& cloud) {
  FrameLayout layout{cloud.columns() > 0, {}};
  if (cloud.image) layout.camera = cloud.image->camera;
  return layout;
}

void conform(const FrameLayout& layout, const std::string& subject, PointCloud& cloud) {
  if (cloud.size() > 0 && layout.is_organised != (cloud.columns() > 0))
    refuse(subject, layout.is_organised
                        ? "has points in no order: expected an organised cloud, as the first frame "
                          "that is used is"
                        : "is an organised cloud: expected points in no order, as the first frame "
                          "that is used has");
  if (layout.camera)
    conform_to_camera(*layout.camera, subject, cloud);
  else
    cloud.image.reset();
}

void drop_beyond(double max_depth_m, PointCloud& cloud) {
  for (std::size_t i = 0; cloud.image && i < cloud.size(); ++i) {
    if (!(cloud.z[i] > max_depth_m)) continue;
    cloud.x[i] = cloud.y[i] = cloud.z[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

}  // namespace remote_touch
