// Gaps between the points of a surface through which a ball passes, 4.2.1.
#pragma once

#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

struct PointGap {
  double radius_m = 0;      // radius of the widest gap at the position; 0: no ball passes there
  bool is_decided = false;  // false: only points farther away can show whether there is a (wider) gap
};

// Returns the widest gap at a position through which a ball passes.
//
// The points are projected onto their plane (least squares). A gap is a disk that has no point in its
// interior and is held by points all around: in whatever direction it moves, it meets one of them. A ball
// passes through the gap if its radius is smaller than that of the disk. The gap is at the position if the
// disk contains the projected position. Four points at the corners of a square of side s leave a gap of
// radius s / sqrt(2), so that the limit for a square grid is s = sqrt(2) ball_radius_m. A gap beside the
// surface, beyond its border, is none, because points do not hold the disk all around.
//
// points: all points of the frame within known_m of the position, m. A gap that reaches farther is not
// decided. Nothing is decided if there are fewer than three points, or if they lie on a line. pre:
// ball_radius_m > 0.
PointGap widest_gap(const std::vector<Vec3>& points, const Vec3& position, double ball_radius_m,
                    double known_m);

}  // namespace remote_touch
