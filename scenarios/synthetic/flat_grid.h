// A flat point cloud at rest at y = 0, see 4.3.1.
#pragma once

#include <string>

#include "scenarios/synthetic/grid_scene.h"

namespace remote_touch {

class FlatGrid final : public GridScene {
 public:
  struct Settings {
    Grid grid;
    double frame_rate_hz = 30;
    double noise_sigma_m = 0;
    bool redraw_noise = true;
  };

  FlatGrid(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
      : GridScene(settings, key, kernels), redraw_noise_(settings.redraw_noise) {}

  int frame_count() const override { return frames_of(1, redraw_noise_); }
  PointCloud cloud(int frame) const override;
  // Height over the plane; NaN for a position that is below the plane and beyond the grid.
  double signed_distance(const Vec3& p_W, double) const override { return grid_.signed_distance(p_W, 0); }
  std::optional<Vec3> plane_normal(double) const override { return Vec3::UnitY(); }
  double surface_height(double, double, double) const override { return 0; }

 private:
  const bool redraw_noise_;
};

Parameters parameters(FlatGrid::Settings& s);
inline std::string validate(const FlatGrid::Settings&) {
  return {};
}

}  // namespace remote_touch
