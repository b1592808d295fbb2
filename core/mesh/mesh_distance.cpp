#include "core/mesh/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/mesh/welded_mesh.h"

namespace remote_touch {

namespace {

TriangleMesh with_area(const TriangleMesh& mesh) {
  TriangleMesh welded = welded_mesh(mesh);
  if (welded.triangles.empty()) throw std::invalid_argument("MeshDistance: no triangle has an area");
  return welded;
}

}  // namespace

// The point of a face that is nearest to a position, and the part of the face that contains it.
struct MeshDistance::OnFace {
  enum class Part { face, side, corner };

  int face = -1;
  double squared_m2 = std::numeric_limits<double>::infinity();
  Vec3 point = Vec3::Zero();
  Part part = Part::face;
  int number = 0;  // number of the side, from corner `number` to the next one, or of the corner

  void take_if_nearer(double squared, const Vec3& at, Part of, int its_number) {
    if (!(squared < squared_m2)) return;
    squared_m2 = squared, point = at, part = of, number = its_number;
  }
};

MeshDistance::MeshDistance(const TriangleMesh& mesh)
    : mesh_(with_area(mesh)),
      normals_(pseudonormals(mesh_)),
      tree_(mesh_),
      is_closed_(std::count(normals_.edge_on_border.begin(), normals_.edge_on_border.end(), 1) == 0) {}

// Each side has a plane that contains it and is normal to the face. If p is beyond the planes of some sides,
// the nearest point is on one of these sides, because it can be seen from the foot of p in the plane of the
// face. Otherwise it is that foot. These products are accurate for slim triangles, too, unlike barycentric
// coordinates from the products of the sides.
MeshDistance::OnFace MeshDistance::nearest_on_face(int face, const Vec3& p) const {
  OnFace nearest;
  nearest.face = face;
  const Vec3& normal = normals_.of_face[face];
  const auto& corners = mesh_.triangles[face];
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    const Vec3 &from = mesh_.vertices[corners[i]], &to = mesh_.vertices[corners[next]];
    const Vec3 side = to - from, v = p - from;
    if (side.cross(v).dot(normal) > 0) continue;
    const double along = v.dot(side), whole = side.squaredNorm();
    if (along <= 0) {
      nearest.take_if_nearer(v.squaredNorm(), from, OnFace::Part::corner, i);
    } else if (along >= whole) {
      nearest.take_if_nearer((p - to).squaredNorm(), to, OnFace::Part::corner, next);
    } else {
      const Vec3 foot = from + along / whole * side;
      nearest.take_if_nearer((p - foot).squaredNorm(), foot, OnFace::Part::side, i);
    }
  }
  if (nearest.squared_m2 < std::numeric_limits<double>::infinity()) return nearest;
  const double height_m = (p - mesh_.vertices[corners[0]]).dot(normal);
  nearest.take_if_nearer(height_m * height_m, p - height_m * normal, OnFace::Part::face, 0);
  return nearest;
}

NearestOnMesh MeshDistance::with_normal(const OnFace& nearest, const Vec3& p) const {
  NearestOnMesh result;
  result.point = nearest.point;
  if (nearest.part == OnFace::Part::face) {
    result.normal = normals_.of_face[nearest.face];
  } else if (nearest.part == OnFace::Part::side) {
    const int edge = normals_.edges_of_face[nearest.face][nearest.number];
    result.normal = normals_.of_edge[edge];
    result.on_border = normals_.edge_on_border[edge] != 0;
  } else {
    const int vertex = mesh_.triangles[nearest.face][nearest.number];
    result.normal = normals_.of_vertex[vertex];
    result.on_border = normals_.vertex_on_border[vertex] != 0;
  }
  const double distance_m = std::sqrt(nearest.squared_m2);
  result.distance_m = (p - nearest.point).dot(result.normal) >= 0 ? distance_m : -distance_m;
  return result;
}

std::optional<NearestOnMesh> MeshDistance::nearest(const Vec3& p, double reach_m) const {
  if (!(reach_m > 0)) return std::nullopt;
  OnFace best;
  tree_.visit(p, reach_m, [&](int face) {
    const OnFace found = nearest_on_face(face, p);
    if (found.squared_m2 < best.squared_m2 || (found.squared_m2 == best.squared_m2 && face < best.face))
      best = found;
  });
  if (!(std::sqrt(best.squared_m2) < reach_m)) return std::nullopt;
  return with_normal(best, p);
}

}  // namespace remote_touch
