// The nearest large object that a depth image shows: where a scan goes when nobody says.
#pragma once

#include "core/cloud/camera.h"

namespace remote_touch {

struct NearestObject {
  double nearest_depth_m = 0;  // depth of its nearest part (5th percentile)
  int row = 0, column = 0;     // medians of its pixels
};

// The plane that most of the scene lies on (a table, a floor, a wall) is taken away when it holds a fifth of
// what was measured; of the patches of continuous depth that remain and fill 1 % of the image, the nearest is
// the object. Where nothing remains, the whole scene is. Depends on the image alone: the random choices have
// a fixed key.
NearestObject nearest_large_object(const DepthImage& image, const CameraIntrinsics& camera);

}  // namespace remote_touch
