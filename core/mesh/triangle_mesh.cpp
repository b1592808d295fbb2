#include "core/mesh/triangle_mesh.h"

#include <cmath>
#include <numeric>

namespace remote_touch {
namespace {

using Vec2 = Eigen::Vector2d;
using Triangles = std::vector<std::array<int, 3>>;

// Twice the area of a triangle, positive counter-clockwise.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

Triangles fan(std::size_t corners) {
  Triangles triangles;
  for (int i = 2; i < static_cast<int>(corners); ++i) triangles.push_back({0, i - 1, i});
  return triangles;
}

// Twice the area of the polygon, along its normal.
Vec3 area_vector(const std::vector<Vec3>& corners) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 2; i < corners.size(); ++i)
    sum += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  return sum;
}

// True if no triangle of the polygon's fan has an area; the limit is that of is_degenerate().
bool is_line(const std::vector<Vec3>& corners) {
  double max_length = 0, max_area = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    max_length = std::max(max_length, (corners[i] - corners[0]).squaredNorm());
    max_area = std::max(max_area, (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]).norm());
  }
  return max_area <= 1e-10 * max_length;
}

// True if the loops of a polygon that crosses itself cancel each other: the area vector is rounding.
bool has_no_normal(const std::vector<Vec3>& corners, const Vec3& area) {
  double max_length = 0;
  for (const Vec3& corner : corners) max_length = std::max(max_length, (corner - corners[0]).squaredNorm());
  return area.norm() <= 1e-10 * max_length;
}

// True if the corners are in one plane, up to the rounding of single precision.
bool is_flat(const std::vector<Vec3>& corners, const Vec3& unit_normal) {
  double max_height = 0, max_length = 0;
  for (const Vec3& corner : corners) {
    max_height = std::max(max_height, std::abs((corner - corners[0]).dot(unit_normal)));
    max_length = std::max(max_length, (corner - corners[0]).norm());
  }
  return max_height <= 1e-6 * max_length;
}

// Projects the polygon so that it runs counter-clockwise: along its normal, so that the result does not
// depend on the axes of the file. In a plane any direction shows the same polygon. There the projection drops
// one coordinate and computes none, because rounding would bend straight edges.
std::vector<Vec2> seen_flat(const std::vector<Vec3>& corners, const Vec3& normal) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const double sign = normal[axis] < 0 ? -1 : 1;
  Vec3 x = Vec3::Unit((axis + 1) % 3), y = sign * Vec3::Unit((axis + 2) % 3);
  const Vec3 unit_normal = normal.normalized();
  if (!is_flat(corners, unit_normal)) {
    x = (x - x.dot(unit_normal) * unit_normal).normalized();
    y = unit_normal.cross(x);
  }
  std::vector<Vec2> flat;
  for (const Vec3& corner : corners) flat.emplace_back(x.dot(corner), y.dot(corner));
  return flat;
}

// Returns true if the directions from the first corner to the others turn counter-clockwise from one to the
// next, and by less than half a turn in all.
bool has_fan(const std::vector<Vec2>& at) {
  for (std::size_t i = 2; i < at.size(); ++i)
    if (!(turn(at[0], at[1], at[i]) > 0) || !(turn(at[0], at[i - 1], at[i]) > 0)) return false;
  return true;
}

bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const bool boxes_meet = (a.cwiseMin(b).array() <= c.cwiseMax(d).array()).all() &&
                          (c.cwiseMin(d).array() <= a.cwiseMax(b).array()).all();
  return boxes_meet && !(turn(a, b, c) * turn(a, b, d) > 0) && !(turn(c, d, a) * turn(c, d, b) > 0);
}

// True if no edges meet, except neighbours in their common corner.
bool is_simple(const std::vector<Vec2>& at) {
  const std::size_t n = at.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 &from = at[i], &to = at[(i + 1) % n], &next = at[(i + 2) % n];
    if (turn(from, to, next) == 0 && (from - to).dot(next - to) > 0) return false;
    for (std::size_t j = i + 2; j < n; ++j)
      if ((j + 1) % n != i && meet(from, to, at[j], at[(j + 1) % n])) return false;
  }
  return true;
}

// True if the triangle of a corner and its neighbours lies inside and contains no other corner.
bool is_ear(const std::vector<Vec2>& at, const std::vector<int>& left, std::size_t place) {
  const std::size_t n = left.size(), before = (place + n - 1) % n, after = (place + 1) % n;
  const Vec2 &a = at[left[before]], &b = at[left[place]], &c = at[left[after]];
  if (!(turn(a, b, c) > 0)) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (i == before || i == place || i == after) continue;
    const Vec2& p = at[left[i]];
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

// Cuts off one ear after the other. Returns nullopt if no ear is left before the polygon is used up.
std::optional<Triangles> ears(const std::vector<Vec2>& at) {
  std::vector<int> left(at.size());
  std::iota(left.begin(), left.end(), 0);
  Triangles triangles;
  for (std::size_t place = 0, tried = 0; left.size() > 2; place = (place + 1) % left.size()) {
    const std::size_t n = left.size();
    if (is_ear(at, left, place)) {
      triangles.push_back({left[(place + n - 1) % n], left[place], left[(place + 1) % n]});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(place));
      tried = 0;
    } else if (++tried == n) {
      return {};
    }
  }
  return triangles;
}

// Returns true if the areas of the triangles add up to that of the polygon. All areas are counted as
// positive, so an error of one cannot cancel that of another.
bool have_area_of_polygon(const Triangles& triangles, const std::vector<Vec2>& at) {
  double whole = 0, sum = 0;
  for (std::size_t i = 2; i < at.size(); ++i) whole += turn(at[0], at[i - 1], at[i]);
  for (const auto& [a, b, c] : triangles) sum += std::abs(turn(at[a], at[b], at[c]));
  return std::abs(sum - whole) <= 1e-9 * whole;
}

}  // namespace

std::optional<std::vector<std::array<int, 3>>> polygon_triangles(const std::vector<Vec3>& corners) {
  if (is_line(corners)) return fan(corners.size());
  const Vec3 area = area_vector(corners);
  if (has_no_normal(corners, area)) return {};
  const std::vector<Vec2> at = seen_flat(corners, area);
  if (has_fan(at)) return fan(corners.size());
  if (!is_simple(at)) return {};
  std::optional<Triangles> triangles = ears(at);
  if (triangles && !have_area_of_polygon(*triangles, at)) return {};
  return triangles;
}

}  // namespace remote_touch
