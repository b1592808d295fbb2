// The data of a depth camera: its view (intrinsics and pose) and its frames.
#pragma once

#include <cstdint>
#include <vector>

#include "core/cloud/point_cloud.h"

namespace remote_touch {

struct SensorView {
  CameraIntrinsics camera;  // optical frame: x right, y down, z forward
  double metres_per_unit = 0.001;
  double frame_rate_hz = 30;
  bool has_colour = false;
  RigidTransform X_WC = RigidTransform::Identity();  // pose of the camera, if the source knows it
};

// Pixel (u, v) is number v * width + u.
struct SensorFrame {
  int number = 0;                     // as the sensor counts, so that gaps are visible
  double captured_s = 0;              // of the host's clock, seconds
  std::vector<std::uint16_t> depth;   // along the optical axis, in units of the view; 0: nothing measured
  std::vector<std::uint32_t> colour;  // 0xRRGGBB, registered to the depth image; empty: none
};

}  // namespace remote_touch
