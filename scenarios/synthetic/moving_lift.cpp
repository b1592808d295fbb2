#include "scenarios/synthetic/moving_lift.h"

#include <utility>

#include "scenarios/synthetic/noisy_grid_search.h"

namespace remote_touch {

Parameters parameters(MovingLift::Settings& s) {
  Parameters list = parameters(s.grid);
  const Parameters more = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
      {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1,
       "standard deviation of the noise on x, y and z, redrawn per frame", kLive},
  };
  list.insert(list.end(), more.begin(), more.end());
  for (Parameter& p : parameters(s.lift)) list.push_back(std::move(p));
  list.push_back(
      {"truth", choice(s.truth, {"newest_frame", "moving"}), 0, 0,
       "true surface: newest_frame: the plane at the last capture; moving: the plane as it moves between frames"});
  return list;
}

MovingLift::MovingLift(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings), key_(key), kernels_(kernels), lift_(settings.lift) {}

double MovingLift::signed_distance(const Vec3& p_W, double time_s) const {
  const bool moving = settings_.truth == Truth::moving;
  return settings_.grid.signed_distance(p_W,
                                        moving ? lift_.height_m(time_s) : height_m(newest_frame(time_s)));
}

std::shared_ptr<const NeighbourSearch> MovingLift::points(int frame) const {
  return std::make_shared<NoisyGridSearch>(
      settings_.grid, height_m(frame), settings_.noise_sigma_m,
      noise_stream(key_, NoiseUse::point_position, static_cast<std::uint32_t>(frame)));
}

PointCloud MovingLift::cloud(int frame) const {
  PointCloud cloud;
  const Grid& grid = settings_.grid;
  cloud.grid_columns = grid.columns;
  const double y = height_m(frame);
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) cloud.append({grid.x(column), y, grid.z(row)});
  const auto drawn = static_cast<std::uint32_t>(frame);
  add_noise(cloud, settings_.noise_sigma_m, noise_stream(key_, NoiseUse::point_position, drawn), kernels_);
  return cloud;
}

}  // namespace remote_touch
