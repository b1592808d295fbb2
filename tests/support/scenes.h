// Clouds and frames that tests and benchmarks share.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "core/dissertation/proxy/proxy_renderer.h"
#include "runners/evaluation/contract/flat_scene.h"

namespace remote_touch::scenes {

// The points are uniform in a cube around the origin. They are test data only: their bits need not be the
// same everywhere.
inline PointCloud random_cloud(int count, double half_width, unsigned seed) {
  std::mt19937 random(seed);
  const auto coordinate = [&] { return half_width * (random() / 2147483648.0 - 1.0); };
  PointCloud cloud;
  for (int i = 0; i < count; ++i) {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    cloud.append({x, y, z});
  }
  return cloud;
}

inline ProxyRenderer renderer(const ProxyParameters& parameters = {}) {
  return ProxyRenderer(parameters, 1000, kernels());
}

}  // namespace remote_touch::scenes
