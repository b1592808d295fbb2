#include "runners/trajectories/surface_support.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/numeric/order_statistic.h"

namespace remote_touch {

DepthImage depth_image(const PointCloud& cloud) {
  const CameraIntrinsics& camera = cloud.image->camera;
  const RigidTransform X_CW = cloud.image->X_WC.inverse();
  DepthImage depth{camera.width, camera.height, std::vector<double>(cloud.size())};
  for (std::size_t i = 0; i < cloud.size(); ++i) depth.z_m[i] = (X_CW * cloud.point(i)).z();
  return depth;
}

double supported_depth(const DepthImage& image, int u, int v, double focal_px, const Support& support) {
  const double z = image.z_m[static_cast<std::size_t>(v) * image.width + u];
  if (!std::isfinite(z)) return std::nan("");
  const int half = std::max(1, static_cast<int>(focal_px * support.margin_m / z));
  if (u <= half || v <= half || u + half >= image.width || v + half >= image.height) return std::nan("");
  std::vector<double> seen;
  for (int y = v - half; y <= v + half; ++y) {
    for (int x = u - half; x <= u + half; ++x) {
      const std::size_t i = static_cast<std::size_t>(y) * image.width + x;
      // NaN fails both comparisons, so a hole ends the search too.
      const bool joined = std::abs(image.z_m[i] - image.z_m[i - 1]) <= support.edge_jump_m &&
                          std::abs(image.z_m[i] - image.z_m[i - image.width]) <= support.edge_jump_m;
      if (!joined) return std::nan("");
      seen.push_back(image.z_m[i]);
    }
  }
  return median_in_place(seen);
}

}  // namespace remote_touch
