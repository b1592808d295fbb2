#include "scenarios/camera_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace remote_touch {

namespace {

constexpr double kFarthest_m = 3;

// Camera axes for a view from `from` to `to` with the world's y up: x right, y down, z forward.
RigidTransform look_at(const Vec3& from, const Vec3& to) {
  const Vec3 forward = (to - from).normalized();
  const Vec3 right = forward.cross(Vec3::UnitY()).normalized();
  RigidTransform X_WC = RigidTransform::Identity();
  X_WC.linear().col(0) = right;
  X_WC.linear().col(1) = forward.cross(right);
  X_WC.linear().col(2) = forward;
  X_WC.translation() = from;
  return X_WC;
}

}  // namespace

Parameters parameters(CameraScene::Settings& s) {
  return {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the camera per second, f_c"},
      {"width", &s.width, 8, 4096, "image columns"},
      {"height", &s.height, 8, 4096, "image rows"},
      {"focal_px", &s.focal_px, 1, 10000,
       "focal length, both axes; the principal point is the image's middle"},
      {"camera_m", &s.camera_m, -10, 10, "position of the camera"},
      {"target_m", &s.target_m, -10, 10, "point that the optical axis passes through"},
      {"noise_per_m", &s.noise_per_m, 0, 0.1, "depth noise: standard deviation = this times z^2"},
      {"quantisation_per_m", &s.quantisation_per_m, 0, 0.1, "depth step = this times z^2; 0 switches it off"},
      {"edge_jump_m", &s.edge_jump_m, 1e-4, 10, "a depth difference larger than this is an edge"},
      {"hole_px", &s.hole_px, 0, 16, "no depth within so many pixels of an edge"},
  };
}

std::string conflict(const CameraScene::Settings& s) {
  const Vec3 view = s.target_m - s.camera_m;
  const bool level = view.cross(Vec3::UnitY()).norm() < 1e-9;
  return level ? "camera_m and target_m: allowed not to be above each other or equal" : "";
}

CameraScene::CameraScene(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings),
      key_(key),
      kernels_(kernels),
      solids_{Extrusion({{-0.33, 0}, {-0.18, 0}, {-0.18, 0.06}}, -0.06, 0.06),
              Extrusion({{0.14, 0}, {0.26, 0}, {0.26, 0.08}, {0.14, 0.08}}, -0.06, 0.06)},
      camera_{settings.width,
              settings.height,
              settings.focal_px,
              settings.focal_px,
              0.5 * (settings.width - 1),
              0.5 * (settings.height - 1)},
      X_WC_(look_at(settings.camera_m, settings.target_m)) {
  cast_rays();
  mark_holes();
}

int CameraScene::frame_count() const {
  return settings_.noise_per_m > 0 ? std::numeric_limits<int>::max() : 1;
}

double CameraScene::surface_height(double x, double z, double) const {
  double height = 0;
  for (const Extrusion& solid : solids_) height = std::max(height, solid.height(x, z));
  return height;
}

// Of the union of the table's half-space and the solids: exact outside.
double CameraScene::signed_distance(const Vec3& p_W, double) const {
  double distance = p_W.y();
  for (const Extrusion& solid : solids_) distance = std::min(distance, solid.signed_distance(p_W));
  return distance;
}

void CameraScene::cast_rays() {
  true_depth_ = {camera_.width, camera_.height, {}};
  true_depth_.z_m.resize(static_cast<std::size_t>(camera_.width) * camera_.height);
  const Vec3 origin = X_WC_.translation();
#pragma omp parallel for schedule(static)
  for (int v = 0; v < camera_.height; ++v) {
    for (int u = 0; u < camera_.width; ++u) {
      // With the ray's camera z equal to 1, t is the depth along the axis.
      const Vec3 ray = X_WC_.linear() * unproject(camera_, u, v, 1);
      double depth = ray.y() < 0 ? -origin.y() / ray.y() : std::numeric_limits<double>::infinity();
      for (const Extrusion& solid : solids_) depth = std::min(depth, solid.cast(origin, ray));
      true_depth_.z_m[static_cast<std::size_t>(v) * camera_.width + u] =
          depth <= kFarthest_m ? depth : std::numeric_limits<double>::quiet_NaN();
    }
  }
}

// Structured light is shadowed and mixed at depth edges; the sensor gives nothing there.
void CameraScene::mark_holes() {
  const int w = camera_.width, h = camera_.height, reach = settings_.hole_px;
  hole_.assign(true_depth_.z_m.size(), 0);
  const auto mark = [&](int u_first, int u_last, int v_first, int v_last) {
    for (int y = std::max(0, v_first); y <= std::min(h - 1, v_last); ++y)
      for (int x = std::max(0, u_first); x <= std::min(w - 1, u_last); ++x)
        hole_[static_cast<std::size_t>(y) * w + x] = 1;
  };
  const auto jumps = [&](std::size_t a, std::size_t b) {
    return std::abs(true_depth_.z_m[a] - true_depth_.z_m[b]) > settings_.edge_jump_m;
  };
  if (reach == 0) return;
  for (int v = 0; v < h; ++v) {
    for (int u = 0; u < w; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * w + u;
      // As many pixels on either side of the edge.
      if (u + 1 < w && jumps(i, i + 1)) mark(u + 1 - reach, u + reach, v - reach, v + reach);
      if (v + 1 < h && jumps(i, i + w)) mark(u - reach, u + reach, v + 1 - reach, v + reach);
    }
  }
}

PointCloud CameraScene::cloud(int frame) const {
  DepthImage measured = true_depth_;
  const NoiseStream stream = noise_stream(key_, NoiseUse::depth, static_cast<std::uint32_t>(frame));
  const double steps = settings_.quantisation_per_m > 0 ? 1 / settings_.quantisation_per_m : 0;
#pragma omp parallel for schedule(static)
  for (int v = 0; v < camera_.height; ++v) {
    const auto width = static_cast<std::size_t>(camera_.width), first = width * static_cast<std::size_t>(v);
    std::vector<std::uint32_t> pixel(width);
    std::iota(pixel.begin(), pixel.end(), static_cast<std::uint32_t>(first));
    std::vector<double> normal(width), unused(width), unused_too(width);
    kernels_.normals(stream, pixel.data(), width, normal.data(), unused.data(), unused_too.data());
    for (std::size_t u = 0; u < width; ++u) {
      double& z = measured.z_m[first + u];
      z += settings_.noise_per_m * z * z * normal[u];
      // The sensor counts whole disparities, proportional to 1/z.
      if (steps > 0) z = steps / std::floor(steps / z + 0.5);
      // Nothing is measured at a hole, nor behind the camera, where strong noise can throw a depth.
      if (hole_[first + u] || !(z > 0)) z = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return cloud_from_depth(measured, camera_, X_WC_);
}

std::shared_ptr<const NeighbourSearch> CameraScene::points(int frame) const {
  return make_search(cloud(frame));
}

}  // namespace remote_touch
