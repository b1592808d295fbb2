// The way out of a union of regions that encloses the proxy. Not in the dissertation.
#pragma once

#include <optional>

#include "core/dissertation/proxy/proxy_parameters.h"
#include "core/geometry/vector.h"
#include "core/kernels/kernels.h"
#include "core/search/neighbourhood.h"

namespace remote_touch {

// Returns a position outside all regions, r_n >= r1, on the shortest of nine straight lines from p: along the
// normal, across it towards and away from u and to both sides, and halfway between. None of them leads
// against the normal, so the proxy stays on its side. Without a normal the direction away from u replaces it;
// without u, an axis of the world does. (5.11) takes a new direction in every step and can go round in
// circles, but a straight line leaves every region only once. Empty if no line ends outside within kMaxExits
// regions.
inline constexpr int kMaxExits = 32;
std::optional<Vec3> straight_exit(Neighbourhood& near, const Kernels& kernels, const Vec3& p_W,
                                  const Vec3& normal_W, const Vec3& u, const ProxyParameters& p);

// Returns r_f of the region that is nearest to p, or that p is deepest in. If several are equally near, the
// smallest r_f is returned. Empty without points.
std::optional<double> nearest_region_radius_m(const PointsView& points, const Vec3& p_W);

}  // namespace remote_touch
