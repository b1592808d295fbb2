// A triangle wave of growing amplitude, 4.3.3: sharp convex and concave edges, Fig 4.14.
#pragma once

#include <string>

#include "scenarios/synthetic/grid_scene.h"

namespace remote_touch {

// The wave runs along x. Its corners lie half a period apart, alternately below and above y = 0 by an
// amplitude that grows linearly along the grid; the flanks between them are straight.
class TriangleWave final : public GridScene {
 public:
  struct Settings {
    Grid grid{300, 100, 0.0015, 0, 0};
    double frame_rate_hz = 30;
    double period_m = 0.06;
    double max_height_m = 0.03;
    double noise_sigma_m = 0;
  };

  TriangleWave(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
      : GridScene(settings, key, kernels), settings_(settings) {}

  int frame_count() const override { return 1; }
  PointCloud cloud(int frame) const override;
  // Distance to the wave, positive above it; the wave is continued along z. NaN below the wave if p lies
  // beyond the border along z, or beyond an end along x that is the nearest part of the wave.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  double surface_height(double x, double z, double time_s) const override;

 private:
  const Settings settings_;
};

Parameters parameters(TriangleWave::Settings& s);
std::string validate(const TriangleWave::Settings& s);

}  // namespace remote_touch
