// Meshes for tests, and properties of a mesh that are found from every triangle.
#pragma once

#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace remote_touch::meshes {

inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Matrix3d& linear, const Vec3& by) {
  for (Vec3& v : mesh.vertices) v = linear * v + by;
  return mesh;
}

inline TriangleMesh inside_out(TriangleMesh mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

inline TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
  const int first = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& [i, j, k] : b.triangles) a.triangles.push_back({i + first, j + first, k + first});
  return a;
}

inline TriangleMesh tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {{a, b, c, d}, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};  // outwards for (b-a)x(c-a).(d-a) > 0
}

// A rotation about no special axis.
inline Eigen::Matrix3d rotated() {
  Eigen::Matrix3d about_x, about_y;
  about_x << 1, 0, 0, 0, 0.8, -0.6, 0, 0.6, 0.8;
  about_y << 0.28, 0, 0.96, 0, 1, 0, -0.96, 0, 0.28;
  return about_x * about_y;
}

// The references below go over all triangles.
double to_segment(const Vec3& p, const Vec3& a, const Vec3& b);
// Distance to the triangle: to its plane if the point lies inside all edges, else to the nearest edge.
double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);
double distance(const TriangleMesh& mesh, const Vec3& p);
// Winding number from the solid angles of all triangles: 1 inside, 0 outside.
double winding(const TriangleMesh& mesh, const Vec3& p);
// True if nothing of the polygon remains after it is clipped at the six sides of the box.
bool clipped_away(std::vector<Vec3> polygon, const Vec3& low, const Vec3& high);

// A dented, slanted body of many small triangles: a built-in tool, turned and moved.
inline TriangleMesh any_body(const char* name = "ball") {
  return moved(find_generated_tool(name)->make(), rotated(), {0.01, -0.02, 0.03});
}

}  // namespace remote_touch::meshes
