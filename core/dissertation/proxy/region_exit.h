// The way out of a union of regions that encloses the proxy. Not in the dissertation.
#pragma once

#include <optional>

#include "core/dissertation/proxy/proxy_parameters.h"
#include "core/geometry/vector.h"
#include "core/kernels/kernels.h"
#include "core/search/neighbourhood.h"

namespace remote_touch {

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

}  // namespace remote_touch
