// A closed mesh around the region in which a function is negative.
#pragma once

#include <functional>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// Every cube of the grid, which begins at `low`, is divided into six tetrahedra around its diagonal. A
// surface through tetrahedra has no ambiguous cases, so the mesh is closed and manifold. Vertices lie on the
// edges where the function vanishes, but at least a hundredth of an edge from its ends, so that no triangle
// is degenerate. Throws InputError if the function is negative at a node on a side of the grid.
TriangleMesh marching_tetrahedra(const std::function<double(const Vec3&)>& function, const Vec3& low,
                                 const Vec3& high, double cell_m);

}  // namespace remote_touch
