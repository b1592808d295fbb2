#include "runners/experiment/sessions/sensor_cloud.h"

#include <limits>

#include "core/geometry/camera.h"

namespace remote_touch {

namespace {

// Normalises a normal, because its length is not exactly 1 after rounding to floats.
Vec3 unit(const Vec3& n) {
  return n / n.norm();
}

PointCloud cloud_of_points(const SensorFrame& frame, const CloudLayout& layout, const RigidTransform& X_WC) {
  PointCloud cloud;
  const std::size_t step = layout.numbers_per_point();
  for (std::size_t at = 0; at + step <= frame.points.size(); at += step) {
    const auto vector = [&](std::size_t i) {
      return Vec3(frame.points[at + i], frame.points[at + i + 1], frame.points[at + i + 2]);
    };
    if (layout.has_normals)
      cloud.append(X_WC * vector(0), X_WC.linear() * unit(vector(3)));
    else
      cloud.append(X_WC * vector(0));
  }
  cloud.grid_columns = layout.grid_columns;
  cloud.colour = frame.colour;
  return cloud;
}

}  // namespace

bool is_complete(const SensorFrame& frame, const SensorView& view) {
  const std::size_t step = view.cloud ? view.cloud->numbers_per_point() : 1;
  const std::size_t points = view.cloud ? frame.points.size() / step : view.camera.pixels();
  const bool has_points = view.cloud ? frame.points.size() % step == 0 : frame.depth.size() == points;
  return has_points && (!view.has_colour || frame.colour.size() == points);
}

PointCloud cloud_of(const SensorFrame& frame, const SensorView& view, const RigidTransform& X_WC) {
  if (view.cloud) return cloud_of_points(frame, *view.cloud, X_WC);
  DepthImage depth{view.camera.width, view.camera.height, {}};
  depth.z_m.reserve(frame.depth.size());
  for (const std::uint16_t units : frame.depth)
    depth.z_m.push_back(units == 0 ? std::numeric_limits<double>::quiet_NaN() : units * view.metres_per_unit);
  PointCloud cloud = cloud_from_depth(depth, view.camera, X_WC);
  cloud.colour = frame.colour;
  return cloud;
}

}  // namespace remote_touch
