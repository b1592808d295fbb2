// Helpers that the benchmarks of normals share, which compare ours with those of other programs.
#pragma once

#include <cmath>

#include "core/geometry/point_cloud.h"
#include "tests/benchmarks/peers/peer_depth.h"

namespace remote_touch::benchmarks {

// Returns the angle between a normal and the true one. The sign of the normal does not matter.
inline double angle_deg(const Vec3& n, const Vec3& truth) {
  return std::atan2(n.cross(truth).norm(), std::abs(n.dot(truth))) * 180 / 3.14159265358979323846;
}

// pre: the cloud has an image layout and is in the camera's frame.
inline peers::OrganisedPoints organised(const PointCloud& cloud) {
  const CameraIntrinsics& camera = cloud.image->camera;
  peers::OrganisedPoints points{camera.width, camera.height, camera.fx, camera.cx, camera.cy, {}};
  for (std::size_t i = 0; i < cloud.size(); ++i)
    for (const double x : {cloud.x[i], cloud.y[i], cloud.z[i]}) points.xyz.push_back(static_cast<float>(x));
  return points;
}

}  // namespace remote_touch::benchmarks
