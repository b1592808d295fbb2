// What crosses the seam between a sensor and a renderer, and between a device and a renderer.
#pragma once

#include <memory>

#include "core/neighbour_search.h"
#include "core/vector.h"

namespace remote_touch {

// One point cloud of the stream. Latency is data: the renderer sees the frame at arrives_s.
struct Frame {
  int index = 0;
  double captured_s = 0;
  double arrives_s = 0;
  std::shared_ptr<const NeighbourSearch> points;
};

// The haptic interface point (HIP) in the world frame.
struct DeviceState {
  Vec3 position_W = Vec3::Zero();
  Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
};

}  // namespace remote_touch
