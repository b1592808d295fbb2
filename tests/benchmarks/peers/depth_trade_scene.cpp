#include "tests/benchmarks/peers/depth_trade_scene.h"

#include <algorithm>

namespace remote_touch::benchmarks {
namespace {

struct Box {
  RigidTransform X_CB;
  Vec3 half_m;
};

Box box(const Vec3& centre_m, const Vec3& axis, double angle_rad, const Vec3& half_m) {
  return {RigidTransform(Eigen::Translation3d(centre_m) * Eigen::AngleAxisd(angle_rad, axis.normalized())),
          half_m};
}

// The values of z along the ray (z = 1 at its head) at which it enters and leaves the box, with the faces'
// normals.
struct Crossing {
  double enter = -std::numeric_limits<double>::infinity(), leave = std::numeric_limits<double>::infinity();
  Vec3 enter_normal = Vec3::UnitZ(), leave_normal = Vec3::UnitZ();
  bool hit() const { return enter < leave && leave > 0; }
};

Crossing crossing(const Box& box, const Vec3& ray_C) {
  const Vec3 origin = box.X_CB.inverse().translation(), ray = box.X_CB.linear().transpose() * ray_C;
  Crossing found;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-box.half_m[axis] - origin[axis]) / ray[axis];
    const double b = (box.half_m[axis] - origin[axis]) / ray[axis];
    const Vec3 normal = box.X_CB.linear().col(axis);
    if (std::min(a, b) > found.enter) found.enter = std::min(a, b), found.enter_normal = normal;
    if (std::max(a, b) < found.leave) found.leave = std::max(a, b), found.leave_normal = normal;
  }
  return found;
}

struct Seen {
  double z_m;
  Vec3 normal;
};

// Returns the nearest box, or the room's wall if the ray meets no box. The room is a box seen from inside.
Seen nearest(const Box& room, const std::vector<Box>& boxes, const Vec3& ray_C) {
  const Crossing wall = crossing(room, ray_C);
  Seen seen{wall.leave, wall.leave_normal};
  for (const Box& each : boxes) {
    const Crossing front = crossing(each, ray_C);
    if (front.hit() && front.enter < seen.z_m) seen = {front.enter, front.enter_normal};
  }
  return seen;
}

// Two neighbouring pixels see the same plane, two planes that meet, or a surface and another that it hides.
// If it hides the other, the plane of either misses the other's point by more than 1 cm.
PixelKind between(const TradeScene& scene, std::size_t i, std::size_t j) {
  const int width = scene.seen.camera.width;
  const auto point = [&](std::size_t k) {
    const int at = static_cast<int>(k);
    return unproject(scene.seen.camera, at % width, at / width, scene.seen.depth.z_m[k]);
  };
  const Vec3 across = point(j) - point(i), n = scene.seen.normals[i], m = scene.seen.normals[j];
  if (std::min(std::abs(n.dot(across)), std::abs(m.dot(across))) > 0.01) return PixelKind::limb;
  return n.dot(m) < 1 - 1e-9 ? PixelKind::crease : PixelKind::plane;
}

void spread(std::vector<PixelKind>& kinds, int width, int height, int u, int v, PixelKind kind) {
  for (int y = std::max(0, v - kNearPixels); y <= std::min(height - 1, v + kNearPixels); ++y)
    for (int x = std::max(0, u - kNearPixels); x <= std::min(width - 1, u + kNearPixels); ++x) {
      PixelKind& at = kinds[static_cast<std::size_t>(y * width + x)];
      at = std::max(at, kind);
    }
}

}  // namespace

TradeScene room_with_boxes() {
  const Box room = box({0, 0, 0.2}, {0.3, 1, 0.1}, 0.5, {0.65, 0.5, 0.95});
  const std::vector<Box> boxes = {box({-0.22, 0.05, 0.78}, {1, 0.6, 0.2}, 0.9, {0.09, 0.07, 0.06}),
                                  box({0.12, -0.13, 0.85}, {0.2, 1, 0.5}, 0.7, {0.08, 0.1, 0.07}),
                                  box({0.14, 0.16, 0.7}, {1, -0.4, 0.3}, 0.8, {0.1, 0.04, 0.05})};
  TradeScene scene;
  scene.seen = scenes::seen(scenes::kinect(), [&](const Vec3& ray) {
    const Seen at = nearest(room, boxes, ray);
    return std::pair(at.z_m, at.normal);
  });
  const int width = scene.seen.camera.width, height = scene.seen.camera.height;
  scene.kinds.assign(scene.seen.depth.z_m.size(), PixelKind::plane);
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u) {
      const auto here = static_cast<std::size_t>(v * width + u);
      const PixelKind right = u + 1 < width ? between(scene, here, here + 1) : PixelKind::plane;
      const PixelKind below =
          v + 1 < height ? between(scene, here, here + static_cast<std::size_t>(width)) : PixelKind::plane;
      const PixelKind kind = std::max(right, below);
      if (kind != PixelKind::plane) spread(scene.kinds, width, height, u, v, kind);
    }
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      if (std::min({u, v, width - 1 - u, height - 1 - v}) < kRimPixels)
        scene.kinds[static_cast<std::size_t>(v * width + u)] = PixelKind::rim;
  return scene;
}

}  // namespace remote_touch::benchmarks
