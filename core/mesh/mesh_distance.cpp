#include "core/mesh/mesh_distance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"

namespace remote_touch {
namespace {

constexpr double kPointlike = 1e-8;  // a side of this fraction of the longest side is a point
constexpr int kMaxPasses = 256;      // a row of n corners on one side needs up to n passes
constexpr double kFin = 1e-3;        // height of a fin relative to the longest side of the mesh's box

using Triangle = std::array<int, 3>;

bool repeats_a_corner(const Triangle& triangle) {
  return triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0];
}

// Replaces vertices by others, and removes the triangles that then have a corner twice.
void replace_vertices(TriangleMesh& mesh, const std::vector<int>& replacement) {
  for (Triangle& triangle : mesh.triangles)
    for (int& corner : triangle) corner = replacement[corner];
  std::erase_if(mesh.triangles, repeats_a_corner);
}

// Returns the first vertex at the position of each vertex.
std::vector<int> first_at_same_position(const std::vector<Vec3>& vertices) {
  std::vector<int> order(vertices.size()), first(vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int v, int w) {
    const Vec3 &a = vertices[v], &b = vertices[w];
    return std::tie(a[0], a[1], a[2], v) < std::tie(b[0], b[1], b[2], w);
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    first[order[i]] = i > 0 && vertices[order[i]] == vertices[order[i - 1]] ? first[order[i - 1]] : order[i];
  return first;
}

double squared_side(const TriangleMesh& mesh, const Triangle& triangle, int side) {
  return (mesh.vertices[triangle[(side + 1) % 3]] - mesh.vertices[triangle[side]]).squaredNorm();
}

// Returns the same triangle with its longest side first, from corner 0 to corner 1.
Triangle longest_side_first(const TriangleMesh& mesh, const Triangle& triangle) {
  int longest = 0;
  for (const int side : {1, 2})
    if (squared_side(mesh, triangle, side) > squared_side(mesh, triangle, longest)) longest = side;
  return {triangle[longest], triangle[(longest + 1) % 3], triangle[(longest + 2) % 3]};
}

std::vector<int> triangles_without_area(const TriangleMesh& mesh) {
  std::vector<int> found;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (is_degenerate(mesh, mesh.triangles[t])) found.push_back(static_cast<int>(t));
  return found;
}

// Merges the ends of the sides that are as short as a point. Returns false if there are none.
bool merge_pointlike_sides(TriangleMesh& mesh, const std::vector<int>& without_area) {
  std::vector<int> replacement(mesh.vertices.size());
  std::iota(replacement.begin(), replacement.end(), 0);
  const auto remaining = [&](int v) {
    while (replacement[v] != v) v = replacement[v];
    return v;
  };
  bool any = false;
  for (const int t : without_area) {
    const Triangle corners = longest_side_first(mesh, mesh.triangles[t]);
    for (const int side : {1, 2}) {
      const double limit = kPointlike * kPointlike * squared_side(mesh, corners, 0);
      if (squared_side(mesh, corners, side) > limit) continue;
      const int a = remaining(corners[side]), b = remaining(corners[(side + 1) % 3]);
      replacement[std::max(a, b)] = std::min(a, b);
      any = true;
    }
  }
  if (!any) return false;
  for (std::size_t v = 0; v < replacement.size(); ++v) replacement[v] = remaining(static_cast<int>(v));
  replace_vertices(mesh, replacement);
  return true;
}

using EdgeRange = std::pair<std::vector<MeshEdge>::const_iterator, std::vector<MeshEdge>::const_iterator>;

EdgeRange triangles_along(const std::vector<MeshEdge>& edges, int from, int to) {
  const MeshEdge edge{std::min(from, to), std::max(from, to), 0, true};
  return std::equal_range(edges.begin(), edges.end(), edge, [](const MeshEdge& a, const MeshEdge& b) {
    return std::tie(a.low, a.high) < std::tie(b.low, b.high);
  });
}

// One pass over the triangles without area: triangle i j m and the triangle j i x across its longest side
// become m i x and x j m. A triangle that has changed in this pass waits for the next one, because `edges`
// lists its former sides. A neighbour without area is first divided across its own longest side.
bool divide_neighbours(TriangleMesh& mesh, const std::vector<int>& without_area) {
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  std::vector<char> is_changed(mesh.triangles.size(), 0);
  bool any = false;
  for (const int t : without_area) {
    const auto [i, j, m] = longest_side_first(mesh, mesh.triangles[t]);
    const auto [first, last] = triangles_along(edges, i, j);
    if (last - first != 2 || first->forward == (first + 1)->forward) continue;
    const int neighbour = first->triangle == t ? (first + 1)->triangle : first->triangle;
    if (is_changed[t] || is_changed[neighbour]) continue;
    const Triangle across = longest_side_first(mesh, mesh.triangles[neighbour]);
    if (is_degenerate(mesh, across) && !(across[0] == j && across[1] == i)) continue;
    const int x = across[0] + across[1] + across[2] - i - j;
    const auto [same_first, same_last] = triangles_along(edges, m, x);
    if (x == m || same_first != same_last) continue;  // an edge of four triangles would arise
    mesh.triangles[t] = {m, i, x};
    mesh.triangles[neighbour] = {x, j, m};
    is_changed[t] = is_changed[neighbour] = 1;
    any = true;
  }
  return any;
}

// Returns true if the sides of a triangle from its corner to i and j have no other triangle, and if the
// corner is no farther than height_m from the side between i and j.
bool is_fin(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges, const Triangle& triangle, int i,
            int j, double height_m) {
  const int corner = triangle[0] + triangle[1] + triangle[2] - i - j;
  for (const int end : {i, j}) {
    const auto [first, last] = triangles_along(edges, corner, end);
    if (last - first != 1) return false;
  }
  const Vec3 side = mesh.vertices[j] - mesh.vertices[i], to_corner = mesh.vertices[corner] - mesh.vertices[i];
  return side.cross(to_corner).norm() <= height_m * side.norm();
}

void leave_out_small_fins(TriangleMesh& mesh) {
  BoundingBox box;
  for (const Triangle& triangle : mesh.triangles)
    for (const int corner : triangle) box.extend(mesh.vertices[corner]);
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  std::vector<int> fins;
  for_each_edge(edges, [&](std::span<const MeshEdge> sides) {
    for (const MeshEdge& side : sides)
      if (sides.size() >= 3 && is_fin(mesh, edges, mesh.triangles[side.triangle], side.low, side.high,
                                      kFin * box.sizes().maxCoeff()))
        fins.push_back(side.triangle);
  });
  std::sort(fins.begin(), fins.end(), std::greater<>());
  for (const int fin : fins) mesh.triangles.erase(mesh.triangles.begin() + fin);
}

}  // namespace

void leave_out_unused_vertices(TriangleMesh& mesh) {
  std::vector<int> now(mesh.vertices.size(), -1);
  for (const Triangle& triangle : mesh.triangles)
    for (const int corner : triangle) now[corner] = 0;
  std::vector<Vec3> kept;
  for (std::size_t v = 0; v < now.size(); ++v) {
    if (now[v] < 0) continue;
    now[v] = static_cast<int>(kept.size());
    kept.push_back(mesh.vertices[v]);
  }
  mesh.vertices = std::move(kept);
  for (Triangle& triangle : mesh.triangles)
    for (int& corner : triangle) corner = now[corner];
}

TriangleMesh welded_mesh(const TriangleMesh& mesh) {
  TriangleMesh welded = mesh;
  replace_vertices(welded, first_at_same_position(mesh.vertices));
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const std::vector<int> without_area = triangles_without_area(welded);
    if (without_area.empty()) break;
    if (!merge_pointlike_sides(welded, without_area) && !divide_neighbours(welded, without_area)) break;
  }
  std::erase_if(welded.triangles, [&](const Triangle& triangle) { return is_degenerate(welded, triangle); });
  leave_out_small_fins(welded);
  leave_out_unused_vertices(welded);
  return welded;
}

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

MeshDistance::MeshDistance(const TriangleMesh& mesh)
    : surface_(surface_of(mesh)), normals_(pseudonormals(surface_.mesh)), tree_(surface_.mesh) {}

// Each side has a plane that contains it and is normal to the face. If p is beyond the planes of some sides,
// the nearest point is on one of these sides, because it can be seen from the foot of p in the plane of the
// face. Otherwise it is that foot. These products are accurate for slim triangles, too, unlike barycentric
// coordinates from the products of the sides.
MeshDistance::OnFace MeshDistance::nearest_on_face(int face, const Vec3& p) const {
  OnFace nearest;
  nearest.face = face;
  const Vec3& normal = normals_.of_face[face];
  const auto& corners = surface_.mesh.triangles[face];
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    const Vec3 &from = surface_.mesh.vertices[corners[i]], &to = surface_.mesh.vertices[corners[next]];
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
  const double height_m = (p - surface_.mesh.vertices[corners[0]]).dot(normal);
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
    const int vertex = surface_.mesh.triangles[nearest.face][nearest.number];
    result.normal = normals_.of_vertex[vertex];
    result.on_border = normals_.vertex_on_border[vertex] != 0;
  }
  if (surface_.is_closed) result.on_border = false;  // faces inside of the solid are left out beside others
  const double distance_m = std::sqrt(nearest.squared_m2);
  bool is_inside = (p - nearest.point).dot(result.normal) < 0;
  if (surface_.winding && surface_.is_doubtful[nearest.face] != 0) {
    const double turns = surface_.winding->winding_number(p);
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
