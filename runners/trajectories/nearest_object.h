// The nearest large object in a depth image: the default target of a scan.
#pragma once

#include "core/cloud/camera.h"

namespace remote_touch {

struct NearestObject {
  double nearest_depth_m = 0;  // depth of its nearest part (5th percentile)
  int row = 0, column = 0;     // medians of its pixels
};

// The dominant plane (a table, a floor, a wall) is removed if it has a fifth of the measured points or more;
// of the remaining patches of continuous depth that fill 1 % of the image or more, the nearest is the object.
// If none remains, the whole scene is the object. Depends on the image alone: the random choices have a fixed
// key.
NearestObject nearest_large_object(const DepthImage& image, const CameraIntrinsics& camera);

}  // namespace remote_touch
