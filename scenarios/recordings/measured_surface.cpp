#include "scenarios/recordings/measured_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "scenarios/meshes/mesh_object.h"

namespace remote_touch {

namespace {

// The plane through the pixels of a window: the mean of all points, and a normal from the differences along
// its rows and columns. Not usable if a pixel is missing, or if the depths in the camera differ by more than
// max_width_m, which indicates an edge.
struct Patch {
  Vec3 mean = Vec3::Zero(), normal = Vec3::Zero();
  bool usable = false;
};

Patch patch_around(const PointCloud& cloud, const RigidTransform& X_CW, int u, int v, int half,
                   double max_width_m) {
  const CameraIntrinsics& camera = cloud.image->camera;
  Patch patch;
  if (u < half || v < half || u + half >= camera.width || v + half >= camera.height) return patch;
  Vec3 across = Vec3::Zero(), down = Vec3::Zero();
  double min_depth = std::numeric_limits<double>::infinity(), max_depth = -min_depth;
  for (int y = -half; y <= half; ++y) {
    for (int x = -half; x <= half; ++x) {
      const Vec3 p = cloud.point(static_cast<std::size_t>(v + y) * camera.width + (u + x));
      if (!p.allFinite()) return patch;
      patch.mean += p, across += x * p, down += y * p;
      const double depth = (X_CW * p).z();
      min_depth = std::min(min_depth, depth), max_depth = std::max(max_depth, depth);
    }
  }
  patch.mean /= (2 * half + 1) * (2 * half + 1);
  patch.normal = down.cross(across).normalized();  // towards the camera: x right, y down, z forward
  patch.usable = max_depth - min_depth <= max_width_m && patch.normal.allFinite();
  return patch;
}

}  // namespace

double distance_to_measured(const PointCloud& cloud, const Vec3& p_W, double radius_m) {
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  if (!p_W.allFinite() || !cloud.image) return unknown;
  const RigidTransform X_CW = cloud.image->X_WC.inverse();
  const Vec3 p_C = X_CW * p_W;
  const CameraIntrinsics& camera = cloud.image->camera;
  const std::optional<std::size_t> pixel = pixel_of(camera, p_C);
  if (!pixel) return unknown;
  const double half = std::clamp(camera.fx * radius_m / p_C.z(), 1.0, 1.0 * camera.width);
  const Patch patch =
      patch_around(cloud, X_CW, static_cast<int>(*pixel) % camera.width,
                   static_cast<int>(*pixel) / camera.width, static_cast<int>(half), 4 * radius_m);
  return patch.usable ? (p_W - patch.mean).dot(patch.normal) : unknown;
}

}  // namespace remote_touch
