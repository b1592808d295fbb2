// Flat plates that hide each other from a camera above them: a nearer object passes or enters, or two objects
// move apart.
#pragma once

#include <string>
#include <vector>

#include "scenarios/synthetic/grid_scene.h"
#include "scenarios/synthetic/panel_scenes.h"

namespace remote_touch {

// The camera looks along -y with parallel rays through the nodes of the grid, which do not move. Each ray
// sees the highest plate at its node. It sees nothing if there is no plate, or if that plate is above
// max_height_m: it is then too near to be measured, but hides what is below. The points are stored row by
// row; noise is added in the world frame. The true surface is the first plate, whether it is hidden or not.
class Plates final : public GridScene {
 public:
  struct Settings {
    Grid grid{80, 80, 0.0015, 0, 0};
    double frame_rate_hz = 30;
    // One row for each plate: x, y and z of the centre, size along x and along z, velocity along x and along
    // y, and the times at which the plate starts and stops moving.
    std::vector<double> plates{0, 0, 0, 0.2, 0.2, 0, 0, 0, 0};
    double max_height_m = 10;
    double noise_sigma_m = 0;
    SurfaceTime truth = SurfaceTime::newest_frame;
  };
  static constexpr std::size_t kColumns = 9;

  Plates(const Settings& settings, const NoiseKey& key, const Kernels& kernels)
      : GridScene(settings, key, kernels, settings.truth == SurfaceTime::moving), settings_(settings) {}

  int frame_count() const override;
  // Returns the motion of each plate that moves, in the order of their end times.
  std::vector<Phase> phases() const override;
  PointCloud cloud(int frame) const override;
  // Distance to the first plate, positive above it. Beyond its border it is the distance to the border if p
  // is above the plane, and NaN if p is below it.
  double signed_distance(const Vec3& p_W, double time_s) const override;
  // Height of the first plate, continued beyond its border.
  double surface_height(double x, double z, double time_s) const override;

  // Position and size of a plate at a time.
  FlatPanel plate(std::size_t number, double time_s) const;

 private:
  bool moves(std::size_t number) const;
  std::size_t plate_count() const { return settings_.plates.size() / kColumns; }

  const Settings settings_;
};

Parameters parameters(Plates::Settings& s);
std::string validate(const Plates::Settings& s);

}  // namespace remote_touch
