#include "scenarios/camera/camera_scene.h"

#include <algorithm>
#include <limits>

namespace remote_touch {

Parameters parameters(CameraScene::Settings& s) {
  return appended({{"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the camera per second, f_c"}},
                  parameters(s.camera));
}

CameraScene::CameraScene(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : frame_rate_hz_(settings.frame_rate_hz),
      solids_{Extrusion({{-0.33, 0}, {-0.18, 0}, {-0.18, 0.06}}, -0.06, 0.06),
              Extrusion({{0.14, 0}, {0.26, 0}, {0.26, 0.08}, {0.14, 0.08}}, -0.06, 0.06)},
      camera_(settings.camera, key, kernels),
      view_(camera_.view([this](const Vec3& origin_W, const Vec3& ray_W) { return cast(origin_W, ray_W); },
                         /*coloured=*/false)) {}

int CameraScene::frame_count() const {
  return camera_.noisy() ? std::numeric_limits<int>::max() : 1;
}

double CameraScene::surface_height(double x, double z, double) const {
  double height = 0;
  for (const Extrusion& solid : solids_) height = std::max(height, solid.height(x, z));
  return height;
}

// Distance to the union of the table's half-space and the solids; exact outside.
double CameraScene::signed_distance(const Vec3& p_W, double) const {
  double distance = p_W.y();
  for (const Extrusion& solid : solids_) distance = std::min(distance, solid.signed_distance(p_W));
  return distance;
}

RayHit CameraScene::cast(const Vec3& origin_W, const Vec3& ray_W) const {
  RayHit hit;
  if (ray_W.y() < 0) hit.t = -origin_W.y() / ray_W.y();
  for (const Extrusion& solid : solids_) hit.t = std::min(hit.t, solid.cast(origin_W, ray_W));
  return hit;
}

}  // namespace remote_touch
