// Closed surfaces with sharp or hollow parts, open sheets, and surfaces whose triangles do not meet neatly.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "tests/support/meshes.h"

namespace remote_touch::mesh_shapes {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Two triangles for the cell of a grid whose corners are a, b (next column), c (next row) and d.
inline void add_cell(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, d});
  mesh.triangles.push_back({a, d, c});
}

inline TriangleMesh torus(int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double r = 1 + 0.4 * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), 0.4 * std::sin(v));
    }
  const auto at = [=](int i, int j) { return i % around * across + j % across; };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) add_cell(mesh, at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
  return mesh;
}

// A ball whose vertices have random distances from its centre, from 1 - depth to 1: many needles and pits.
inline TriangleMesh rough_ball(int rings, int sectors, double depth) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> radius(1 - depth, 1);
  TriangleMesh mesh{{Vec3(0, 0, radius(random)), Vec3(0, 0, -radius(random))}, {}};
  for (int i = 1; i <= rings; ++i)
    for (int j = 0; j < sectors; ++j) {
      const double u = std::numbers::pi * i / (rings + 1), v = 2 * std::numbers::pi * j / sectors;
      mesh.vertices.push_back(radius(random) *
                              Vec3(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u)));
    }
  const auto at = [=](int i, int j) { return 2 + (i - 1) * sectors + j % sectors; };
  for (int j = 0; j < sectors; ++j) {
    mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
    mesh.triangles.push_back({1, at(rings, j + 1), at(rings, j)});
    for (int i = 1; i < rings; ++i) add_cell(mesh, at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
  }
  return mesh;
}

// A polygon in the plane z = 0, counter-clockwise, as the base of a prism or a pyramid.
using Base = std::vector<Vec3>;

inline void add_base(TriangleMesh& mesh, const Base& base) {
  const auto triangles = polygon_triangles(base);
  for (const auto& [a, b, c] : *triangles) mesh.triangles.push_back({a, c, b});
}

inline TriangleMesh prism(const Base& base, double height) {
  const int n = static_cast<int>(base.size());
  TriangleMesh mesh{base, {}};
  add_base(mesh, base);
  const auto top = polygon_triangles(base);
  for (const auto& [a, b, c] : *top) mesh.triangles.push_back({a + n, b + n, c + n});
  for (const Vec3& v : base) mesh.vertices.push_back(v + Vec3(0, 0, height));
  for (int i = 0; i < n; ++i) add_cell(mesh, i, (i + 1) % n, i + n, (i + 1) % n + n);
  return mesh;
}

// The apex is the last vertex. The triangles of the base come first.
inline TriangleMesh pyramid(const Base& base, const Vec3& apex) {
  const int n = static_cast<int>(base.size());
  TriangleMesh mesh{base, {}};
  add_base(mesh, base);
  mesh.vertices.push_back(apex);
  for (int i = 0; i < n; ++i) mesh.triangles.push_back({i, (i + 1) % n, n});
  return mesh;
}

inline const Base kL{{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
inline const Base kSquare{{-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}};

// A square whose side y = -0.1 is divided into 20 parts.
inline Base divided_square() {
  Base base;
  for (int i = 0; i < 20; ++i) base.emplace_back(-0.1 + 0.01 * i, -0.1, 0);
  base.insert(base.end(), kSquare.begin() + 1, kSquare.end());
  return base;
}

// An open surface over the unit square, with heights from 0 to `height` above n x n cells.
struct Sheet {
  Sheet(int n_, double height) : n(n_) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0, height);
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) mesh.vertices.emplace_back(double(i) / n, double(j) / n, any(random));
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) add_cell(mesh, at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
  }
  int at(int i, int j) const { return j * (n + 1) + i; }
  // The height of the triangle that contains (x, y), which is in the unit square.
  double height_at(double x, double y) const {
    const int i = std::min(static_cast<int>(x * n), n - 1), j = std::min(static_cast<int>(y * n), n - 1);
    const double u = x * n - i, v = y * n - j;
    const double a = z(i, j), b = z(i + 1, j), c = z(i, j + 1), d = z(i + 1, j + 1);
    return u > v ? a + u * (b - a) + v * (d - b) : a + v * (c - a) + u * (d - c);
  }
  double z(int i, int j) const { return mesh.vertices[at(i, j)].z(); }

  int n;
  TriangleMesh mesh;
};

// Two boxes of 1 x 1 x 1 that touch along the z axis, which is one edge of four faces.
inline TriangleMesh boxes_at_an_edge() {
  TriangleMesh mesh =
      meshes::together(box_mesh({1, 1, 1}, {0.5, 0.5, 0.5}), box_mesh({1, 1, 1}, {-0.5, -0.5, 0.5}));
  const auto first_at = [&](int v) {
    const auto at = std::find(mesh.vertices.begin(), mesh.vertices.end(), mesh.vertices[v]);
    return static_cast<int>(at - mesh.vertices.begin());
  };
  for (auto& triangle : mesh.triangles)
    for (int& corner : triangle) corner = first_at(corner);
  return mesh;
}

// Every triangle has three vertices of its own. A zero coordinate has any sign.
inline TriangleMesh loose_triangles(const TriangleMesh& mesh) {
  TriangleMesh loose;
  for (const auto& triangle : mesh.triangles) {
    const int first = static_cast<int>(loose.vertices.size());
    for (const int corner : triangle) {
      loose.vertices.push_back(mesh.vertices[corner]);
      for (double& x : loose.vertices.back())
        if (x == 0 && first % 2 == 0) x = -x;
    }
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  return loose;
}

// Divides the first triangle that runs from vertex i to vertex j at positions on this side, given in this
// order. The triangle on the other side of the edge keeps it whole: triangles without area lie between them.
inline TriangleMesh with_divided_side(TriangleMesh mesh, int i, int j, const std::vector<Vec3>& positions) {
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int side = 0; side < 3; ++side) {
      if (mesh.triangles[t][side] != i || mesh.triangles[t][(side + 1) % 3] != j) continue;
      const int x = mesh.triangles[t][(side + 2) % 3];
      mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(t));
      int last = i;
      for (const Vec3& p : positions) {
        const int next = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(p);
        mesh.triangles.push_back({last, next, x});
        if (last != i) mesh.triangles.push_back({i, next, last});
        last = next;
      }
      mesh.triangles.push_back({last, j, x});
      mesh.triangles.push_back({i, j, last});
      return mesh;
    }
  return {};
}

class RandomVectors {
 public:
  explicit RandomVectors(unsigned seed) : random_(seed) {}
  Vec3 in_box(const BoundingBox& box) {
    std::uniform_real_distribution<double> any(-0.7, 0.7);
    return box.center() + box.sizes().cwiseProduct(Vec3(any(random_), any(random_), any(random_)));
  }
  Vec3 direction() {
    std::normal_distribution<double> normal;
    return Vec3(normal(random_), normal(random_), normal(random_)).normalized();
  }

 private:
  std::mt19937 random_;
};

}  // namespace remote_touch::mesh_shapes
