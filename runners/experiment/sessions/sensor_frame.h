// The data of a depth camera: its view (intrinsics and pose) and its frames. A simulated sensor may send
// clouds of points in place of images.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/geometry/point_cloud.h"

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

}  // namespace remote_touch
