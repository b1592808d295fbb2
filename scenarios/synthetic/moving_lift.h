// A flat cloud that rises from below at constant velocity and then accelerates, 4.3.2: the experiment of
// Figs 4.12 and 4.13. Noise is drawn anew for every point of every frame.
#pragma once

#include <string>
#include <vector>

#include "scenarios/synthetic/grid_scene.h"
#include "scenarios/synthetic/lift_motion.h"

namespace remote_touch {

class MovingLift final : public GridScene {
 public:
  struct Settings {
    Grid grid{200, 200, 0.0015, 0, 0};
    double frame_rate_hz = 30;
    double noise_sigma_m = 0.003;
    LiftMotion::Settings lift{.start_depth_m = 0.05,
                              .start_velocity_m_per_s = 0.1,
                              .rise_s = 0.5,
                              .acceleration_m_per_s2 = 3,
                              .acceleration_s = 1.0 / 3};
    SurfaceTime truth = SurfaceTime::newest_frame;
  };

  MovingLift(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  int frame_count() const override { return frames_of(lift_.frame_count(frame_rate_hz())); }
  std::vector<Phase> phases() const override { return lift_.phases(); }
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  PointCloud cloud(int frame) const override;
  // Height over the plane of the newest frame, because pop-through is judged against what the camera has
  // seen. With SurfaceTime::moving it is the height over the plane as it moves. NaN for a position that
  // is below the plane and beyond the grid.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // Height of the plane as it moves, also between frames.
  double surface_height(double, double, double time_s) const override { return lift_.height_m(time_s); }
  std::optional<Vec3> plane_normal(double) const override { return Vec3::UnitY(); }

 private:
  double height_m(int frame) const { return lift_.height_of_frame_m(frame, frame_rate_hz()); }

  const LiftMotion lift_;
};

Parameters parameters(MovingLift::Settings& s);
inline std::string validate(const MovingLift::Settings&) {
  return {};
}

}  // namespace remote_touch
