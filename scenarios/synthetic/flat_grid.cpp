#include "scenarios/synthetic/flat_grid.h"

namespace remote_touch {

Parameters parameters(FlatGrid::Settings& s) {
  return appended(
      parameters(s.grid),
      {{"frame_rate_hz", &s.frame_rate_hz, 1e-3, 10000, "frames of the cloud per second, f_c"},
       {"noise_sigma_m", &s.noise_sigma_m, 0, 0.1, "standard deviation of the noise on x, y and z", kLive},
       {"redraw_noise", &s.redraw_noise, 0, 1,
        "true: new noise in every frame; false: the same noise in all"}});
}

PointCloud FlatGrid::cloud(int frame) const {
  return sampled(redraw_noise_ ? frame : 0, [](double x, double z) { return Vec3(x, 0, z); });
}

}  // namespace remote_touch
