// Sensors of depth images with the errors of real ones: structured light and active stereo, beside the simple
// model of depth_camera.h.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/kernels/point_kernels.h"
#include "core/parameters/parameter.h"
#include "core/points/noise.h"
#include "core/points/point_cloud.h"
#include "scenarios/simulated/depth_camera.h"

namespace remote_touch {

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
