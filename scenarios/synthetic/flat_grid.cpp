#include "scenarios/synthetic/flat_grid.h"

#include <limits>

namespace remote_touch {

Parameters parameters(FlatGrid::Settings& s) {
  Parameters list = parameters(s.grid);
  list.push_back({"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"});
  list.push_back(
      {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1, "standard deviation of the noise on x, y and z", kLive});
  list.push_back({"redraw_noise", &s.redraw_noise, 0, 1,
                  "true: new noise in every frame; false: the same noise in all"});
  return list;
}

FlatGrid::FlatGrid(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings), key_(key), kernels_(kernels) {}

// One frame suffices without fresh noise: every frame would repeat the first.
int FlatGrid::frame_count() const {
  const bool changes = settings_.noise_sigma_m > 0 && settings_.redraw_noise;
  return changes ? std::numeric_limits<int>::max() : 1;
}

std::shared_ptr<const NeighbourSearch> FlatGrid::points(int frame) const {
  return make_search(cloud(frame), 2.5 * settings_.grid.spacing_m);
}

PointCloud FlatGrid::cloud(int frame) const {
  PointCloud cloud;
  const Grid& grid = settings_.grid;
  cloud.grid_columns = grid.columns;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) cloud.append({grid.x(column), 0, grid.z(row)});
  const auto drawn = static_cast<std::uint32_t>(settings_.redraw_noise ? frame : 0);
  add_noise(cloud, settings_.noise_sigma_m, noise_stream(key_, NoiseUse::point_position, drawn), kernels_);
  return cloud;
}

}  // namespace remote_touch
