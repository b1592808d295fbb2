#include "core/rivals/grid_mesh.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

// The fraction of its size by which a triangle is enlarged; it is far above rounding.
constexpr double kSeam = 1e-9;

// Returns the area of (a, b, p), seen along the normal, as a fraction of the area of the triangle. It is 0 or
// more on the inner side of the edge ab.
double beside_edge(const Vec3& a, const Vec3& b, const Vec3& p, const Vec3& normal, double doubled_area) {
  return (b - a).cross(p - a).dot(normal) / doubled_area;
}

bool contains(const Triangle& t, const Vec3& p) {
  const double doubled = (t.b - t.a).cross(t.c - t.a).dot(t.normal);
  return beside_edge(t.a, t.b, p, t.normal, doubled) >= -kSeam &&
         beside_edge(t.b, t.c, p, t.normal, doubled) >= -kSeam &&
         beside_edge(t.c, t.a, p, t.normal, doubled) >= -kSeam;
}

}  // namespace

void GridMesh::reserve(std::size_t points) {
  triangles_.grow(2 * points);
  index_plus_one_.grow(2 * points);  // room for a last row that is not full
}

void GridMesh::assign(const GatheredPoints& points, int columns, const Ball& ball) {
  count_ = 0;
  if (points.size() == 0) return;
  const auto wide = static_cast<std::uint32_t>(columns);
  std::uint32_t first_row = ~0u, last_row = 0, first_column = ~0u, last_column = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t row = points.index()[i] / wide, column = points.index()[i] % wide;
    first_row = std::min(first_row, row), last_row = std::max(last_row, row);
    first_column = std::min(first_column, column), last_column = std::max(last_column, column);
  }
  const std::size_t width = last_column - first_column + 1, height = last_row - first_row + 1;
  std::fill_n(index_plus_one_.data(), width * height, 0u);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::uint32_t row = points.index()[i] / wide, column = points.index()[i] % wide;
    index_plus_one_[(row - first_row) * width + (column - first_column)] = static_cast<std::uint32_t>(i) + 1;
  }

  const PointsView view = points.view();
  const auto point = [&](std::uint32_t place) {
    return Vec3(view.x[place - 1], view.y[place - 1], view.z[place - 1]);
  };
  for (std::size_t row = 0; row + 1 < height; ++row) {
    for (std::size_t column = 0; column + 1 < width; ++column) {
      const std::uint32_t* const upper = index_plus_one_.data() + row * width + column;
      const std::uint32_t a = upper[0], b = upper[1], c = upper[width], d = upper[width + 1];
      const int measured = (a != 0) + (b != 0) + (c != 0) + (d != 0);
      if (measured < 3) continue;
      if (a != 0 && b != 0 && c != 0) add(point(a), point(b), point(c), ball);
      if (d != 0 && c != 0 && b != 0) add(point(d), point(c), point(b), ball);
      if (c == 0) add(point(a), point(b), point(d), ball);
      if (b == 0) add(point(a), point(d), point(c), ball);
    }
  }
}

void GridMesh::add(const Vec3& a, const Vec3& b, const Vec3& c, const Ball& ball) {
  const double limit = edge_limit_m_ * edge_limit_m_;
  if (!((b - a).squaredNorm() <= limit && (c - b).squaredNorm() <= limit && (a - c).squaredNorm() <= limit))
    return;
  const Vec3 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
  const Vec3 nearest = ball.centre.cwiseMax(low).cwiseMin(high);
  if ((nearest - ball.centre).squaredNorm() > ball.radius * ball.radius) return;
  const Vec3 n = (b - a).cross(c - a);
  const double length = n.norm();
  if (!(length > 0)) return;  // three points on a line form no triangle
  triangles_[count_++] = {a, b, c, n / length};
}

std::optional<Crossing> GridMesh::first_crossing(const Vec3& from, const Vec3& to) const {
  std::optional<Crossing> first;
  for (const Triangle& t : triangles()) {
    const double over = t.normal.dot(from - t.a), side = over < 0 ? -1 : 1;
    const Crossing crossing{&t, side * over, side * t.normal.dot(to - t.a)};
    if (!(crossing.start > 0 && crossing.end <= 0)) continue;
    if (first && !(crossing.fraction() < first->fraction())) continue;
    if (contains(t, from + crossing.fraction() * (to - from))) first = crossing;
  }
  return first;
}

}  // namespace remote_touch
