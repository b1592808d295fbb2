// A synthetic depth camera that looks at a ramp and a box on a table: Figs 4.15 and 4.16 without a recording.
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/vector.h"
#include "scenarios/camera/depth_camera.h"
#include "scenarios/interface/scenario.h"

namespace remote_touch {

// A convex profile in the (z, y) plane, extruded along x: boxes and ramps, with exact distance and ray cast.
class Extrusion {
 public:
  // Corners (z, y) of a convex profile, counter-clockwise with z to the right and y up; metres.
  Extrusion(std::vector<std::array<double, 2>> profile, double x_low, double x_high);

  // Distance to the surface, negative inside; exact on both sides.
  double signed_distance(const Vec3& p) const;
  // Smallest t >= 0 at which origin + t direction enters the solid; infinite if it does not.
  double cast(const Vec3& origin, const Vec3& direction) const;
  // Height of the top over (x, z); minus infinity beside the solid.
  double height(double x, double z) const;

 private:
  std::vector<std::array<double, 2>> profile_;
  double x_low_, x_high_;
};

// World frame: the table is y = 0, y up. Ramp and box lie one behind the other along z. The camera is beside
// the gap between them, where it sees the walls on both sides of the gap.
class CameraScene final : public Scenario {
 public:
  struct Settings {
    double frame_rate_hz = 30;
    DepthCameraSettings camera{.camera_position_m = {0.3, 0.6, -0.02}, .target_position_m = {0, 0.02, -0.02}};
  };

  CameraScene(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  double frame_rate_hz() const override { return frame_rate_hz_; }
  int frame_count() const override;
  PointCloud cloud(int frame) const override { return camera_.measured(view_, frame); }
  double signed_distance(const Vec3& p_W, double time_s) const override;
  double surface_height(double x, double z, double time_s) const override;

  // Depths that an ideal camera would measure; NaN beyond 3 m.
  const DepthImage& true_depth() const { return view_.depth; }

 private:
  RayHit cast(const Vec3& origin_W, const Vec3& ray_W) const;

  const double frame_rate_hz_;
  std::vector<Extrusion> solids_;
  DepthCamera camera_;
  IdealView view_;
};

Parameters parameters(CameraScene::Settings& s);
inline std::string validate(const CameraScene::Settings& s) {
  return validate(s.camera);
}

}  // namespace remote_touch
