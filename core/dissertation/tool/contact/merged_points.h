// Merges neighbouring points of a cloud that are so nearly flat that one disk can represent all of them. Not
// in the dissertation.
#pragma once

#include <span>
#include <vector>

#include "core/geometry/vector.h"

namespace remote_touch {

struct CloudPoint {
  Vec3 p_W, n_W;     // NaN: no normal
  double spacing_m;  // distance to its neighbours; 0: not known
};

// A point of the cloud if extent_m is 0. Otherwise a disk that represents all points in a cube of a grid over
// the world. It lies in their middle and has their mean normal. These conditions hold:
// - none of the points is farther from the middle than extent_m;
// - each of them, and the rim of a disk of one spacing around it, lies within kFlat_m of its plane;
// - the cloud covers it: every square of a grid within extent_m of the middle contains a point of this or a
//   neighbouring cube, so that the disk does not reach beyond an edge or over a hole. The squares are 1.5
//   spacings wide or somewhat wider. Points that would need more than 32 squares along a side are not merged.
struct PointOrDisk {
  Vec3 p_W, n_W;
  double spacing_m, extent_m;
};

inline constexpr double kFlat_m = 5e-6;
// Points are not merged if their median spacing is larger than this.
inline constexpr double kMaxMergedSpacing_m = 6e-4;

// Returns an empty list if merging would not save half of the points. pre: cube_m > 0.
std::vector<PointOrDisk> merged_points(std::span<const CloudPoint> points, double cube_m);

}  // namespace remote_touch
