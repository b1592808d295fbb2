#include "core/points/camera.h"

#include <stdexcept>

namespace remote_touch {

Vec3 unproject(const CameraIntrinsics& camera, double u, double v, double z_m) {
  return {(u - camera.cx) * z_m / camera.fx, (v - camera.cy) * z_m / camera.fy, z_m};
}

std::string size_text(const CameraIntrinsics& camera) {
  return std::to_string(camera.width) + " x " + std::to_string(camera.height) + " pixels";
}

namespace {

void require_size(const DepthImage& depth, const CameraIntrinsics& camera) {
  if (depth.width != camera.width || depth.height != camera.height)
    throw std::invalid_argument("depth image: " + std::to_string(depth.width) + " x " +
                                std::to_string(depth.height) + " pixels: expected the camera's " +
                                size_text(camera));
  if (depth.z_m.size() != camera.pixels())
    throw std::invalid_argument("depth image: " + std::to_string(depth.z_m.size()) +
                                " depths: expected one for each of " + size_text(camera));
}

}  // namespace

PointCloud cloud_from_depth(const DepthImage& depth, const CameraIntrinsics& camera,
                            const RigidTransform& X_WC) {
  require_size(depth, camera);
  PointCloud cloud;
  const std::size_t count = depth.z_m.size();
  cloud.x.resize(count), cloud.y.resize(count), cloud.z.resize(count);
  // A pixel projects back onto itself up to rounding; 1e-6 px covers it for every image size in use.
  cloud.image = ImageLayout{camera, X_WC, 1e-6};
#pragma omp parallel for schedule(static)
  for (int v = 0; v < depth.height; ++v) {
    for (int u = 0; u < depth.width; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * depth.width + u;
      const Vec3 p_W = X_WC * unproject(camera, u, v, depth.z_m[i]);  // NaN depth gives a NaN point
      cloud.x[i] = p_W.x(), cloud.y[i] = p_W.y(), cloud.z[i] = p_W.z();
    }
  }
  return cloud;
}

}  // namespace remote_touch
