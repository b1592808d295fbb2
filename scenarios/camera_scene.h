// A synthetic depth camera that looks at a ramp and a box on a table: Figs 4.15 and 4.16 without a recording.
#pragma once

#include <string>
#include <vector>

#include "core/camera.h"
#include "core/parameter.h"
#include "scenarios/extrusion.h"
#include "scenarios/scenario.h"

namespace remote_touch {

// World frame: the table is y = 0, y up; ramp and box follow each other along z, and the camera stands beside
// the gap between them, from where it sees the walls on both sides of it. Depth is measured along the optical
// axis with Gaussian noise that grows with z^2, then quantised as a structured-light sensor does, with steps
// of quantisation z^2, and lost near depth edges.
class CameraScene final : public Scenario {
 public:
  struct Settings {
    double frame_rate_hz = 30;
    int width = 640;
    int height = 480;
    double focal_px = 525;
    Vec3 camera_m{0.3, 0.6, -0.02};
    Vec3 target_m{0, 0.02, -0.02};
    double noise_per_m = 0.0012;
    double quantisation_per_m = 0.00285;
    double edge_jump_m = 0.02;
    int hole_px = 2;
  };

  CameraScene(const Settings& settings, const NoiseKey& key, const Kernels& kernels);

  double frame_rate_hz() const override { return settings_.frame_rate_hz; }
  int frame_count() const override;
  std::shared_ptr<const NeighbourSearch> points(int frame) const override;
  PointCloud cloud(int frame) const override;
  double signed_distance(const Vec3& p_W, double time_s) const override;
  double surface_height(double x, double z, double time_s) const override;

  // What an ideal camera would measure; NaN beyond 3 m.
  const DepthImage& true_depth() const { return true_depth_; }

 private:
  void cast_rays();
  void mark_holes();

  const Settings settings_;
  const NoiseKey key_;
  const Kernels& kernels_;
  std::vector<Extrusion> solids_;
  CameraIntrinsics camera_;
  RigidTransform X_WC_;
  DepthImage true_depth_;
  std::vector<char> hole_;
};

Parameters parameters(CameraScene::Settings& s);
std::string conflict(const CameraScene::Settings& s);

}  // namespace remote_touch
