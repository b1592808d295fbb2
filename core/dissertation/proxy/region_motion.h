// Motion of a proxy among regions: the way out of a union of them, and a motion that enters none.
#pragma once

#include <optional>

#include "core/dissertation/proxy/proxy_step.h"
#include "core/kernels/kernels.h"
#include "core/kernels/point_kernels.h"
#include "core/points/neighbour_search.h"
#include "core/points/vector.h"

namespace remote_touch {

// The way out of a union of regions that encloses the proxy. Not in the dissertation.

// Returns a position outside all regions (r_n >= r1): the end of the shortest of nine straight lines from p.
// One line leads along the normal. Four lead across it: towards u, away from u, and to both sides. Four lie
// halfway between the normal and these. No line leads against the normal, so the proxy stays on its side. If
// the normal is zero, the direction away from u replaces it; if u is zero too, an axis of the world replaces
// it. Returns nullopt if no line leaves all regions after kMaxExits of them.
//
// (5.11) chooses a new direction in every step and can move in circles, but a straight line leaves every
// region only once.
inline constexpr int kMaxExits = 32;
std::optional<Vec3> straight_exit(Neighbourhood& near, const Kernels& kernels, const Vec3& p_W,
                                  const Vec3& normal_W, const Vec3& u, const ProxyParameters& p);

// Returns r_f of the region that is nearest to p, or of the region in which p is deepest. If several are
// equally near, the smallest r_f is returned. Returns nullopt if there are no points.
std::optional<double> nearest_region_radius_m(const PointsView& points, const Vec3& p_W);

// Motion that enters none of the regions which the proxy touches: an alternative to the tangent plane of
// (5.16), whose normal (5.7) is a mean over regions.

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
