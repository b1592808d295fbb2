// Pinhole camera and depth image. Camera frame C: x right, y down, z forward along the optical axis, metres;
// pixel (u, v) = (column, row), the centre of the first pixel is (0, 0).
#pragma once

#include <string>
#include <vector>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// z_m[v * width + u] is the distance along the optical axis; NaN where the sensor measured nothing.
struct DepthImage {
  int width = 0;
  int height = 0;
  std::vector<double> z_m;
};

// Returns the point that pixel (u, v) sees at depth z_m: x = (u - cx) z / fx, y = (v - cy) z / fy.
Vec3 unproject(const CameraIntrinsics& camera, double u, double v, double z_m);

// Returns the image size as text, such as "640 x 480 pixels".
std::string size_text(const CameraIntrinsics& camera);

// Returns the organised cloud of a depth image, in the world frame. A pixel without a measurement becomes a
// NaN point, never the origin. Throws std::invalid_argument if the image does not have the camera's size, or
// another number of depths than pixels.
PointCloud cloud_from_depth(const DepthImage& depth, const CameraIntrinsics& camera,
                            const RigidTransform& X_WC);

}  // namespace remote_touch
