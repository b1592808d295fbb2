// The slab of a group of points: a flat disk that contains all of them. It is much thinner than a sphere
// around points of a surface, so that a tool can rest close to it without being near its points. Not in the
// dissertation.
#pragma once

#include <span>

#include "core/geometry/vector.h"

namespace remote_touch {

// Every point is within radius_m of the centre, and within half_m of the plane through the centre with the
// normal n_W. n_W is zero, and half_m too, if the points lie on a line; the slab is then a ball.
struct GroupSlab {
  Vec3 centre_W, n_W;
  double radius_m, half_m;
};

// pre: there is a point, and all are finite.
GroupSlab group_slab(std::span<const Vec3> points);

// Every finite normal differs from the middle by no more than the deviation. Both are zero if there is none.
struct NormalCone {
  Vec3 middle_W;
  double deviation;
};
NormalCone normal_cone(std::span<const Vec3> normals_W);

}  // namespace remote_touch
