// One step of the proxy movement algorithm, 4.2.3 and 4.2.4 (chapter 5: the same with r_n and r_f).
#pragma once

#include "core/dissertation/proxy/proxy_parameters.h"
#include "core/geometry/vector.h"
#include "core/kernels/kernels.h"
#include "core/kernels/proxy_kernels.h"
#include "core/rendering/renderer.h"
#include "core/search/neighbourhood.h"

namespace remote_touch {

// 4.2.1: entrenched below r1, contact from r1 to r2 with both ends, free above.
ContactState classify(double nearest_distance_m, const ProxyParameters& p);

// Returns the unit vector of (4.1), or `previous` if the sum has no direction (no points, or symmetric ones).
Vec3 unit_normal(const ContactQuery& query, const Vec3& previous);

// Returns the free step (4.4), (4.9): towards the HIP, up to the first point met. u = HIP - P.
Vec3 free_step(Neighbourhood& near, const Vec3& p_W, const Vec3& u, const ProxyParameters& p);

// Returns the step (4.5), (4.10) along the normal until no point entrenches the proxy. Without a normal the
// step leads away from the HIP; if u is zero too, the step is zero.
Vec3 entrenched_step(const PointsView& points, const Kernels& kernels, const Vec3& p_W, const Vec3& normal,
                     const Vec3& u, const ProxyParameters& p);

// Returns the step (4.6), (4.7), (4.11), (4.12): in the tangent plane if the HIP is below it (u.n < 0), else
// straight to the HIP. (4.7) leaves d_k undefined; the rule of (4.11), (4.12) is applied to the length of u.
// The exit rule (5.17): a HIP that is not below the plane, nor at P, frees the proxy by r2 - r1 along the
// normal.
Vec3 contact_step(const Vec3& normal, const Vec3& u, const ProxyParameters& p);

// Replaces contact_step() under ContactRule::regions: towards goal, the admissible_motion(), by the step size
// of (4.11), (4.12), but only up to the first other point met. If nothing is in the way, goal = u, it is the
// step of free motion.
Vec3 region_step(Neighbourhood& near, const Vec3& p_W, const Vec3& goal, const Vec3& u,
                 const ProxyParameters& p);

// (4.8) in contact: the angle between -u and the normal is below theta. Free: P is the HIP.
bool has_converged(ContactState state, const Vec3& normal, const Vec3& u, const ProxyParameters& p);
// The same for a goal from admissible_motion(): the angle between -u and the cone of the touching regions'
// normals.
bool has_converged(const Vec3& goal, const Vec3& u, const ProxyParameters& p);

}  // namespace remote_touch
