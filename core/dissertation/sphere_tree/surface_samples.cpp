#include "core/dissertation/sphere_tree/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_set>

#include "core/dissertation/tool/contact/contact_thinning.h"

namespace remote_touch {

namespace {

Vec3 corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t i) {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][i])];
}

// Adds samples in rows that are parallel to the longest side, from a to a + base, up to the corner a + up. A
// mesh of small triangles has many more samples than one for every square of side spacing_m.
void add_rows(const Vec3& a, const Vec3& base, const Vec3& up, double spacing_m, std::vector<Vec3>& samples) {
  const double length = base.norm(), height = length > 0 ? base.cross(up).norm() / length : 0;
  const int columns = std::max(1, static_cast<int>(std::ceil(length / spacing_m))),
            rows = std::max(1, static_cast<int>(std::ceil(height / spacing_m)));
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const double above = double(j) / rows, along = double(i) / columns;
      samples.push_back(a + above * up + (1 - above) * along * base);
    }
}

}  // namespace

std::vector<Vec3> surface_samples(const TriangleMesh& mesh, double spacing_m) {
  std::vector<Vec3> samples;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto side = [&](std::size_t i) { return Vec3(corner(mesh, t, (i + 1) % 3) - corner(mesh, t, i)); };
    std::size_t first = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (side(i).norm() > side(first).norm()) first = i;
    const Vec3 a = corner(mesh, t, first);
    add_rows(a, side(first), corner(mesh, t, (first + 2) % 3) - a, spacing_m, samples);
  }
  return samples;
}

std::vector<Vec3> thinned(const std::vector<Vec3>& positions, double spacing_m) {
  std::unordered_set<std::uint64_t> seen;
  std::vector<Vec3> kept;
  for (const Vec3& position : positions)
    if (seen.insert(cell_number(position, 1 / spacing_m)).second) kept.push_back(position);
  return kept;
}

double surface_area_m2(const TriangleMesh& mesh) {
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = corner(mesh, t, 0);
    area += 0.5 * (corner(mesh, t, 1) - a).cross(corner(mesh, t, 2) - a).norm();
  }
  return area;
}

}  // namespace remote_touch
