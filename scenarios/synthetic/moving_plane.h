// A flat cloud with normals that waits and then rises: a plane that lifts a tool.
#pragma once

#include <string>

#include "scenarios/synthetic/grid_scene.h"

namespace remote_touch {

class MovingPlane final : public GridScene {
 public:
  struct Settings {
    Grid grid{100, 100, 0.002, 0, 0};
    double frame_rate_hz = 30;
    double start_height_m = -0.06;
    double wait_s = 1;
    double speed_m_per_s = 0.1;
    double acceleration_m_per_s2 = 0;
    double rise_height_m = 0.1;
    double noise_sigma_m = 0;
  };

  MovingPlane(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  // Number of frames up to and including the first one in which the plane has come to rest for good, limited
  // to the largest int. With noise the frames never end.
  int frame_count() const override { return frames_of(moving_frames_); }
  std::vector<Phase> phases() const override {
    if (settings_.rise_height_m == 0) return {};
    return {{"the rise of the plane", settings_.wait_s, settings_.wait_s + rising_s_}};
  }
  PointCloud cloud(int frame) const override;
  // Height over the plane at time_s, also between frames. NaN for a position that is below the plane and
  // beyond the grid.
  double signed_distance(const Vec3& p_W, double time_s) const override {
    return grid_.signed_distance(p_W, height(time_s));
  }
  std::optional<Vec3> plane_normal(double) const override { return Vec3::UnitY(); }
  double surface_height(double, double, double time_s) const override { return height(time_s); }

 private:
  double height(double time_s) const;

  const Settings settings_;
  double rising_s_ = 0;  // duration of the rise
  int moving_frames_ = 1;
};

Parameters parameters(MovingPlane::Settings& s);
std::string validate(const MovingPlane::Settings& s);

}  // namespace remote_touch
