// The region in which the points of a patch replace those of the frame.
#pragma once

#include <cmath>

#include "core/beyond/tracked_surface/patch_frame.h"
#include "core/search/gathered_points.h"

namespace remote_touch {

// A cylinder about the patch's normal; radius and half height in contact radii.
struct PatchRegion {
  PatchFrame frame;
  double radius = 0, half_height = 0;

  bool holds(const PatchPlace& p) const {
    return p.u * p.u + p.v * p.v < radius * radius && std::abs(p.h) <= half_height;
  }
  bool holds(const Ball& ball) const;
  // Returns the bounding ball, m, world frame.
  Ball around() const {
    return {frame.origin_W(), std::hypot(radius, half_height) * frame.unit_m() * (1 + 1e-9)};
  }
};

}  // namespace remote_touch
