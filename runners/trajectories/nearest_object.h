// The nearest large object in a depth image: the default target of a scan.
#pragma once

#include <vector>

#include "core/cloud/camera.h"
#include "runners/trajectories/surface_support.h"

namespace remote_touch {

struct NearestObject {
  double nearest_depth_m = 0;   // depth of its nearest part (5th percentile)
  int row = 0, column = 0;      // medians of its pixels
  std::vector<int> pixels;      // row * width + column of each pixel, in no order
  bool is_whole_scene = false;  // no large object was found
};

// The dominant plane (a table, a floor, a wall) is removed if it has a fifth of the measured points or more;
// of the remaining patches of continuous depth that fill 1 % of the image or more, the nearest is the object.
// If none remains, the whole scene is the object. Depends on the image alone: the random choices have a fixed
// key.
NearestObject nearest_large_object(const DepthImage& image, const CameraIntrinsics& camera);

// The same for an image that may be sparse. The pixels of one object must touch each other, so an object of
// scattered pixels is found only after its holes are closed. The object found with closed holes is returned
// if the measured pixels alone show no large object, or only one that is more than 10 mm farther away.
NearestObject nearest_large_object(BridgeableImage& image, const CameraIntrinsics& camera);

}  // namespace remote_touch
