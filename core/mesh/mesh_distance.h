// The signed distance to a surface of triangles, its nearest point and its normal.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/mesh/face_tree.h"
#include "core/mesh/pseudonormals.h"
#include "core/mesh/triangle_mesh.h"

namespace remote_touch {

// The point of a surface that is nearest to a position. The normal is a unit vector: that of the face, or at
// an edge or a vertex the mean of the faces that meet there, weighted by their angles (pseudonormals.h).
struct NearestOnMesh {
  double distance_m = 0;  // 0 or more on the side to which the normal points, negative on the other
  Vec3 point = Vec3::Zero();
  Vec3 normal = Vec3::Zero();
  // The surface ends at the nearest point, see Pseudonormals::edge_on_border: beyond it the side is unknown.
  bool on_border = false;
};

// A surface of triangles at rest, in its own frame. Its corners run counter-clockwise seen from outside, and
// it does not intersect itself; parts may touch at vertices and edges. Then the sign is right wherever the
// nearest point is not on a border, so a surface without a border has the right sign everywhere. Vertices at
// the same position count as one.
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
  bool is_closed() const { return is_closed_; }

  // The surface that is measured: welded_mesh() of the mesh.
  const std::vector<Vec3>& vertices() const { return mesh_.vertices; }
  const std::vector<std::array<int, 3>>& triangles() const { return mesh_.triangles; }

 private:
  struct OnFace;
  OnFace nearest_on_face(int face, const Vec3& p) const;
  NearestOnMesh with_normal(const OnFace& nearest, const Vec3& p) const;

  TriangleMesh mesh_;
  Pseudonormals normals_;
  FaceTree tree_;
  bool is_closed_;
};

}  // namespace remote_touch
