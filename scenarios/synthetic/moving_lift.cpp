#include "scenarios/synthetic/moving_lift.h"

#include "scenarios/synthetic/noisy_grid_search.h"

namespace remote_touch {

Parameters parameters(MovingLift::Settings& s) {
  Parameters list =
      appended(parameters(s.grid),
               {{"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
                {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1,
                 "standard deviation of the noise on x, y and z, redrawn per frame", kLive}});
  list = appended(std::move(list), parameters(s.lift));
  list.push_back(
      {"truth", choice(s.truth, {"newest-frame", "moving"}), 0, 0,
       "true surface: newest-frame: the plane at the last capture; moving: the plane as it moves between frames"});
  return list;
}

MovingLift::MovingLift(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
    : GridScene(settings, key, kernels, settings.truth == SurfaceTime::moving), lift_(settings.lift) {}

double MovingLift::signed_distance(const Vec3& p_W, double time_s) const {
  return grid_.signed_distance(p_W,
                               has_moving_truth_ ? lift_.height_m(time_s) : height_m(newest_frame(time_s)));
}

std::shared_ptr<const NeighbourSearch> MovingLift::points(int frame) const {
  return std::make_shared<NoisyGridSearch>(grid_, height_m(frame), noise_sigma_m_, noise(frame));
}

PointCloud MovingLift::cloud(int frame) const {
  return sampled(frame, [y = height_m(frame)](double x, double z) { return Vec3(x, y, z); });
}

}  // namespace remote_touch
