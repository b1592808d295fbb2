// A flat point cloud at rest at y = 0, see 4.3.1.
#pragma once

#include <string>

#include "scenarios/interface/scenario.h"
#include "scenarios/synthetic/grid.h"

namespace remote_touch {

class FlatGrid final : public Scenario {
 public:
  struct Settings {
    Grid grid;
    double frame_rate_hz = 30;
    double noise_sigma_m = 0;
    bool redraw_noise = true;
  };

  FlatGrid(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override;
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  PointCloud cloud(int frame) const override;
  // Height over the plane; NaN for a position that is below the plane and beyond the grid.
  double signed_distance(const Vec3& p_W, double) const override {
    return settings_.grid.signed_distance(p_W, 0);
  }
  std::optional<Vec3> plane_normal(double) const override { return Vec3::UnitY(); }
  double surface_height(double, double, double) const override { return 0; }

 private:
  const Settings settings_;
  const NoiseKey key_;
  const Kernels& kernels_;
};

Parameters parameters(FlatGrid::Settings& s);
inline std::string validate(const FlatGrid::Settings&) {
  return {};
}

}  // namespace remote_touch
