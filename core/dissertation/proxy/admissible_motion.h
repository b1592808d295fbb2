// Motion that enters none of the regions which the proxy touches: an alternative to the tangent plane of
// (5.16), whose normal (5.7) is a mean over regions.
#pragma once

#include <optional>

#include "core/geometry/vector.h"
#include "core/kernels/points_view.h"

namespace remote_touch {

// Returns the motion nearest to u among those that enter no region within r2 of p: the projection of u onto
// the cone of all s with n_i . s >= 0, n_i = (p - x_i) / |p - x_i|. It is u itself if no region is in the
// way. It is zero in a corner that holds p from all sides. Returns nullopt if the projection is not found
// within a bounded number of rounds. A point at p itself is skipped.
std::optional<Vec3> admissible_motion(const PointsView& points, const Vec3& p_W, const Vec3& u, double r2);

// Returns true if the mean normal, the unit vector normal_W, is not reliable, as in a crease. This is so if
// the direction away from some region within r2 of p deviates from normal_W by more than the angle that has
// this cosine. It is also true between the points of a flat surface, if they are far apart.
bool is_in_crease(const PointsView& points, const Vec3& p_W, const Vec3& normal_W, double r2, double cosine);

}  // namespace remote_touch
