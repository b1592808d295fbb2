#include "core/dissertation/tool/shape/marching_tetrahedra.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/parameters/input_error.h"

namespace remote_touch {

namespace {

// Corner c of a cube is at (c & 1, c >> 1 & 1, c >> 2). Each tetrahedron consists of the four corners along
// one of the six paths over edges from corner 0 to corner 7. Every second one has two corners swapped, so
// that all tetrahedra have the same orientation.
constexpr int kDirections[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                   {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};

class March {
 public:
  March(const std::function<double(const Vec3&)>& function, const Vec3& low, const Vec3& high, double cell_m)
      : function_(function), low_(low), cell_m_(cell_m) {
    for (int i = 0; i < 3; ++i) nodes_[i] = static_cast<int>(std::ceil((high[i] - low[i]) / cell_m)) + 1;
    values_.resize(std::size_t(nodes_[0]) * nodes_[1] * nodes_[2]);
#pragma omp parallel for schedule(dynamic, 64)
    for (std::size_t n = 0; n < values_.size(); ++n) values_[n] = function_(place(n));
  }

  TriangleMesh run() {
    for (int k = 0; k + 1 < nodes_[2]; ++k)
      for (int j = 0; j + 1 < nodes_[1]; ++j)
        for (int i = 0; i + 1 < nodes_[0]; ++i) cube(i, j, k);
    if (open_) throw InputError("marching tetrahedra", "the body reaches the side of its box");
    return std::move(mesh_);
  }

 private:
  std::size_t index(int i, int j, int k) const {
    return i + nodes_[0] * (j + std::size_t(nodes_[1]) * k);
  }
  Vec3 place(std::size_t n) const {
    const std::size_t columns = nodes_[0], rows = nodes_[1];
    const std::size_t i = n % columns, j = n / columns % rows, k = n / columns / rows;
    return low_ + cell_m_ * Vec3(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
  }

  void cube(int i, int j, int k) {
    std::size_t corner[8];
    int inside = 0;
    for (int c = 0; c < 8; ++c) {
      corner[c] = index(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
      inside += values_[corner[c]] < 0;
    }
    if (inside == 0) return;
    if (i == 0 || j == 0 || k == 0 || i + 2 == nodes_[0] || j + 2 == nodes_[1] || k + 2 == nodes_[2])
      for (const std::size_t n : corner) open_ |= values_[n] < 0 && on_side(n);
    if (inside == 8) return;
    for (const auto& displacement : kDirections)
      tetrahedron({corner[displacement[0]], corner[displacement[1]], corner[displacement[2]],
                   corner[displacement[3]]});
  }

  bool on_side(std::size_t n) const {
    const int i = static_cast<int>(n % nodes_[0]), j = static_cast<int>(n / nodes_[0] % nodes_[1]);
    const int k = static_cast<int>(n / nodes_[0] / nodes_[1]);
    return i == 0 || j == 0 || k == 0 || i + 1 == nodes_[0] || j + 1 == nodes_[1] || k + 1 == nodes_[2];
  }

  // Adds a triangle if one corner is on the other side, and a quadrangle if two are.
  void tetrahedron(std::array<std::size_t, 4> n) {
    std::stable_partition(n.begin(), n.end(), [&](std::size_t m) { return values_[m] < 0; });
    const auto inside = std::count_if(n.begin(), n.end(), [&](std::size_t m) { return values_[m] < 0; });
    if (inside == 1) {
      triangle({vertex(n[0], n[1]), vertex(n[0], n[2]), vertex(n[0], n[3])}, n[0], n[1]);
    } else if (inside == 3) {
      triangle({vertex(n[0], n[3]), vertex(n[1], n[3]), vertex(n[2], n[3])}, n[0], n[3]);
    } else if (inside == 2) {
      const int a = vertex(n[0], n[2]), b = vertex(n[0], n[3]), c = vertex(n[1], n[3]),
                d = vertex(n[1], n[2]);
      triangle({a, b, c}, n[0], n[2]);
      triangle({a, c, d}, n[0], n[2]);
    }
  }

  // Adds a triangle. Its corners are ordered so that the normal points from the node inside to the node
  // outside.
  void triangle(std::array<int, 3> v, std::size_t in, std::size_t out) {
    const Vec3 &a = mesh_.vertices[v[0]], &b = mesh_.vertices[v[1]], &c = mesh_.vertices[v[2]];
    if ((b - a).cross(c - a).dot(place(out) - place(in)) < 0) std::swap(v[1], v[2]);
    mesh_.triangles.push_back(v);
  }

  // Returns the vertex on the edge from a node inside to a node outside, where the function vanishes. It is
  // made once for each edge.
  int vertex(std::size_t in, std::size_t out) {
    const std::size_t low = std::min(in, out), high = std::max(in, out);
    // Ends of an edge differ by 0 or 1 along every axis.
    const std::size_t step = high - low;
    const int displacement = static_cast<int>(step % nodes_[0] != 0) +
                             2 * (step / nodes_[0] % nodes_[1] != 0) +
                             4 * (step / nodes_[0] / nodes_[1] != 0);
    const auto [found, is_new] =
        vertices_.try_emplace(8 * low + displacement, static_cast<int>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(root(in, out));
    return found->second;
  }

  // Finds the root by bisection and false position in turns.
  Vec3 root(std::size_t in, std::size_t out) const {
    const Vec3 from = place(in), displacement = place(out) - from;
    double a = 0, b = 1, fa = values_[in], fb = values_[out];
    for (int i = 0; i < 8; ++i) {
      const double t = i % 2 == 0 ? a + (b - a) * fa / (fa - fb) : 0.5 * (a + b);
      const double f = function_(from + t * displacement);
      if (f < 0)
        a = t, fa = f;
      else
        b = t, fb = f;
    }
    return from + std::clamp(a + (b - a) * fa / (fa - fb), 0.01, 0.99) * displacement;
  }

  const std::function<double(const Vec3&)>& function_;
  Vec3 low_;
  double cell_m_;
  std::array<int, 3> nodes_;
  std::vector<double> values_;
  std::unordered_map<std::size_t, int> vertices_;  // vertex of each edge; looked up only, never iterated
  TriangleMesh mesh_;
  bool open_ = false;
};

}  // namespace

TriangleMesh marching_tetrahedra(const std::function<double(const Vec3&)>& function, const Vec3& low,
                                 const Vec3& high, double cell_m) {
  return March(function, low, high, cell_m).run();
}

}  // namespace remote_touch
