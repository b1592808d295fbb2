// The signed distance to a surface of triangles, its nearest point and its normal.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "core/mesh/mesh_sides.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/triangle_tree.h"

namespace remote_touch {

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
// an edge or a vertex the mean of the faces that meet there, weighted by their angles (mesh_sides.h).
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
// A closed surface bounds the solid of mesh_sides.h: all positions around which the whole mesh winds once or
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
