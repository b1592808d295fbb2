// Clouds at rest: a flat one, 4.3.1, a triangle wave, 4.3.3, and listed points.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "scenarios/interface/scenario.h"
#include "scenarios/synthetic/grid_scene.h"

namespace remote_touch {

// A flat point cloud at rest at y = 0, see 4.3.1.
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

// A few points given in the settings, such as the single point of 5.3.1.
class ListedPoints final : public Scenario {
 public:
  struct Settings {
    std::vector<double> points{0, 0, 0};  // rows of x, y, z in metres, world frame
    double frame_rate_hz = 30;
  };

  ListedPoints(const Settings& settings, const NoiseKey&, const Kernels&) : settings_(settings) {}

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override { return 1; }
  PointCloud cloud(int frame) const override;
  // NaN: single points are no surface and have no sides.
  double signed_distance(const Vec3&, double) const override {
    return std::numeric_limits<double>::quiet_NaN();
  }

 private:
  const Settings settings_;
};

Parameters parameters(ListedPoints::Settings& s);
std::string validate(const ListedPoints::Settings& s);

// A triangle wave of growing amplitude, 4.3.3: sharp convex and concave edges, Fig 4.14. The wave runs along
// x. Its corners lie half a period apart, alternately below and above y = 0 by an amplitude that grows
// linearly along the grid; the flanks between them are straight.
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
