// A surface of triangles, from which a tool is made.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "core/points/vector.h"

namespace remote_touch {

// Metres. The corners of a triangle run counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
};

// Checks whether the corners of a mesh from an external source are vertices of it.
inline bool has_its_vertices(const TriangleMesh& mesh) {
  const auto count = static_cast<int>(mesh.vertices.size());
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [=](const auto& triangle) {
    return std::all_of(triangle.begin(), triangle.end(), [=](int v) { return v >= 0 && v < count; });
  });
}

// Cuts a polygon, concave ones too, into triangles. Returns each triangle as the indices of its corners in
// the list, in the direction of the polygon. Their areas sum up to the area of the polygon: they neither
// overlap nor leave it. A convex polygon becomes a fan about its first corner. Empty for a polygon whose
// edges cross or touch each other. Corners that are not in one plane are projected along the polygon's own
// normal (that of its area vector). pre: three finite corners or more, neighbours differ.
std::optional<std::vector<std::array<int, 3>>> polygon_triangles(const std::vector<Vec3>& corners);

}  // namespace remote_touch
