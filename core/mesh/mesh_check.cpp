#include "core/mesh/mesh_check.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace remote_touch {

namespace {

// Returns the root of a triangle's part in a forest of parents, and shortens the paths on the way.
int root_of(std::vector<int>& parent, int triangle) {
  while (parent[triangle] != triangle) triangle = parent[triangle] = parent[parent[triangle]];
  return triangle;
}

void count_edges(const std::vector<MeshEdge>& edges, MeshCheck& check) {
  for (std::size_t first = 0, last; first < edges.size(); first = last) {
    for (last = first + 1;
         last < edges.size() && edges[last].low == edges[first].low && edges[last].high == edges[first].high;)
      ++last;
    const std::size_t triangles = last - first;
    if (triangles == 1)
      ++check.boundary_edges;
    else if (triangles > 2)
      ++check.non_manifold_edges;
    else if (edges[first].forward == edges[first + 1].forward)
      ++check.inconsistent_edges;
  }
}

}  // namespace

std::vector<MeshEdge> edges_by_vertices(const TriangleMesh& mesh) {
  std::vector<MeshEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const int from = mesh.triangles[t][i], to = mesh.triangles[t][(i + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), static_cast<int>(t), from < to});
    }
  std::sort(edges.begin(), edges.end(), [](const MeshEdge& a, const MeshEdge& b) {
    return std::tie(a.low, a.high, a.triangle, a.forward) < std::tie(b.low, b.high, b.triangle, b.forward);
  });
  return edges;
}

std::vector<int> parts_of(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges, int& count) {
  std::vector<int> parent(mesh.triangles.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::size_t e = 1; e < edges.size(); ++e) {
    if (edges[e].low != edges[e - 1].low || edges[e].high != edges[e - 1].high) continue;
    const int a = root_of(parent, edges[e - 1].triangle), b = root_of(parent, edges[e].triangle);
    parent[std::max(a, b)] = std::min(a, b);
  }
  std::vector<int> part(parent.size());
  count = 0;
  for (std::size_t t = 0; t < parent.size(); ++t) {  // a root is the first triangle of its part
    const int root = root_of(parent, static_cast<int>(t));
    part[t] = root == static_cast<int>(t) ? count++ : part[root];
  }
  return part;
}

double signed_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  const Vec3 o = mesh.vertices.front();  // a point near the mesh reduces rounding errors
  double six_volumes = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    six_volumes += (mesh.vertices[a] - o).dot((mesh.vertices[b] - o).cross(mesh.vertices[c] - o));
  return six_volumes / 6;
}

bool is_degenerate(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const auto [a, b, c] = triangle;
  if (a == b || b == c || c == a) return true;
  const Vec3 ab = mesh.vertices[b] - mesh.vertices[a], ac = mesh.vertices[c] - mesh.vertices[a];
  const double max_length = std::max({ab.squaredNorm(), ac.squaredNorm(), (ab - ac).squaredNorm()});
  return ab.cross(ac).norm() <= 1e-10 * max_length;
}

MeshCheck check_mesh(const TriangleMesh& mesh) {
  MeshCheck check;
  check.vertices = static_cast<int>(mesh.vertices.size());
  check.triangles = static_cast<int>(mesh.triangles.size());
  for (const Vec3& v : mesh.vertices) check.bad_vertices += !v.allFinite();
  for (const auto& triangle : mesh.triangles)
    check.bad_indices += std::any_of(triangle.begin(), triangle.end(),
                                     [&](int corner) { return corner < 0 || corner >= check.vertices; });
  if (!check.readable()) return check;
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  parts_of(mesh, edges, check.parts);
  count_edges(edges, check);
  for (const auto& triangle : mesh.triangles) check.degenerate_triangles += is_degenerate(mesh, triangle);
  check.volume_m3 = signed_volume(mesh);
  return check;
}

std::string text(const MeshCheck& check) {
  std::string faults;
  const auto add = [&](int count, const std::string& one, const std::string& many) {
    if (count > 0)
      faults += (faults.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
  };
  if (check.triangles == 0) return "no triangles";
  add(check.bad_vertices, "vertex that is not finite", "vertices that are not finite");
  add(check.bad_indices, "triangle with a corner that is not a vertex",
      "triangles with a corner that is not a vertex");
  if (!faults.empty()) return faults;
  add(check.boundary_edges, "boundary edge", "boundary edges");
  add(check.non_manifold_edges, "non-manifold edge", "non-manifold edges");
  add(check.inconsistent_edges, "edge between faces of opposite orientation",
      "edges between faces of opposite orientation");
  std::string all = faults.empty() ? "closed" : "not closed: " + faults;
  faults.clear();
  add(check.parts, "part", "parts");
  add(check.triangles, "triangle", "triangles");
  add(check.degenerate_triangles, "of them degenerate", "of them degenerate");
  if (check.inverted()) faults += ", inside out";
  return all + " (" + faults + ")";
}

}  // namespace remote_touch
