#include "scenarios/synthetic/moving_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

Parameters parameters(MovingPlane::Settings& s) {
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
  return appended(parameters(s.grid), more);
}

std::string validate(const MovingPlane::Settings& s) {
  const bool moves = s.speed_m_per_s > 0 || s.acceleration_m_per_s2 > 0;
  return moves || s.rise_height_m == 0
             ? ""
             : "rise_height_m: a plane without speed_m_per_s and acceleration_m_per_s2 does not rise: expected 0";
}

MovingPlane::MovingPlane(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : GridScene(settings, key, kernels), settings_(settings) {
  if (settings.rise_height_m == 0) return;
  // The root of v t + a t^2 / 2 = rise, without cancellation and for a = 0 too.
  const double v = settings.speed_m_per_s, a = settings.acceleration_m_per_s2;
  rising_s_ = 2 * settings.rise_height_m / (v + std::sqrt(v * v + 2 * a * settings.rise_height_m));
  constexpr double kMaxFrames = std::numeric_limits<int>::max() - 1;
  const double moving_frames = std::ceil((settings.wait_s + rising_s_) * settings.frame_rate_hz - 1e-6);
  moving_frames_ += static_cast<int>(std::min(moving_frames, kMaxFrames));
}

double MovingPlane::height(double time_s) const {
  const double t = time_s - settings_.wait_s;
  if (t >= rising_s_) return settings_.start_height_m + settings_.rise_height_m;
  if (t <= 0) return settings_.start_height_m;
  return settings_.start_height_m + t * (settings_.speed_m_per_s + 0.5 * settings_.acceleration_m_per_s2 * t);
}

PointCloud MovingPlane::cloud(int frame) const {
  const double y = height(captured_s(frame));
  PointCloud cloud = sampled(frame, [y](double x, double z) { return Vec3(x, y, z); });
  cloud.nx.assign(cloud.size(), 0), cloud.ny.assign(cloud.size(), 1), cloud.nz = cloud.nx;
  return cloud;
}

}  // namespace remote_touch
