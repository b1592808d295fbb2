#include "scenarios/camera/camera_scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace remote_touch {

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
