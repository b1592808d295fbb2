// The seam of every depth camera.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/cloud/point_cloud.h"

namespace remote_touch {

struct SensorView {
  CameraIntrinsics camera;  // optical frame: x right, y down, z forward
  double metres_per_unit = 0.001;
  double frame_rate_hz = 30;
  bool has_colour = false;
  RigidTransform X_WC = RigidTransform::Identity();  // where the camera stands, if the source knows
};

// Pixel (u, v) is number v * width + u.
struct SensorFrame {
  int number = 0;                     // as the sensor counts, so that a gap shows
  double captured_s = 0;              // of the steady clock
  std::vector<std::uint16_t> depth;   // along the optical axis, in units of the view; 0: nothing measured
  std::vector<std::uint32_t> colour;  // 0xRRGGBB, registered to the depth image; empty: none
};

enum class SensorState { frame, waiting, ended, failed };

// Used from one thread. The constructor opens the sensor and throws InputError with what is absent and what
// would help.
class DepthSource {
 public:
  virtual ~DepthSource() = default;

  virtual const SensorView& view() const = 0;
  // Waits for the next frame, timeout_s at the longest. Keeps the memory of the frame that it is given.
  virtual SensorState next(SensorFrame& frame, double timeout_s) = 0;
  // Why it failed, in one line.
  virtual std::string failure() const { return {}; }
};

}  // namespace remote_touch
