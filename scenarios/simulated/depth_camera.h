// A synthetic structured-light depth camera: where it looks, what it would see ideally, and what it measures.
// Depth is measured along the optical axis with Gaussian noise that grows with z^2, then quantised in steps
// of quantisation_per_m z^2, and lost near depth edges.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/scene/scenario.h"

namespace remote_touch {

// The world's y is up. Each scenario places its own camera.
struct DepthCameraSettings {
  int width = 640;
  int height = 480;
  double focal_px = 525;
  Vec3 camera_position_m{0, 0.6, 0};
  Vec3 target_position_m{0, 0, 0};
  double noise_per_m = 0.0012;
  double quantisation_per_m = 0.00285;
  double edge_jump_m = 0.02;
  int hole_px = 2;
};

Parameters parameters(DepthCameraSettings& s);
std::string validate(const DepthCameraSettings& s);

// Pose of a camera (x right, y down, z forward) that looks from `from` to `to` with the world's y up in the
// image. If it looks straight down or up, the world's up has no direction in the image. The image's right is
// then the world's +x; if the camera looks down, the image's up is then -z.
RigidTransform look_at(const Vec3& from, const Vec3& to);

// First hit of a ray: the position origin + t ray, and its colour.
struct RayHit {
  double t = std::numeric_limits<double>::infinity();
  std::uint32_t colour = 0;  // 0xRRGGBB; black if the ray hits nothing
};
using RayCast = std::function<RayHit(const Vec3& origin_W, const Vec3& ray_W)>;

// A scene at one instant, as an ideal camera would see it. Columns have an entry for every pixel.
struct IdealView {
  DepthImage depth;                             // NaN beyond 3 m
  std::vector<char> hole;                       // 1 if the sensor measures no depth: a depth edge is near
  std::vector<std::uint32_t> colour;            // 0xRRGGBB; empty for a scene without colours
  std::vector<double> depth_noise_factor = {};  // factor on the camera's own noise; empty: 1 everywhere
};

class DepthCamera {
 public:
  // Keeps a reference to the kernels.
  DepthCamera(const DepthCameraSettings& settings, const NoiseKey& key, const Kernels& kernels);

  const CameraIntrinsics& intrinsics() const { return intrinsics_; }
  const RigidTransform& pose() const { return X_WC_; }
  bool noisy() const { return settings_.noise_per_m > 0; }

  // Casts the ray of every pixel. Calls `cast` from several threads at once.
  IdealView view(const RayCast& cast, bool coloured) const;
  // Returns the view with these true depths and colours, whose image has the camera's size. The holes follow
  // from the depths.
  IdealView view(DepthImage depth, std::vector<std::uint32_t> colour) const;
  // Returns the organised cloud of a frame, a pure function of the view, the noise key and the frame's
  // number. A hole keeps its colour, because the camera sees it and only its depth is missing.
  PointCloud measured(const IdealView& view, int frame) const;
  // Returns the depths of that cloud.
  DepthImage measured_depth(const IdealView& view, int frame) const;

 private:
  std::vector<char> holes(const DepthImage& ideal) const;
  void measure_row(const IdealView& view, const NoiseStream& stream, int row, DepthImage& depth) const;

  DepthCameraSettings settings_;
  NoiseKey key_;
  const Kernels& kernels_;
  CameraIntrinsics intrinsics_;
  RigidTransform X_WC_;
};

// A synthetic depth camera that looks at a ramp and a box on a table: Figs 4.15 and 4.16 without a recording.

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
