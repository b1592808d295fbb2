// The data of a depth camera: its view (intrinsics and pose) and its frames. A simulated sensor may send
// clouds of points in place of images.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"

namespace remote_touch {

// Layout of the clouds of a sensor that sends clouds.
struct CloudLayout {
  bool has_normals = false;
  int grid_columns = 0;             // see PointCloud::grid_columns
  std::size_t expected_points = 0;  // number of points expected in a frame; more are possible

  std::size_t numbers_per_point() const { return has_normals ? 6 : 3; }
};

struct SensorView {
  CameraIntrinsics camera;  // optical frame: x right, y down, z forward
  double metres_per_unit = 0.001;
  double frame_rate_hz = 30;
  bool has_colour = false;
  RigidTransform X_WC = RigidTransform::Identity();  // pose of the camera, if the source knows it
  std::optional<CloudLayout> cloud = {};             // set: it sends clouds; camera is not used
};

// Pixel (u, v) is number v * width + u. If the sensor sends clouds, depth is empty, and colour has one number
// for each point.
struct SensorFrame {
  int number = 0;                     // the sensor's count, so that gaps are visible
  double captured_s = 0;              // time of the host's clock, seconds
  std::vector<std::uint16_t> depth;   // along the optical axis, in units of the view; 0: nothing measured
  std::vector<std::uint32_t> colour;  // 0xRRGGBB, registered to the depth image; empty: none
  std::vector<float> points =
      {};  // x y z [nx ny nz] for each point of a cloud, camera frame, metres; NaN: not measured
};

// True if the frame has as many points or pixels as the view promises, and colours if the view promises them.
bool is_complete(const SensorFrame& frame, const SensorView& view);

// Returns the points of the frame. X_WC: pose of the camera in the world. The same frame gives the same bits,
// live and from a recording of it.
PointCloud cloud_of(const SensorFrame& frame, const SensorView& view, const RigidTransform& X_WC);

// Statistics of the points in a sensor's frames, for the line that reports what a session has read.
class SensedPoints {
 public:
  // Adds the points of a frame. Allocates nothing.
  void add(const SensorFrame& frame, const SensorView& view);

  std::int64_t frames() const { return frames_; }
  // Returns a text such as "68.3 % of 3686400 points measured, depth 0.41 to 2.98 m, with colours". The depth
  // is along the optical axis. Clouds of points have no depth: the text then has the range of their z.
  std::string text() const;

 private:
  void add_image(const SensorFrame& frame, double metres_per_unit);
  void add_cloud(const SensorFrame& frame, std::size_t numbers_per_point);

  std::int64_t frames_ = 0;
  std::uint64_t points_ = 0, measured_ = 0;
  double nearest_m_ = std::numeric_limits<double>::infinity();
  double farthest_m_ = -std::numeric_limits<double>::infinity();
  bool are_clouds_ = false, has_colours_ = false;
};

// Returns a text such as "640 x 480 pixels", or "clouds of points".
std::string layout_text(const SensorView& view);

}  // namespace remote_touch
