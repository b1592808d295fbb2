// Clouds and frames that tests and benchmarks share.
#pragma once

#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "core/kernels/isa.h"
#include "core/proxy/proxy_renderer.h"
#include "core/rendering/frame.h"
#include "core/search/neighbour_search.h"

namespace remote_touch::scenes {

// n x n points at y = 0, centred.
inline PointCloud flat_grid(int n, double spacing = 0.0015, double y = 0) {
  PointCloud cloud;
  cloud.grid_columns = n;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      cloud.append({(i - 0.5 * (n - 1)) * spacing, y, (j - 0.5 * (n - 1)) * spacing});
  return cloud;
}

// Uniform in a cube around the origin. Test data only: its bits need not be the same everywhere.
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

inline Frame frame(PointCloud cloud, int index = 0, double rate_hz = 30) {
  const double time = index / rate_hz;
  return {index, time, time, make_search(std::move(cloud))};
}

inline const Kernels& kernels() {
  return kernels_for(best_isa());
}

inline ProxyRenderer renderer(const ProxyParameters& parameters = {}) {
  return ProxyRenderer(parameters, 1000, kernels());
}

}  // namespace remote_touch::scenes
