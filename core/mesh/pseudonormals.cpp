#include "core/mesh/pseudonormals.h"

#include "core/geometry/rotation.h"
#include "core/mesh/mesh_check.h"

namespace remote_touch {

namespace {

// A mean of unit vectors that is shorter than this value is rounding.
constexpr double kVanishes = 1e-12;

struct NormalSum {
  Vec3 sum = Vec3::Zero(), first = Vec3::Zero();
  double weights = 0;

  void add(double weight, const Vec3& normal) {
    if (weights == 0) first = normal;
    sum += weight * normal;
    weights += weight;
  }
  Vec3 mean() const { return sum.norm() > kVanishes * weights ? Vec3(sum.normalized()) : first; }
};

void add_faces(const TriangleMesh& mesh, Pseudonormals& normals) {
  normals.of_face.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 ab = mesh.vertices[b] - mesh.vertices[a], ac = mesh.vertices[c] - mesh.vertices[a];
    normals.of_face.push_back(ab.cross(ac).normalized());
  }
}

// The sides of a face follow its corners, so the side with these ends is unique.
int side_between(const std::array<int, 3>& triangle, int v, int w) {
  for (int side = 0; side < 2; ++side) {
    const int from = triangle[side], to = triangle[side + 1];
    if ((from == v && to == w) || (from == w && to == v)) return side;
  }
  return 2;
}

void add_edges(const TriangleMesh& mesh, Pseudonormals& normals) {
  normals.edges_of_face.resize(mesh.triangles.size());
  normals.vertex_on_border.assign(mesh.vertices.size(), 0);
  const std::vector<MeshEdge> edges = edges_by_vertices(mesh);
  for (std::size_t first = 0, last; first < edges.size(); first = last) {
    const int low = edges[first].low, high = edges[first].high;
    const int number = static_cast<int>(normals.of_edge.size());
    NormalSum sum;
    int forward_minus_back = 0;
    for (last = first; last < edges.size() && edges[last].low == low && edges[last].high == high; ++last) {
      const int t = edges[last].triangle;
      sum.add(1, normals.of_face[t]);
      forward_minus_back += edges[last].forward ? 1 : -1;
      normals.edges_of_face[t][side_between(mesh.triangles[t], low, high)] = number;
    }
    normals.of_edge.push_back(sum.mean());
    const bool on_border = forward_minus_back != 0;
    normals.edge_on_border.push_back(on_border);
    if (on_border) normals.vertex_on_border[low] = normals.vertex_on_border[high] = 1;
  }
}

void add_vertices(const TriangleMesh& mesh, Pseudonormals& normals) {
  std::vector<NormalSum> sums(mesh.vertices.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) {
      const auto& corners = mesh.triangles[t];
      const Vec3& v = mesh.vertices[corners[i]];
      const Vec3 next = mesh.vertices[corners[(i + 1) % 3]] - v,
                 last = mesh.vertices[corners[(i + 2) % 3]] - v;
      sums[corners[i]].add(angle_between(next, last), normals.of_face[t]);
    }
  normals.of_vertex.reserve(sums.size());
  for (const NormalSum& sum : sums) normals.of_vertex.push_back(sum.mean());
}

}  // namespace

Pseudonormals pseudonormals(const TriangleMesh& mesh) {
  Pseudonormals normals;
  add_faces(mesh, normals);
  add_edges(mesh, normals);
  add_vertices(mesh, normals);
  return normals;
}

}  // namespace remote_touch
