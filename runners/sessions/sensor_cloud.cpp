#include "runners/sessions/sensor_cloud.h"

#include <limits>

#include "core/cloud/camera.h"

namespace remote_touch {

PointCloud cloud_of(const SensorFrame& frame, const SensorView& view, const RigidTransform& X_WC) {
  DepthImage depth{view.camera.width, view.camera.height, {}};
  depth.z_m.reserve(frame.depth.size());
  for (const std::uint16_t units : frame.depth)
    depth.z_m.push_back(units == 0 ? std::numeric_limits<double>::quiet_NaN() : units * view.metres_per_unit);
  PointCloud cloud = cloud_from_depth(depth, view.camera, X_WC);
  cloud.colour = frame.colour;
  return cloud;
}

}  // namespace remote_touch
