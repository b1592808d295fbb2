#include "runners/experiment/hand/image_frames.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

// The largest distance, in pixels along one axis, between the pixel of a measured point and the pixel at
// which the camera sees that point. Infinite if a point is behind the camera. pre: the cloud has a point per
// pixel.
double largest_error_px(const PointCloud& cloud, const RigidTransform& X_CW, const CameraIntrinsics& camera) {
  double largest = 0;
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * camera.width + u;
      if (!cloud.is_measured(i)) continue;
      const Vec3 p_C = X_CW * cloud.point(i);
      if (!(p_C.z() > 0)) return std::numeric_limits<double>::infinity();
      largest = std::max({largest, std::abs(camera.fx * p_C.x() / p_C.z() + camera.cx - u),
                          std::abs(camera.fy * p_C.y() / p_C.z() + camera.cy - v)});
    }
  return largest;
}

// Returns the depth image of the cloud. All pixels are NaN if the cloud does not have a point per pixel.
DepthImage depth_of(const PointCloud& cloud, const ImageLayout& layout) {
  const CameraIntrinsics& camera = layout.camera;
  const RigidTransform X_CW = layout.X_WC.inverse();
  DepthImage depth{camera.width, camera.height, std::vector<double>(camera.pixels(), std::nan(""))};
  if (cloud.size() != depth.z_m.size()) return depth;
  for (std::size_t i = 0; i < cloud.size(); ++i) depth.z_m[i] = (X_CW * cloud.point(i)).z();
  return depth;
}

// Returns why the first frame of the scenario is no image, and what is expected.
std::string no_image_text(const Scenario& scenario, const PointCloud& cloud) {
  if (scenario.input().empty())
    return "the scene has no camera: expected a scenario with one (recording, mesh-scene, camera-scene, "
           "beating-heart, valve-tank)";
  if (cloud.grid_columns == 0) return "the frames are not images: expected a recording with a camera";
  return "the rows and columns of the recording are no image of a camera: expected clouds in the frame of "
         "the camera that are not mirrored";
}

}  // namespace

FrameImage first_image(const Scenario& scenario, const std::string& subject) {
  const PointCloud cloud = scenario.cloud(0);
  if (!cloud.image) throw InputError(subject, no_image_text(scenario, cloud));
  if (cloud.size() != cloud.image->camera.pixels())
    throw InputError(subject, "frame 0 has " + std::to_string(cloud.size()) + " points: expected " +
                                  size_text(cloud.image->camera));
  if (!cloud.has_measured_point())
    throw InputError(subject,
                     "no pixel of the first frame has a depth: expected a camera that sees a surface");
  return {*cloud.image, depth_of(cloud, *cloud.image)};
}

void require_image_of(const ImageLayout& first, const PointCloud& frame, int number,
                      const std::string& subject) {
  constexpr double kFits_px = 1;
  const auto refuse = [&](const std::string& problem) {
    throw InputError(subject, "frame " + std::to_string(number) + " " + problem);
  };
  const CameraIntrinsics& camera = first.camera;
  if (!frame.has_measured_point()) return;
  const bool has_size = !frame.image || (frame.image->camera.width == camera.width &&
                                         frame.image->camera.height == camera.height);
  if (!has_size || frame.size() != camera.pixels())
    refuse("has " + (has_size ? std::to_string(frame.size()) + " points" : size_text(frame.image->camera)) +
           ": expected " + size_text(camera) + ", as frame 0 has");
  if (frame.image && frame.image->camera == camera) return;  // the layout promises that the points fit
  const RigidTransform& X_WC = frame.image ? frame.image->X_WC : first.X_WC;
  const double error_px = largest_error_px(frame, X_WC.inverse(), camera);
  if (error_px <= kFits_px + first.pixel_slack + (frame.image ? frame.image->pixel_slack : 0)) return;
  if (!frame.image) refuse("is not an image: expected an image of the camera of frame 0 in every frame");
  char text[200];
  std::snprintf(text, sizeof text,
                "has another camera (f = %.6g, %.6g, c = %.6g, %.6g): expected that of frame 0 (f = %.6g, "
                "%.6g, c = %.6g, %.6g)",
                frame.image->camera.fx, frame.image->camera.fy, frame.image->camera.cx,
                frame.image->camera.cy, camera.fx, camera.fy, camera.cx, camera.cy);
  refuse(text);
}

FrameImage image_of(const Scenario& scenario, int frame, const ImageLayout& first,
                    const std::string& subject) {
  const PointCloud cloud = scenario.cloud(frame);
  require_image_of(first, cloud, frame, subject);
  ImageLayout layout = first;
  if (cloud.image) layout.X_WC = cloud.image->X_WC;
  return {layout, depth_of(cloud, layout)};
}

}  // namespace remote_touch
