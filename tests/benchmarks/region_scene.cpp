#include "tests/benchmarks/region_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/dissertation/tool_motion/sphere_tree.h"
#include "tests/benchmarks/tool_scene.h"

namespace remote_touch::benchmarks {

namespace {

constexpr double kTube_m = 0.007, kSpoke_m = 0.006;
constexpr double kHub_m = 0.013, kHubHalfLength_m = 0.004;
constexpr int kWidth = 640, kHeight = 480;
constexpr double kFocal_px = 525;

double away_from_capsule(const Vec3& p, const Vec3& from, const Vec3& to, double radius_m) {
  const Vec3 along = to - from;
  const double fraction = std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - from - fraction * along).norm() - radius_m;
}

// Returns the signed distance of a position, in the wheel's frame, to the wheel: a ring, three spokes and a
// hub along its axis.
double away_from_wheel(const Vec3& p) {
  double away = std::hypot(std::hypot(p.x(), p.y()) - kRing_m, p.z()) - kTube_m;
  for (const double turn : {0.25, 0.25 + 1.0 / 3, 0.25 + 2.0 / 3}) {
    const double a = 2 * std::numbers::pi * turn;
    const Vec3 rim(kRing_m * std::cos(a), kRing_m * std::sin(a), 0);
    away = std::min(away, away_from_capsule(p, Vec3::Zero(), rim, kSpoke_m));
  }
  const Vec3 hub(0, 0, kHubHalfLength_m);
  return std::min(away, away_from_capsule(p, -hub, hub, kHub_m));
}

// Returns z of the point where a ray of the camera meets one of the wheels, or 2 m, beyond the wall, if it
// meets none. Each step is as long as the distance to the wheel, so no step passes through it.
double depth_of_wheels(const Vec3& ray, double nearer_m) {
  double depth = 2;
  for (const double side : {-1.0, 1.0}) {
    const Vec3 middle(side * kWheelAside_m, 0, kWheelAway_m - nearer_m);
    double z = middle.z() - 0.1;
    while (z < middle.z() + 0.1) {
      const double away = away_from_wheel(z * ray - middle);
      if (away < 1e-6) depth = std::min(depth, z);
      if (away < 1e-6) break;
      z += away / ray.norm();
    }
  }
  return depth;
}

double reach_of(const SphereTree& tree) {
  double reach_m = 0;
  for (const Sphere& leaf : tree.leaves()) reach_m = std::max(reach_m, leaf.centre.norm() + leaf.radius_m);
  return reach_m;
}

}  // namespace

PointCloud frame_of_wheels(double nearer_m) {
  constexpr double kWall_m = 1.2;
  PointCloud cloud;
  cloud.image.emplace();
  cloud.image->camera = {kWidth, kHeight, kFocal_px, kFocal_px, 0.5 * (kWidth - 1), 0.5 * (kHeight - 1)};
  for (int v = 0; v < kHeight; ++v)
    for (int u = 0; u < kWidth; ++u) {
      const Vec3 ray((u - 0.5 * (kWidth - 1)) / kFocal_px, (v - 0.5 * (kHeight - 1)) / kFocal_px, 1);
      const double depth = depth_of_wheels(ray, nearer_m);
      cloud.append(std::min(depth, kWall_m) * ray);
      cloud.fixture_radius_m.push_back(depth < kWall_m ? kRegion_m : 0);
    }
  return cloud;
}

SphereTool generated_sphere_tool(const std::string& name, int max_leaves) {
  const auto body = generated_tool(name);
  const auto leaves = std::make_shared<const SphereTree>(make_tool_spheres(*body, max_leaves).spheres);
  return {body, leaves, reach_of(*leaves)};
}

ToolPose device_around_wheel(int tick) {
  const double a = 2 * std::numbers::pi * tick / kRoundTicks;
  const double pressed_m = 0.01;
  return {{-kWheelAside_m + kRing_m * std::cos(a), kRing_m * std::sin(a),
           kWheelAway_m - kTube_m - kRegion_m + pressed_m},
          rotation({0.3 * std::sin(3 * a), 0.2 * std::cos(2 * a), 0.5 * std::sin(a)})};
}

}  // namespace remote_touch::benchmarks
