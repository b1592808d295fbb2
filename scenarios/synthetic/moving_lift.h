// A flat cloud that rises from below at constant velocity and then accelerates, 4.3.2: the experiment of
// Figs 4.12 and 4.13. Noise is drawn anew for every point of every frame.
#pragma once

#include <string>
#include <vector>

#include "scenarios/interface/scenario.h"
#include "scenarios/synthetic/grid.h"

namespace remote_touch {

class MovingLift final : public Scenario {
 public:
  enum class Truth { newest_frame, moving };
  struct Settings {
    Grid grid{200, 200, 0.0015, 0, 0};
    double frame_rate_hz = 30;
    double noise_sigma_m = 0.003;
    double start_depth_m = 0.05;
    double start_velocity_m_per_s = 0.1;
    int rise_frames = 15;
    double acceleration_m_per_s2 = 3;
    int acceleration_frames = 10;
    Truth truth = Truth::newest_frame;
  };

  MovingLift(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override { return settings_.rise_frames + settings_.acceleration_frames + 1; }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  PointCloud cloud(int frame) const override;
  // Height over the plane of the newest frame, because pop-through is judged against what the camera has
  // seen; or (Truth::moving) over the plane as it moves between frames.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // Of the plane as it moves linearly from one frame's height to the next; constant after the last.
  double surface_height(double, double, double time_s) const override { return height(time_s); }

 private:
  double height(double time_s) const;

  const Settings settings_;
  const NoiseKey key_;
  const Kernels& kernels_;
  std::vector<double> height_m_;  // of each frame
};

Parameters parameters(MovingLift::Settings& s);
inline std::string validate(const MovingLift::Settings&) {
  return {};
}

}  // namespace remote_touch
