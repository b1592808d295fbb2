#include "tests/benchmarks/naive_regions.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch::naive {
namespace {

bool is_entrenched(const std::vector<RegionPoint>& points, const Vec3& proxy_W, const ProxyParameters& p) {
  return std::any_of(points.begin(), points.end(), [&](const RegionPoint& point) {
    return (point.x - proxy_W).norm() - point.radius < p.r1_m;
  });
}

}  // namespace

std::vector<RegionPoint> region_points_of(const PointCloud& cloud, const ProxyParameters& p) {
  std::vector<RegionPoint> points;
  points.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double radius = cloud.fixture_radius_m.empty() ? 0 : cloud.fixture_radius_m[i];
    const double k = cloud.stiffness_N_per_m.empty() ? p.stiffness_N_per_m : cloud.stiffness_N_per_m[i];
    points.push_back({cloud.point(i), radius, std::isnan(k) ? p.stiffness_N_per_m : k});
  }
  return points;
}

RegionStep region_step(const std::vector<RegionPoint>& points, const Vec3& proxy_W, const Vec3& hip_W,
                       const Vec3& previous_normal, const ProxyParameters& p) {
  Step out;
  out.nearest_distance_m = std::numeric_limits<double>::infinity();
  Vec3 sum = Vec3::Zero();
  double weights = 0, weighted = 0;
  for (const RegionPoint& point : points) {
    const Vec3 e = proxy_W - point.x;
    const double distance = e.norm(), r = distance - point.radius;  // (5.5)
    out.nearest_distance_m = std::min(out.nearest_distance_m, r);
    if (r >= p.r3_m) continue;
    const double weight = psi(r, p);
    if (distance > 0) sum += e / distance * weight;
    weights += weight, weighted += weight * point.stiffness;
  }
  const double length = sum.norm();
  out.normal = length > 1e-10 ? Vec3(sum / length) : previous_normal;
  take_step(points, proxy_W, hip_W - proxy_W, p, out);
  return {out, weights > 0 ? weighted / weights : p.stiffness_N_per_m};
}

void region_tick(const std::vector<RegionPoint>& points, const Vec3& hip_W, const ProxyParameters& p,
                 RegionProxy& proxy) {
  const auto step_on = [&] {
    const Step step = region_step(points, proxy.proxy_W, hip_W, proxy.normal_W, p).step;
    if (step.state != ContactState::entrenched) proxy.clear_W = proxy.proxy_W;
    proxy.normal_W = step.normal;
    const Vec3 from_W = proxy.proxy_W;
    proxy.proxy_W += step.step;
    return proxy.proxy_W != from_W;
  };
  for (int k = 0; k < p.steps_per_tick; ++k)
    if (!step_on()) break;
  const bool has_regions =
      std::any_of(points.begin(), points.end(), [](const auto& x) { return x.radius > 0; });
  if (!has_regions) return;
  for (int k = 0; k < p.max_exit_steps && is_entrenched(points, proxy.proxy_W, p); ++k) step_on();
  if (is_entrenched(points, proxy.proxy_W, p)) proxy.proxy_W = proxy.clear_W;
}

}  // namespace remote_touch::naive
