// The nearest large object in a depth image: the default target of a scan.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/geometry/camera.h"
#include "runners/experiment/hand/surface_support.h"

namespace remote_touch {

struct NearestObject {
  double nearest_depth_m = 0;    // depth of its nearest part (5th percentile)
  int row = 0, column = 0;       // medians of its pixels
  std::vector<int> pixels;       // row * width + column of each pixel, unsorted
  bool is_whole_scene = false;   // no large object was found
  bool is_behind_plane = false;  // it is behind the dominant plane, and no large object is in front of it
};

// Returns the nearest large object. The dominant plane (a table, a floor, a wall) is removed first if it has
// more than a fifth of the measured points. The object is the nearest of the remaining patches of continuous
// depth that fill 1 % of the image or more. A patch behind the plane counts only if none is in front of it,
// because it may be a part of a table that is not quite flat. If there is no such patch, the whole scene is
// the object. The result depends on the image alone, because the random choices have a fixed key.
NearestObject nearest_large_object(const DepthImage& image, const CameraIntrinsics& camera);

// The same for an image that may be sparse. The pixels of one object must touch each other, so an object of
// scattered pixels is found only after its holes are closed. The object found with closed holes is returned
// if the measured pixels alone show no large object, only one behind the plane while the other is in front of
// it, or one that is more than 10 mm farther away.
NearestObject nearest_large_object(BridgeableImage& image, const CameraIntrinsics& camera);

// Returns a text about an object that is nearer than the one that a hand touches:
// "an object at row 110, column 150 is nearer, at 600 mm; it does not fill 1 % of the image without gaps"
std::string text_of_nearer(const NearestObject& object);

// Returns the nearest patch of continuous depth in front of the dominant plane that is more than 10 mm nearer
// than touched_depth_m and contains no pixel of `touched` (row * width + column). The patch covers 4 cm^2 or
// more, the square of twice the default margin_m, so that a hand could touch it. It need not fill 1 % of the
// image, and its pixels may join diagonally. It is meant for hands that touch the whole scene, because
// nearest_large_object() found no large object. Returns nothing if there is no such patch.
std::optional<NearestObject> nearer_small_object(const DepthImage& image, const CameraIntrinsics& camera,
                                                 const std::vector<int>& touched, double touched_depth_m);

}  // namespace remote_touch
