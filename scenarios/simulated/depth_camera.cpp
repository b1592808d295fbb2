#include "scenarios/simulated/depth_camera.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace remote_touch {

namespace {

constexpr double kMaxRange_m = 3;
constexpr double kSamePlace_m = 1e-9;

}  // namespace

Parameters parameters(DepthCameraSettings& s) {
  return {
      {"width", &s.width, 8, 4096, "image columns"},
      {"height", &s.height, 8, 4096, "image rows"},
      {"focal_px", &s.focal_px, 1, 10000,
       "focal length, both axes; the principal point is the image's middle"},
      {"camera_position_m", &s.camera_position_m, -10, 10, "position of the camera"},
      {"target_position_m", &s.target_position_m, -10, 10, "point that the camera looks at"},
      {"noise_per_m", &s.noise_per_m, 0, 0.1,
       "depth noise: standard deviation = this value times z^2, with z the depth", kLive},
      {"quantisation_per_m", &s.quantisation_per_m, 0, 0.1,
       "depth quantisation: step = this value times z^2, with z the depth; 0: off"},
      {"edge_jump_m", &s.edge_jump_m, 1e-4, 10,
       "depth difference between neighbouring pixels above which there is a depth edge"},
      {"hole_px", &s.hole_px, 0, 16, "number of pixels without depth on each side of a depth edge"},
  };
}

std::string validate(const DepthCameraSettings& s) {
  const bool same = (s.target_position_m - s.camera_position_m).norm() < kSamePlace_m;
  return same ? "camera_position_m and target_position_m: expected two different positions" : "";
}

RigidTransform look_at(const Vec3& from, const Vec3& to) {
  assert(from != to);
  const Vec3 forward = (to - from).normalized();
  const Vec3 level = forward.cross(Vec3::UnitY());
  const bool upright = (to - from).cross(Vec3::UnitY()).norm() < kSamePlace_m;
  const Vec3 right = upright ? Vec3(Vec3::UnitX()) : level.normalized();
  RigidTransform X_WC = RigidTransform::Identity();
  X_WC.linear().col(0) = right;
  X_WC.linear().col(1) = forward.cross(right);
  X_WC.linear().col(2) = forward;
  X_WC.translation() = from;
  return X_WC;
}

DepthCamera::DepthCamera(const DepthCameraSettings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings),
      key_(key),
      kernels_(kernels),
      intrinsics_{settings.width,
                  settings.height,
                  settings.focal_px,
                  settings.focal_px,
                  0.5 * (settings.width - 1),
                  0.5 * (settings.height - 1)},
      X_WC_(look_at(settings.camera_position_m, settings.target_position_m)) {}

IdealView DepthCamera::view(const RayCast& cast, bool coloured) const {
  const int width = intrinsics_.width, height = intrinsics_.height;
  const std::size_t count = static_cast<std::size_t>(width) * height;
  IdealView view{{width, height, std::vector<double>(count)}, {}, {}, {}};
  if (coloured) view.colour.resize(count);
  const Vec3 origin = X_WC_.translation();
#pragma omp parallel for schedule(static)
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      // The ray has z = 1 in the camera's frame, so t is the depth along the optical axis.
      const Vec3 ray = X_WC_.linear() * unproject(intrinsics_, u, v, 1);
      const RayHit hit = cast(origin, ray);
      const std::size_t i = static_cast<std::size_t>(v) * width + u;
      view.depth.z_m[i] = hit.t <= kMaxRange_m ? hit.t : std::numeric_limits<double>::quiet_NaN();
      if (coloured) view.colour[i] = hit.colour;
    }
  }
  view.hole = holes(view.depth);
  return view;
}

// Structured light is shadowed and mixed at depth edges, so the sensor measures no depth there.
std::vector<char> DepthCamera::holes(const DepthImage& ideal) const {
  const int w = ideal.width, h = ideal.height, reach = settings_.hole_px;
  std::vector<char> hole(ideal.z_m.size(), 0);
  const auto mark = [&](int u_first, int u_last, int v_first, int v_last) {
    for (int y = std::max(0, v_first); y <= std::min(h - 1, v_last); ++y)
      for (int x = std::max(0, u_first); x <= std::min(w - 1, u_last); ++x)
        hole[static_cast<std::size_t>(y) * w + x] = 1;
  };
  const auto jumps = [&](std::size_t a, std::size_t b) {
    return std::abs(ideal.z_m[a] - ideal.z_m[b]) > settings_.edge_jump_m;
  };
  if (reach == 0) return hole;
  for (int v = 0; v < h; ++v) {
    for (int u = 0; u < w; ++u) {
      const std::size_t i = static_cast<std::size_t>(v) * w + u;
      // The hole reaches `reach` pixels to either side of the edge.
      if (u + 1 < w && jumps(i, i + 1)) mark(u + 1 - reach, u + reach, v - reach, v + reach);
      if (v + 1 < h && jumps(i, i + w)) mark(u - reach, u + reach, v + 1 - reach, v + reach);
    }
  }
  return hole;
}

IdealView DepthCamera::view(DepthImage depth, std::vector<std::uint32_t> colour) const {
  IdealView view{std::move(depth), {}, std::move(colour), {}};
  view.hole = holes(view.depth);
  return view;
}

PointCloud DepthCamera::measured(const IdealView& view, int frame) const {
  PointCloud cloud = cloud_from_depth(measured_depth(view, frame), intrinsics_, X_WC_);
  cloud.colour = view.colour;
  return cloud;
}

DepthImage DepthCamera::measured_depth(const IdealView& view, int frame) const {
  DepthImage depth = view.depth;
  const NoiseStream stream = noise_stream(key_, NoiseUse::depth, static_cast<std::uint32_t>(frame));
#pragma omp parallel for schedule(static)
  for (int v = 0; v < intrinsics_.height; ++v) measure_row(view, stream, v, depth);
  return depth;
}

// Replaces the ideal depths of a row by measured ones: noisy, quantised, and NaN at holes.
void DepthCamera::measure_row(const IdealView& view, const NoiseStream& stream, int row,
                              DepthImage& depth) const {
  const auto width = static_cast<std::size_t>(intrinsics_.width);
  const std::size_t first = width * static_cast<std::size_t>(row);
  const double steps = settings_.quantisation_per_m > 0 ? 1 / settings_.quantisation_per_m : 0;
  std::vector<std::uint32_t> pixel(width);
  std::iota(pixel.begin(), pixel.end(), static_cast<std::uint32_t>(first));
  std::vector<double> normal(width), unused(width), unused_too(width);
  kernels_.noise.normals(stream, pixel.data(), width, normal.data(), unused.data(), unused_too.data());
  for (std::size_t u = 0; u < width; ++u) {
    double& z = depth.z_m[first + u];
    const double factor = view.depth_noise_factor.empty() ? 1 : view.depth_noise_factor[first + u];
    z += settings_.noise_per_m * z * z * normal[u] * factor;
    // The sensor measures disparity, which is proportional to 1/z, in whole steps.
    if (steps > 0) z = steps / std::floor(steps / z + 0.5);
    // A hole has no depth. Strong noise can move a depth behind the camera, and a step can be larger than the
    // disparity, which then is rounded to 0; such depths are lost too.
    if (view.hole[first + u] || !(z > 0 && std::isfinite(z))) z = std::numeric_limits<double>::quiet_NaN();
  }
}

Extrusion::Extrusion(std::vector<std::array<double, 2>> profile, double x_low, double x_high)
    : profile_(std::move(profile)), x_low_(x_low), x_high_(x_high) {}

namespace {

struct Edge {
  double z, y, dz, dy;  // start and direction, counter-clockwise: the inside is on the left
  double length_squared() const { return dz * dz + dy * dy; }
  // Distance of a point from the edge's line, multiplied by the edge's length; positive outside.
  double scaled_distance(double pz, double py) const { return dy * (pz - z) - dz * (py - y); }
};

Edge edge(const std::vector<std::array<double, 2>>& profile, std::size_t i) {
  const auto& a = profile[i];
  const auto& b = profile[(i + 1) % profile.size()];
  return {a[0], a[1], b[0] - a[0], b[1] - a[1]};
}

}  // namespace

double Extrusion::signed_distance(const Vec3& p) const {
  double nearest_squared = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (std::size_t i = 0; i < profile_.size(); ++i) {
    const Edge e = edge(profile_, i);
    const double pz = p.z() - e.z, py = p.y() - e.y;
    const double t = std::clamp((pz * e.dz + py * e.dy) / e.length_squared(), 0.0, 1.0);
    const double rz = pz - t * e.dz, ry = py - t * e.dy;
    nearest_squared = std::min(nearest_squared, rz * rz + ry * ry);
    inside &= e.scaled_distance(p.z(), p.y()) <= 0;
  }
  const double across = inside ? -std::sqrt(nearest_squared) : std::sqrt(nearest_squared);
  const double beside = std::max(x_low_ - p.x(), p.x() - x_high_);
  if (across > 0 && beside > 0) return std::sqrt(across * across + beside * beside);
  return std::max(across, beside);
}

// Clips the ray at every face. The part that is left is inside the solid, and its start is the entry.
double Extrusion::cast(const Vec3& origin, const Vec3& direction) const {
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  const auto clip = [&](double height, double slope) {  // outside where height + t slope > 0
    if (slope > 0)
      leave = std::min(leave, -height / slope);
    else if (slope < 0)
      enter = std::max(enter, -height / slope);
    else if (height > 0)
      leave = -1;
  };
  for (std::size_t i = 0; i < profile_.size(); ++i) {
    const Edge e = edge(profile_, i);
    clip(e.scaled_distance(origin.z(), origin.y()), e.dy * direction.z() - e.dz * direction.y());
  }
  clip(x_low_ - origin.x(), -direction.x());
  clip(origin.x() - x_high_, direction.x());
  return enter <= leave ? enter : std::numeric_limits<double>::infinity();
}

double Extrusion::height(double x, double z) const {
  const double above = 1e3;
  const double depth = cast({x, above, z}, {0, -1, 0});
  return above - depth;
}

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
