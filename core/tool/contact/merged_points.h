// Neighbours of a cloud that are so nearly flat that one disk can stand for all of them. Not in the
// dissertation.
#pragma once

#include <optional>
#include <span>

#include "core/geometry/vector.h"

namespace remote_touch {

struct CloudPoint {
  Vec3 p_W, n_W;  // NaN: no normal
};

// In the middle of its points, with their mean normal; none of them is farther from it than extent_m.
struct MergedPoint {
  Vec3 p_W, n_W;
  double extent_m;
};

// Every point, and the rim of a disk of one spacing around it, lies within flat_m of the plane of the result,
// and the points leave no large gaps: their spacing is spacing_m. None where that is not so.
std::optional<MergedPoint> merged_point(std::span<const CloudPoint> points, double spacing_m, double flat_m);

}  // namespace remote_touch
