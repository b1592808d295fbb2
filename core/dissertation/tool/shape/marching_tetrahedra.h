// A closed mesh around the region in which a function is negative.
#pragma once

#include <functional>

#include "core/dissertation/tool/shape/triangle_mesh.h"

namespace remote_touch {

// Every cube of the grid from `low` on is divided into six tetrahedra along its diagonal. A surface through
// them has no ambiguous cases, so it is closed and manifold. Vertices lie where the function vanishes on the
// edges, but at least a hundredth of an edge from its ends, so that no triangle is degenerate. Throws
// InputError unless the function is positive on the sides of the box.
TriangleMesh marching_tetrahedra(const std::function<double(const Vec3&)>& function, const Vec3& low,
                                 const Vec3& high, double cell_m);

}  // namespace remote_touch
