// The signed distance to a surface of triangles, its nearest point and its normal, and which of its faces
// bound its solid.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"

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
// winding number is 1 or more there, and 0 or less outside. Parts of the mesh may lie in each other, or
// cross.
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

// Joins the triangles of a mesh that touch each other, so that every edge has all of its triangles. Returns
// the same surface with one vertex per position (0 and -0 are equal), and without triangles that have no area
// (is_degenerate()). Such a triangle is removed so that its neighbours meet, and a closed surface stays
// closed:
//   - If one of its corners lies on its longest side, the triangle across that side is divided there.
//   - If it has a side shorter than 1e-8 of the longest one, the ends of that side become one vertex.
// A triangle without area is only left out if its longest side has no other triangle, or several.
//
// Small fins, which bound no volume, are left out, too: triangles of which two sides have no other triangle
// and the third has at least two others, and whose corner is within 1e-3 of the mesh's longest extent of that
// side. Reconstruction and decimation leave such triangles on closed surfaces.
//
// Vertices that no triangle uses are left out. Vertices and triangles keep their order.
// pre: check_mesh(mesh).readable(). The result has no triangles if none has an area.
TriangleMesh welded_mesh(const TriangleMesh& mesh);

// Vertices and triangles keep their order.
void leave_out_unused_vertices(TriangleMesh& mesh);

// The point of a surface that is nearest to a position. The normal is a unit vector: that of the face, or at
// an edge or a vertex the mean of the faces that meet there, weighted by their angles.
struct NearestOnMesh {
  double distance_m = 0;  // 0 or more on the side to which the normal points, negative on the other
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  // The surface ends at the nearest point, see Pseudonormals::edge_on_border: beyond it the side is unknown.
  bool on_border = false;
};

// A surface of triangles at rest, in its own frame. Its corners run counter-clockwise seen from outside.
// Vertices at the same position count as one.
//
// A closed surface bounds a solid (FaceSide): all positions around which the whole mesh winds once or
// more. Its sign is right everywhere. Parts may touch, lie in each other and cross: faces with the solid on
// both sides are left out, unless other faces cross them. Near faces that are crossed the sign is that of the
// winding number, and the distance is that to the nearest face, which inside of the solid may lie in the
// solid, too. Elsewhere, and for a surface with a border, the sign is that of the normal; it is right
// wherever the nearest point is not on the border if the surface does not cross itself.
class MeshDistance {
 public:
  // pre: check_mesh(mesh).readable(), coordinates below 1e15 m. Triangles without area are left out, as by
  // welded_mesh().
  // Throws std::invalid_argument if no triangle has an area.
  explicit MeshDistance(const TriangleMesh& mesh);

  // Returns the nearest point, or nothing if it is not nearer than reach_m, which may be infinite. The result
  // does not depend on reach_m, nor on earlier calls: of several faces that are equally near, the first one
  // of the mesh is used. A position that is not finite, or 1e15 m away, is near nothing.
  std::optional<NearestOnMesh> nearest(const Vec3& p, double reach_m) const;

  // True if the surface has no border: it bounds solids, and the sign is known everywhere. As many triangles
  // run along every edge in one direction as in the other; unlike for check_mesh(), they may be more than
  // two.
  bool is_closed() const { return surface_.is_closed; }
  // True if a part of a closed surface has the solid on neither side: its triangles run clockwise.
  bool has_inverted_part() const { return surface_.has_inverted_part; }
  // True if faces of a closed surface cross each other.
  bool crosses_itself() const { return surface_.winding != nullptr; }

  // The surface that is measured: welded_mesh() of the mesh, without faces inside of its solid.
  const std::vector<Vec3>& vertices() const { return surface_.mesh.vertices; }
  const std::vector<std::array<int, 3>>& triangles() const { return surface_.mesh.triangles; }

 private:
  struct OnFace;
  struct Surface {
    TriangleMesh mesh;
    bool is_closed = false, has_inverted_part = false;
    std::vector<char> is_doubtful;  // faces whose normals may give the wrong sign: crossed ones, neighbours
    std::shared_ptr<const TriangleTree> winding;  // of the whole mesh; null: no face is crossed
  };
  static Surface surface_of(const TriangleMesh& mesh);
  OnFace nearest_on_face(int face, const Vec3& p) const;
  NearestOnMesh with_normal(const OnFace& nearest, const Vec3& p) const;

  Surface surface_;
  Pseudonormals normals_;
  FaceTree tree_;
};

}  // namespace remote_touch
