// A flat cloud as a frame, for tests and benchmarks.
#pragma once

#include <utility>

#include "core/kernels/isa.h"
#include "core/points/neighbour_search.h"
#include "core/rendering/frame.h"

namespace remote_touch::scenes {

// Returns n x n points in the plane of height y, centred about the y axis.
inline PointCloud flat_grid(int n, double spacing = 0.0015, double y = 0) {
  PointCloud cloud;
  cloud.grid_columns = n;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      cloud.append({(i - 0.5 * (n - 1)) * spacing, y, (j - 0.5 * (n - 1)) * spacing});
  return cloud;
}

inline Frame frame(PointCloud cloud, int index = 0, double rate_hz = 30) {
  const double time = index / rate_hz;
  return {index, time, time, make_search(std::move(cloud))};
}

inline const Kernels& kernels() {
  return kernels_for(best_isa());
}

}  // namespace remote_touch::scenes
