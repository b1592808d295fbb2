// Checks whether the corners of a mesh from an external source are vertices of it.
#pragma once

#include <algorithm>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

inline bool has_its_vertices(const TriangleMesh& mesh) {
  const auto count = static_cast<int>(mesh.vertices.size());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [=](const auto& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [=](int v) { return v >= 0 && v < count; });
  });
}

}  // namespace remote_touch
