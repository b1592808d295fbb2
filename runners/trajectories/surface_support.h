// Where a scripted device can touch the surface of a depth image.
#pragma once

#include "core/cloud/camera.h"

namespace remote_touch {

// Depth along the optical axis of every pixel, NaN where nothing was measured. pre: cloud.image is set.
DepthImage depth_image(const PointCloud& cloud);

// Criteria for a surface without gaps.
struct Support {
  double edge_jump_m = 0.006;  // a larger depth difference between neighbouring pixels is an edge
  double margin_m = 0.01;      // how far around a pixel the surface must go on
};
// Median depth of the square around a pixel that is as wide as the margin; NaN if the square contains a hole,
// an edge or the image's border.
double supported_depth(const DepthImage& image, int u, int v, double focal_px, const Support& support);

}  // namespace remote_touch
