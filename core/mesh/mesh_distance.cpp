#include "core/mesh/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/mesh/mesh_sides.h"
#include "core/mesh/welded_mesh.h"

namespace remote_touch {

// The surface that is measured, and the whole mesh for its winding number if faces cross.
struct MeshDistance::Surface {
  TriangleMesh mesh;
  bool is_closed = false, has_inverted_part = false;
  std::vector<char> is_doubtful;
  std::shared_ptr<const TriangleTree> winding;
};

MeshDistance::Surface MeshDistance::surface_of(const TriangleMesh& mesh) {
  Surface surface;
  surface.mesh = welded_mesh(mesh);
  TriangleMesh& welded = surface.mesh;
  if (welded.triangles.empty()) throw std::invalid_argument("MeshDistance: no triangle has an area");
  surface.is_closed = is_closed_surface(welded);
  if (!surface.is_closed) return surface;
  const std::vector<FaceSide> sides = face_sides(welded);
  const auto have = [&](FaceSide side) { return std::find(sides.begin(), sides.end(), side) != sides.end(); };
  surface.has_inverted_part = has_inverted_part_in(welded, sides);
  std::vector<char> at_crossed(welded.vertices.size(), 0);
  if (have(FaceSide::crossed)) surface.winding = std::make_shared<const TriangleTree>(welded);
  for (std::size_t f = 0; f < sides.size(); ++f)
    if (sides[f] == FaceSide::crossed || sides[f] == FaceSide::inverted)
      for (const int corner : welded.triangles[f]) at_crossed[corner] = 1;
  std::vector<std::array<int, 3>> kept;
  for (std::size_t f = 0; f < sides.size(); ++f) {
    const auto& triangle = welded.triangles[f];
    if (sides[f] == FaceSide::inner) continue;
    kept.push_back(triangle);
    surface.is_doubtful.push_back(
        std::any_of(triangle.begin(), triangle.end(), [&](int corner) { return at_crossed[corner] != 0; }));
  }
  welded.triangles = std::move(kept);
  leave_out_unused_vertices(welded);
  return surface;
}

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

MeshDistance::MeshDistance(const TriangleMesh& mesh) : MeshDistance(surface_of(mesh)) {}

MeshDistance::MeshDistance(Surface surface)
    : mesh_(std::move(surface.mesh)),
      normals_(pseudonormals(mesh_)),
      tree_(mesh_),
      is_closed_(surface.is_closed),
      has_inverted_part_(surface.has_inverted_part),
      is_doubtful_(std::move(surface.is_doubtful)),
      winding_(std::move(surface.winding)) {}

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
  if (is_closed_) result.on_border = false;  // faces inside of the solid are left out beside others
  const double distance_m = std::sqrt(nearest.squared_m2);
  bool is_inside = (p - nearest.point).dot(result.normal) < 0;
  if (winding_ && is_doubtful_[nearest.face] != 0) {
    const double turns = winding_->winding_number(p);
    // The number is about 1/2 on a face, and says nothing there.
    if (std::abs(turns - 0.5) > 0.1 && (turns > 0.5) != is_inside) {
      is_inside = !is_inside;
      result.normal = -result.normal;
    }
  }
  result.distance_m = is_inside ? -distance_m : distance_m;
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
