#include "scenarios/synthetic/moving_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

Parameters parameters(MovingPlane::Settings& s) {
  Parameters list = parameters(s.grid);
  const Parameters more = {
      {"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
      {"start_height_m", &s.start_height_m, -100, 100, "initial height of the plane"},
      {"wait_s", &s.wait_s, 0, 1e4, "waiting time before it rises"},
      {"speed_m_per_s", &s.speed_m_per_s, 0, 100, "initial speed of the rise"},
      {"acceleration_m_per_s2", &s.acceleration_m_per_s2, 0, 1000, "acceleration of the rise"},
      {"rise_height_m", &s.rise_height_m, 0, 100, "height of the rise; the plane then stops"},
      {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1,
       "standard deviation of the noise on x, y and z, redrawn per frame", kLive},
  };
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

std::string validate(const MovingPlane::Settings& s) {
  const bool moves = s.speed_m_per_s > 0 || s.acceleration_m_per_s2 > 0;
  return moves || s.rise_height_m == 0
             ? ""
             : "rise_height_m: a plane without speed_m_per_s and acceleration_m_per_s2 does not rise: expected 0";
}

MovingPlane::MovingPlane(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : settings_(settings), key_(key), kernels_(kernels) {
  if (settings.rise_height_m == 0) return;
  // The root of v t + a t^2 / 2 = rise, without cancellation and for a = 0 too.
  const double v = settings.speed_m_per_s, a = settings.acceleration_m_per_s2;
  rising_s_ = 2 * settings.rise_height_m / (v + std::sqrt(v * v + 2 * a * settings.rise_height_m));
  constexpr double kMaxFrames = std::numeric_limits<int>::max() - 1;
  const double moving_frames = std::ceil((settings.wait_s + rising_s_) * settings.frame_rate_hz - 1e-6);
  frame_count_ += static_cast<int>(std::min(moving_frames, kMaxFrames));
}

double MovingPlane::height(double time_s) const {
  const double t = time_s - settings_.wait_s;
  if (t >= rising_s_) return settings_.start_height_m + settings_.rise_height_m;
  if (t <= 0) return settings_.start_height_m;
  return settings_.start_height_m + t * (settings_.speed_m_per_s + 0.5 * settings_.acceleration_m_per_s2 * t);
}

std::shared_ptr<const NeighbourSearch> MovingPlane::points(int frame) const {
  return make_search(cloud(frame), 2.5 * settings_.grid.spacing_m);
}

PointCloud MovingPlane::cloud(int frame) const {
  PointCloud cloud;
  const Grid& grid = settings_.grid;
  cloud.grid_columns = grid.columns;
  const double y = height(captured_s(frame));
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column)
      cloud.append({grid.x(column), y, grid.z(row)}, Vec3::UnitY());
  const auto drawn = static_cast<std::uint32_t>(frame);
  add_noise(cloud, settings_.noise_sigma_m, noise_stream(key_, NoiseUse::point_position, drawn), kernels_);
  return cloud;
}

}  // namespace remote_touch
