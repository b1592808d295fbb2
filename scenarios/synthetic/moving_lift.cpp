#include "scenarios/synthetic/moving_lift.h"

#include <algorithm>
#include <cmath>

#include "scenarios/synthetic/noisy_grid_search.h"

namespace remote_touch {

Parameters parameters(MovingLift::Settings& s) {
  Parameters list = parameters(s.grid);
  const Parameters more = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
      {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1,
       "standard deviation of the noise on x, y and z, redrawn per frame", kLive},
      {"start_depth_m", &s.start_depth_m, 0, 10, "the first frame lies this far below y = 0"},
      {"start_velocity_m_per_s", &s.start_velocity_m_per_s, -10, 10, "velocity of the rise, v_0 of (4.20)"},
      {"rise_frames", &s.rise_frames, 0, 100000, "updates at constant velocity before the acceleration"},
      {"acceleration_m_per_s2", &s.acceleration_m_per_s2, -1000, 1000, "acceleration a after the rise"},
      {"acceleration_frames", &s.acceleration_frames, 0, 100000,
       "updates with acceleration; the cloud then rests"},
      {"truth", choice(s.truth, {"newest_frame", "moving"}), 0, 0,
       "true surface: newest_frame: the plane at the last capture; moving: the plane as it moves between frames"},
  };
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

MovingLift::MovingLift(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings), key_(key), kernels_(kernels) {
  double velocity = settings.start_velocity_m_per_s;
  for (int j = 0; j <= settings.rise_frames; ++j)
    height_m_.push_back(-settings.start_depth_m + j * (velocity / settings.frame_rate_hz));
  for (int j = 0; j < settings.acceleration_frames; ++j) {
    velocity += settings.acceleration_m_per_s2 / settings.frame_rate_hz;
    height_m_.push_back(height_m_.back() + velocity / settings.frame_rate_hz);
  }
}

double MovingLift::height(double time_s) const {
  const double last = static_cast<double>(height_m_.size() - 1);
  const double place = std::clamp(time_s * settings_.frame_rate_hz, 0.0, last);
  const auto j = static_cast<std::size_t>(place);
  if (j + 1 >= height_m_.size()) return height_m_.back();
  return height_m_[j] + (place - static_cast<double>(j)) * (height_m_[j + 1] - height_m_[j]);
}

double MovingLift::signed_distance(const Vec3& p_W, double time_s) const {
  const bool moving = settings_.truth == Truth::moving;
  return p_W.y() - (moving ? height(time_s) : height_m_[static_cast<std::size_t>(newest_frame(time_s))]);
}

std::shared_ptr<const NeighbourSearch> MovingLift::points(int frame) const {
  return std::make_shared<NoisyGridSearch>(
      settings_.grid, height_m_[static_cast<std::size_t>(frame)], settings_.noise_sigma_m,
      noise_stream(key_, NoiseUse::point_position, static_cast<std::uint32_t>(frame)));
}

PointCloud MovingLift::cloud(int frame) const {
  PointCloud cloud;
  const Grid& grid = settings_.grid;
  cloud.grid_columns = grid.columns;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      cloud.append({grid.x(column), height_m_[static_cast<std::size_t>(frame)], grid.z(row)});
  const auto drawn = static_cast<std::uint32_t>(frame);
  add_noise(cloud, settings_.noise_sigma_m, noise_stream(key_, NoiseUse::point_position, drawn), kernels_);
  return cloud;
}

}  // namespace remote_touch
