// The surface that a depth image shows: a plane through the points around a pixel.
#pragma once

#include "core/geometry/point_cloud.h"

namespace remote_touch {

// Returns the distance of p to a plane through the points of the cloud around p's pixel, within radius_m, m;
// positive towards the camera. NaN at holes and depth edges, outside the image, behind the camera, and for
// clouds without a camera.
double distance_to_measured(const PointCloud& cloud, const Vec3& p_W, double radius_m);

}  // namespace remote_touch
