// Meshes for tests, and properties of a mesh that are found from every triangle.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
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

inline double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

// Distance to the triangle: to its plane if the point lies inside all edges, else to the nearest edge.
inline double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a).normalized();
  if (n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
      n.dot((a - c).cross(p - c)) >= 0)
    return std::abs(n.dot(p - a));
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

inline double distance(const TriangleMesh& mesh, const Vec3& p) {
  double min = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles)
    min = std::min(min, to_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  return min;
}

// Winding number from the solid angles of all triangles: 1 inside, 0 outside.
inline double winding(const TriangleMesh& mesh, const Vec3& p) {
  double angle = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = (mesh.vertices[i] - p).normalized(), b = (mesh.vertices[j] - p).normalized();
    const Vec3 c = (mesh.vertices[k] - p).normalized();
    angle += 2 * std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return angle / (4 * 3.14159265358979323846);
}

// True if nothing of the polygon remains after it is clipped at the six sides of the box.
inline bool clipped_away(std::vector<Vec3> polygon, const Vec3& low, const Vec3& high) {
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      const double limit = sign > 0 ? high[axis] : -low[axis];
      const auto beyond = [&](const Vec3& v) { return sign * v[axis] > limit; };
      if (std::all_of(polygon.begin(), polygon.end(), beyond)) return true;
      if (std::none_of(polygon.begin(), polygon.end(), beyond)) continue;
      std::vector<Vec3> kept;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &from = polygon[i], &to = polygon[(i + 1) % polygon.size()];
        const double over = sign * from[axis] - limit, over_to = sign * to[axis] - limit;
        if (over <= 0) kept.push_back(from);
        if (over * over_to < 0) kept.push_back(from + over / (over - over_to) * (to - from));
      }
      polygon = kept;
    }
  return polygon.empty();
}

// A dented, slanted body of many small triangles: a built-in tool, turned and moved.
inline TriangleMesh any_body(const char* name = "ball") {
  return moved(find_generated_tool(name)->make(), rotated(), {0.01, -0.02, 0.03});
}

}  // namespace remote_touch::meshes
