// The row of a depth image along which a device scans, and the parts of it that the device touches.
#pragma once

#include <vector>

#include "core/cloud/camera.h"

namespace remote_touch {

// A part of the row without holes or edges, both ends included.
struct ScanPatch {
  int first_column = 0, last_column = 0;
};

// -1: chosen from the image.
struct ScanRowRequest {
  int row = -1;
  int first_column = -1, last_column = -1;
  double span_m = 0.3;
  double edge_jump_m = 0.006;
  double bridge_m = 0.008;
  double margin_m = 0.01;
};

struct ScanRow {
  int row = 0;
  std::vector<ScanPatch> patches;  // from left to right; empty: there is nothing to touch
  std::vector<double> depth_m;     // supported_depth() of each column, NaN outside the patches' surfaces
  double edge_jump_m = 0;          // the largest jump that was taken as surface
  bool bridges_holes = false;      // holes up to bridge_m were closed
  bool is_on_object = false;       // a patch touches the nearest large object
};

// Tries edge_jump_m, twice and four times that, each without and with holes closed, because a rough scan is
// better than none. Each time it tries the requested row; without one, the rows of the nearest large object
// from its middle outwards. The result is the first row with a patch on the object; if there is none, the
// first with a patch. A requested row that does not cross the object needs no patch on it. pre: the requested
// row and columns are in the image.
ScanRow find_scan_row(const DepthImage& image, const CameraIntrinsics& camera, const ScanRowRequest& request);

}  // namespace remote_touch
