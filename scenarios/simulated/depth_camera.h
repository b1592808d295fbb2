// Synthetic depth cameras: where they look, what they would see ideally, and what they measure. The depth of
// the simple one is measured along the optical axis with Gaussian noise that grows with z^2, then quantised
// in steps of quantisation_per_m z^2, and lost near depth edges. Beside it, sensors with the errors of real
// ones.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/kernels/point_kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/simulated/scenario.h"

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

// A synthetic depth camera that looks at a ramp and a box on a table: Figs 4.15 and 4.16 without a recording.
//
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

// The shadow that a second device beside a camera has: a projector of light, or the second camera of a pair.

// Returns for each pixel of a depth image 1 if the second device does not see the surface that the camera
// sees there. The device is at (baseline, 0, 0) in the camera frame, to the camera's right, so that shadows
// lie to the left of near objects. They are baseline focal (1 / z_near - 1 / z_far) pixels wide.
//
// A straight line stays straight in coordinates of column u and disparity d = baseline focal / z. The
// line from a point (u, d) to the device is (u + s, d + s), s > 0. The point is in the shadow if this line
// meets the surfaces of its row. They are exactly known at the pixels. Between two neighbours the surface is
// straight, unless their depths differ by more than edge_jump_m: then there is an edge in the middle between
// them, and nothing behind it. A surface that turns its back to the device is in the shadow as well. Surfaces
// that the camera does not see are unknown and throw no shadow.
//
// focal_baseline_px_m: product of the focal length in pixels and the baseline, above 0.
std::vector<char> baseline_shadow(const DepthImage& depth, double focal_baseline_px_m, double edge_jump_m);

// Noise of the pixels of an image that is correlated as the results of a matching window are: the windows of
// neighbouring pixels overlap.

// Standard normals of all pixels, row by row.
struct WindowNoise {
  // Correlated: two pixels that are (i, j) pixels apart have the correlation
  // (1 - |i| / window) (1 - |j| / window), and 0 from a distance of window on.
  std::vector<double> averaged;
  // Independent of each other, of other pixels and, for a window of 1, of averaged. Empty if not wanted.
  std::vector<double> across, down;
};

// The result is a pure function of its arguments. `averaged` is the sum of independent normals over the
// window's pixels, divided by the window's width. A window reaches beyond the image, so that pixels at the
// border have the same noise as others. Pre: width, height and window_px are 1 or more.
WindowNoise window_noise(int width, int height, int window_px, bool also_independent,
                         const NoiseStream& stream, const Kernels& kernels);

// Sensors of depth images with the errors of real ones, beside the simple model above.
//
// Structured light and active stereo triangulate: a second device, a projector or a second camera, is at
// (baseline, 0, 0) in the camera frame, to the right of the camera. The sensor measures the disparity
// d = f b / z in pixels, with the focal length f and the baseline b. All errors arise there:
//
//   1. Pixels without a measurement: the second device does not see the surface (see above); the
//      disparity exceeds the range of the search, so that the surface is too near; the ray meets the surface
//      at a grazing angle; in stereo also if the point is beyond the left border of the second image, which
//      is a band of f b / z pixels.
//   2. Lateral noise (structured light): at a depth edge the pixel may measure the surface on the other side.
//   3. Noise of the disparity, d + sigma n, which is correlated over the matching window (WindowNoise).
//   4. Rounding to a multiple of the smallest step of disparity, s.
//
// The standard deviation of a depth is z^2 noise_px / (f b), with noise_px^2 = sigma^2 + s^2 / 12. Where
// s / sqrt(12) exceeds noise_px, sigma is 0. Sources of the numbers: README.md of scenarios.
enum class DepthSensorKind { simple, structured_light, active_stereo };
enum class AxialNoise { disparity, nguyen_2012 };

struct DepthSensorSettings {
  DepthCameraSettings camera;  // its noise, steps and holes are those of the simple sensor only
  double max_depth_m = 3;
  DepthSensorKind sensor = DepthSensorKind::simple;
  AxialNoise axial_noise = AxialNoise::disparity;
  // Below 0: the value of the sensor, see triangulation().
  double baseline_m = -1;
  double disparity_focal_px = -1;
  double noise_px = -1;
  double disparity_step_px = -1;
  int window_px = -1;
  double lateral_noise_px = -1;
  double max_disparity_px = -1;
  double max_angle_deg = -1;
};

Parameters parameters(DepthSensorSettings& s);
std::string validate(const DepthSensorSettings& s);

// The numbers with which a sensor triangulates.
struct Triangulation {
  double baseline_m;
  double focal_px;          // focal length of the camera that measures the disparity
  double noise_px;          // standard deviation of the rounded disparity; 0: no axial noise
  double step_px;           // smallest step of disparity; 0: not rounded
  int window_px;            // width of the matching window
  double lateral_noise_px;  // standard deviation of a depth edge's position, for a surface seen head-on
  double max_disparity_px;
  double max_angle_deg;  // angle between ray and normal
};
// Returns the settings, with the values of the sensor for those below 0. Pre: the sensor is not simple.
Triangulation triangulation(const DepthSensorSettings& s);

// A scene at one instant, and all of its measurement that does not change from frame to frame.
struct SceneView {
  IdealView ideal;               // a hole is a pixel without a measurement
  std::vector<double> noise_px;  // sigma of each pixel's disparity, before the rounding; empty: simple sensor
  std::vector<double> lateral_noise_px;  // empty: none
};

class DepthSensor {
 public:
  // Keeps a reference to the kernels.
  DepthSensor(const DepthSensorSettings& settings, const NoiseKey& key, const Kernels& kernels);

  const CameraIntrinsics& intrinsics() const { return camera_.intrinsics(); }
  // The pose of the camera in the world frame, from its settings.
  const RigidTransform& pose() const { return camera_.pose(); }
  // True if successive frames of a scene at rest differ.
  bool noisy() const;

  // depth: true depths, NaN where the ray of the pixel meets nothing. cosine: of the angle between the ray
  // and the surface's normal, for each pixel; empty: 1. colour: 0xRRGGBB of each pixel; empty: none. Throws
  // std::invalid_argument if the image does not have the camera's size.
  SceneView view(DepthImage depth, const std::vector<double>& cosine,
                 std::vector<std::uint32_t> colour) const;
  // Returns the measured depths, NaN where there are none: a pure function of the view, the noise key and the
  // frame's number.
  DepthImage measured_depth(const SceneView& view, int frame) const;

 private:
  // Focal length times baseline (px m), with the pixels in which the disparity is measured.
  double focal_baseline() const { return triangulation_.focal_px * triangulation_.baseline_m; }
  // The same with the pixels of the image, in which shadows and borders have their width.
  double image_focal_baseline() const { return camera_.intrinsics().fx * triangulation_.baseline_m; }
  void add_noise(const std::vector<double>& cosine, SceneView& view) const;
  bool is_out_of_range(double z_m, double cosine, int u) const;
  std::size_t source(const SceneView& view, int u, int v, double across, double down) const;

  DepthSensorSettings settings_;
  NoiseKey key_;
  const Kernels& kernels_;
  DepthCamera camera_;
  Triangulation triangulation_;  // not used by the simple sensor
  double min_cosine_;
};

}  // namespace remote_touch
