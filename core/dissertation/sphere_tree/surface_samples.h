// Sample positions on a mesh's surface.
#pragma once

#include <vector>

#include "core/geometry/vector.h"
#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// Returns positions on every triangle, its corners among them. They are no farther apart than spacing_m along
// its longest side and along the height above it.
std::vector<Vec3> surface_samples(const TriangleMesh& mesh, double spacing_m);

// Keeps the first of the positions in every cube of side spacing_m.
std::vector<Vec3> thinned(const std::vector<Vec3>& positions, double spacing_m);

double surface_area_m2(const TriangleMesh& mesh);

}  // namespace remote_touch
