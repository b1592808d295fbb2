#include "tests/support/meshes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch::meshes {

double to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm();
}

double to_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 n = (b - a).cross(c - a).normalized();
  if (n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
      n.dot((a - c).cross(p - c)) >= 0)
    return std::abs(n.dot(p - a));
  return std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
}

double distance(const TriangleMesh& mesh, const Vec3& p) {
  double min = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : mesh.triangles)
    min = std::min(min, to_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
  return min;
}

double winding(const TriangleMesh& mesh, const Vec3& p) {
  double angle = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = (mesh.vertices[i] - p).normalized(), b = (mesh.vertices[j] - p).normalized();
    const Vec3 c = (mesh.vertices[k] - p).normalized();
    angle += 2 * std::atan2(a.dot(b.cross(c)), 1 + a.dot(b) + b.dot(c) + c.dot(a));
  }
  return angle / (4 * 3.14159265358979323846);
}

bool clipped_away(std::vector<Vec3> polygon, const Vec3& low, const Vec3& high) {
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

}  // namespace remote_touch::meshes
