// Places of a mesh's surface.
#pragma once

#include <vector>

#include "core/geometry/vector.h"
#include "core/tool/mesh/triangle_mesh.h"

namespace remote_touch {

// Places of every triangle no farther apart than spacing_m along its longest side and the height above it,
// its corners among them.
std::vector<Vec3> surface_samples(const TriangleMesh& mesh, double spacing_m);

// Of the places in every cube of side spacing_m the first.
std::vector<Vec3> thinned(const std::vector<Vec3>& places, double spacing_m);

double surface_area_m2(const TriangleMesh& mesh);

}  // namespace remote_touch
