// The proxy of chapter 5 written plainly, over all points: the reference of the benchmarks of forbidden
// regions.
#pragma once

#include <vector>

#include "tests/benchmarks/naive_proxy.h"

namespace remote_touch::naive {

struct RegionPoint {
  Vec3 x;
  double radius;     // r_f of (5.2)
  double stiffness;  // k_s of (5.3)
};
inline const Vec3& place_of(const RegionPoint& point) {
  return point.x;
}
inline double region_radius_of(const RegionPoint& point) {
  return point.radius;
}

// Missing columns of the cloud count as 0 and as the renderer's own stiffness.
std::vector<RegionPoint> region_points_of(const PointCloud& cloud, const ProxyParameters& p);

struct RegionStep {
  Step step;             // nearest_distance_m is the least r_n, (5.5)
  double stiffness = 0;  // (5.8) as a weighted mean; the renderer's own if no point has a weight
};

// One proxy step. pre: as for proxy_step().
RegionStep region_step(const std::vector<RegionPoint>& points, const Vec3& proxy_W, const Vec3& hip_W,
                       const Vec3& previous_normal, const ProxyParameters& p);

// The state that the renderer keeps from tick to tick. pre: the first tick begins outside all regions.
struct RegionProxy {
  Vec3 proxy_W = Vec3::Zero(), normal_W = Vec3::Zero(), clear_W = Vec3::Zero();
};

// A whole tick, closing steps included. It ends early as the renderer's does.
void region_tick(const std::vector<RegionPoint>& points, const Vec3& hip_W, const ProxyParameters& p,
                 RegionProxy& proxy);

}  // namespace remote_touch::naive
