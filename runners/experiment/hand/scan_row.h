// The row of a depth image along which a device scans, and the parts of it that the device touches.
#pragma once

#include <vector>

#include "core/geometry/camera.h"
#include "runners/experiment/hand/surface_support.h"

namespace remote_touch {

// A part of the row without holes or edges, both ends included.
struct ScanPatch {
  int first_column = 0, last_column = 0;
};

// A row or a column of -1 is chosen from the image.
struct ScanRowRequest {
  int row = -1;
  int first_column = -1, last_column = -1;
  double span_m = 0.3;
  double edge_jump_m =
      0.006;  // below sqrt(2) r_c: the proxy falls through a square of points wider than that
  double bridge_m = kBridge_m;
  double margin_m = 0.01;
};

struct ScanRow {
  int row = 0;
  std::vector<ScanPatch> patches;  // patches from left to right; empty: there is nothing to touch
  std::vector<double> depth_m;     // supported_depth() of each column; NaN: none, or beyond span_m
  double edge_jump_m = 0;          // the largest depth jump that counts as surface
  bool bridges_holes = false;      // holes up to bridge_m were closed
  bool is_on_object = false;       // a patch touches the nearest large object
  bool is_whole_scene = false;     // there is no large object: the whole scene counts as one
};

// Returns the first row with a patch on the nearest large object. If there is none, it returns the first row
// with a patch. A requested row that does not cross the object needs no patch on it. If no row has a patch,
// `patches` is empty.
//
// Six settings are tried in turn, because a rough scan is better than none: edge_jump_m, twice and four times
// that, each first without and then with closed holes. Each setting is tried on the requested row. Without a
// requested row it is tried on the rows of the object, from its middle outwards. pre: the requested row and
// columns are in the image.
ScanRow find_scan_row(const DepthImage& image, const CameraIntrinsics& camera, const ScanRowRequest& request);

}  // namespace remote_touch
