// A surface of triangles, from which a tool is made: whether it encloses a solid, its repair, and meshes that
// need no file.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
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

// Returns the vertices, and points of the triangles no farther apart than spacing_m, or than a hundredth of
// the longest side of a very large triangle.
std::vector<Vec3> surface_points(const TriangleMesh& mesh, double spacing_m);

// Cuts a polygon, concave ones too, into triangles. Returns each triangle as the indices of its corners in
// the list, in the direction of the polygon. Their areas sum up to the area of the polygon: they neither
// overlap nor leave it. A convex polygon becomes a fan about its first corner. Empty for a polygon whose
// edges cross or touch each other. Corners that are not in one plane are projected along the polygon's own
// normal (that of its area vector). pre: three finite corners or more, neighbours differ.
std::optional<std::vector<std::array<int, 3>>> polygon_triangles(const std::vector<Vec3>& corners);

// Checks whether a mesh encloses a solid, so that inside and outside are defined.

struct MeshCheck {
  int vertices = 0;
  int triangles = 0;
  int parts = 0;                 // sets of triangles connected by edges
  int boundary_edges = 0;        // edges of one triangle
  int non_manifold_edges = 0;    // edges of three or more triangles
  int inconsistent_edges = 0;    // edges of two triangles that run along them in the same direction
  int degenerate_triangles = 0;  // triangles with a corner twice, or without area
  int bad_vertices = 0;          // vertices that are not finite
  int bad_indices = 0;           // triangles with a corner that is not a vertex
  double volume_m3 = 0;          // signed; negative: inside out. Meaningless for an open mesh

  bool readable() const { return triangles > 0 && bad_vertices == 0 && bad_indices == 0; }
  // Returns true if every edge belongs to exactly two triangles that run along it in opposite directions.
  // Vertices at the same position count as different, so merge them before.
  bool closed() const {
    return readable() && boundary_edges == 0 && non_manifold_edges == 0 && inconsistent_edges == 0;
  }
  bool inverted() const { return closed() && volume_m3 < 0; }
};

MeshCheck check_mesh(const TriangleMesh& mesh);

// Returns the result as text, such as "not closed: 81 boundary edges, 6 non-manifold edges (5 parts, 1795
// triangles)" or "closed (1 part, ...)".
std::string text(const MeshCheck& check);

// An edge of one triangle. edges_by_vertices() sorts edges by low, high, then triangle, so that the edges of
// the triangles that share one follow each other.
struct MeshEdge {
  int low, high;  // vertices
  int triangle;
  bool forward;  // the triangle runs from low to high
};
std::vector<MeshEdge> edges_by_vertices(const TriangleMesh& mesh);

// Calls use(edges) for each pair of vertices, with the edges of its triangles. pre: the order of
// edges_by_vertices().
template <class Use>
void for_each_edge(std::span<const MeshEdge> edges, const Use& use) {
  while (!edges.empty()) {
    std::size_t count = 1;
    while (count < edges.size() && edges[count].low == edges[0].low && edges[count].high == edges[0].high)
      ++count;
    use(edges.first(count));
    edges = edges.subspan(count);
  }
}

// Returns the number of the part of each triangle. Parts are counted from 0 in the order of their first
// triangles.
std::vector<int> parts_of(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges, int& count);

// Returns the sum of the signed volumes of the tetrahedra from a point to all triangles.
double signed_volume(const TriangleMesh& mesh);

// Returns true if a corner occurs twice, or if the area is negligible compared with the squared length of the
// edges.
bool is_degenerate(const TriangleMesh& mesh, const std::array<int, 3>& triangle);

// Repairs a mesh that is not closed, as far as possible.

struct MeshRepair {
  int welded_vertices = 0;    // closer to another one than a millionth of the mesh's size
  int dropped_triangles = 0;  // a corner occurs twice, or another triangle has the same corners
  int flipped_triangles = 0;  // triangles of the mesh whose orientation has changed
  int filled_holes = 0;       // loops of boundary edges, each closed by a triangle or a fan
};

// Repairs a mesh. Every part is oriented outwards separately: a part that was a hollow in another becomes
// solid. Parts that cannot be closed (edges of three triangles, boundaries that are not loops) stay open: see
// inside_nodes_of_open(). pre: indices in range, vertices finite.
TriangleMesh repair_mesh(const TriangleMesh& mesh, MeshRepair& done);

std::string text(const MeshRepair& done);  // "welded 12 vertices, filled 3 holes"; "nothing"

// Meshes that need no file: boxes, and smooth bodies from a formula.

// Returns a closed mesh around the region in which a function is negative.
//
// Every cube of the grid, which begins at `low`, is divided into six tetrahedra around its diagonal. A
// surface through tetrahedra has no ambiguous cases, so the mesh is closed and manifold. Vertices lie on the
// edges where the function vanishes, but at least a hundredth of an edge from its ends, so that no triangle
// is degenerate. Throws InputError if the function is negative at a node on a side of the grid.
TriangleMesh marching_tetrahedra(const std::function<double(const Vec3&)>& function, const Vec3& low,
                                 const Vec3& high, double cell_m);

struct GeneratedTool {
  const char* name;
  const char* summary;
  TriangleMesh (*make)();  // closed, in metres
};

std::span<const GeneratedTool> generated_tools();  // sorted by name

const GeneratedTool* find_generated_tool(const std::string& name);  // null if there is no tool of this name

// Twelve triangles around a centre.
TriangleMesh box_mesh(const Vec3& sides_m, const Vec3& centre = Vec3::Zero());

}  // namespace remote_touch
