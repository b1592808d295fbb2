// The faces of a closed mesh that bound its solid. Parts of a mesh may lie in each other, or cross.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// The normals of the faces, edges and vertices of a surface of triangles, from which the side of a position
// follows: it is the sign of (p - nearest point) . normal of the face, edge or vertex with the nearest point.
// The normal of an edge is the mean of the normals of its faces. That of a vertex is the mean weighted by the
// angles of the faces at the vertex, because other means fail at some vertices (J. A. Baerentzen, H. Aanaes,
// "Signed distance computation using the angle weighted pseudonormal", IEEE TVCG 11(3), 2005). Their proof
// needs the solid near the vertex only, by the divergence theorem, so it also holds where parts of the solid
// touch along an edge of four faces.

// Unit vectors, in the order of the mesh. Where faces are folded onto each other so that their mean vanishes,
// the normal is that of the first face.
struct Pseudonormals {
  std::vector<Vec3> of_face, of_edge, of_vertex;
  std::vector<std::array<int, 3>> edges_of_face;  // the edges from corner 0 to 1, 1 to 2 and 2 to 0
  // 1 if the surface ends at the edge: more faces run along it in one direction than in the other, such as a
  // single face. Its side is unknown there. 1 for both ends of such an edge.
  std::vector<std::uint8_t> edge_on_border, vertex_on_border;
};

// pre: mesh is the result of welded_mesh().
Pseudonormals pseudonormals(const TriangleMesh& mesh);

// The solid of a closed mesh is the set of positions around which the whole mesh winds once or more: its
// winding number is 1 or more there, and 0 or less outside.
enum class FaceSide : std::uint8_t {
  boundary,  // the solid is behind the face and not in front of it
  inner,     // the solid is on both sides, as of a part within another one: no part of the surface
  inverted,  // the solid is on neither side: the face runs clockwise seen from outside
  crossed    // another face crosses this face, or lies on a part of it: its side is not the same everywhere
};

// True if as many triangles run along every edge in one direction as in the other.
bool is_closed_surface(const TriangleMesh& mesh);

// Returns the side of each face. A part of zero volume, a sheet with two sides, counts as boundary.
// pre: mesh is the result of welded_mesh(), has a triangle, and is_closed_surface(mesh).
std::vector<FaceSide> face_sides(const TriangleMesh& mesh);

// True if a part is inside out and is no hollow: its volume is negative, and it does not lie wholly in one
// other part of positive volume; or all its faces are inverted, as of a hollow in a hollow. A surface that
// crosses itself may have some inverted faces: a pocket that it winds around backwards is outside. pre: sides
// is the result of face_sides().
bool has_inverted_part_in(const TriangleMesh& mesh, const std::vector<FaceSide>& sides);

// Returns for each face whether another one crosses it, or lies on a part of it. Faces that only touch, in a
// corner or along a line, do not cross. pre: indices in range, vertices finite, no triangle without area.
std::vector<char> crossed_faces(const TriangleMesh& mesh);

}  // namespace remote_touch
