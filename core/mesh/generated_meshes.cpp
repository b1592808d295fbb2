#include "core/mesh/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/parameters/parameter.h"

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

namespace {

constexpr double kMm = 1e-3;

// Signed distances, negative inside.
double ball(const Vec3& p, const Vec3& centre, double radius) {
  return (p - centre).norm() - radius;
}

double capsule(const Vec3& p, const Vec3& from, const Vec3& to, double radius) {
  const Vec3 displacement = to - from;
  const double t = std::clamp((p - from).dot(displacement) / displacement.squaredNorm(), 0.0, 1.0);
  return (p - from - t * displacement).norm() - radius;
}

// Returns the distance to a box whose edges and corners are rounded with this radius. half: half of each side
// of the box, including the rounding.
double rounded_box(const Vec3& p, const Vec3& centre, const Vec3& half, double radius) {
  const Vec3 q = (p - centre).cwiseAbs() - (half - Vec3::Constant(radius));
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0) - radius;
}

// A disc in the x, z plane: round at the rim, thick along y.
double pebble(const Vec3& p, const Vec3& centre, double radius, double thick) {
  const Vec3 v = p - centre;
  const double rim = std::max(std::sqrt(v.x() * v.x() + v.z() * v.z()) - (radius - thick), 0.0);
  return std::sqrt(rim * rim + v.y() * v.y()) - thick;
}

// Returns the smaller of two distances, with a fillet of about this width where the bodies meet.
double blend(double a, double b, double width) {
  const double h = std::max(width - std::abs(a - b), 0.0) / width;
  return std::min(a, b) - h * h * width / 4;
}

double blend_all(std::initializer_list<double> distances, double width) {
  double all = *distances.begin();
  for (auto d = distances.begin() + 1; d != distances.end(); ++d) all = blend(all, *d, width);
  return all;
}

// A dog whose four outer corners have the same reach, so that a box with walls 110 and 90 mm apart, as in Fig
// 6.3, stops it at about 21.35 degrees in both directions of rotation. Two of the corners are the head and
// the tip of the tail: balls with a radius of 10 mm at (+-34.75, 24). The other two are the paws, with a
// radius of 8 mm at (+-35.12, -26), so that (26 cos + 35.12 sin) + 8 mm is the same 45 mm as that of the
// head. The code has all four corners 0.1 mm farther out in x. No other part of the body reaches as far.
double husky_mm(const Vec3& p) {
  const Vec3 q(p.x(), std::abs(p.y()), p.z());                              // both sides are alike
  const double body = blend_all({capsule(q, {-22, 0, 6}, {20, 0, 8}, 8.8),  //
                                 capsule(q, {20, 0, 8}, {31, 0, 20}, 8),    // neck
                                 capsule(q, {-24, 0, 7}, {-38, 0, 15}, 8),  // tail, curled over
                                 capsule(q, {-38.5, 0, 15.5}, {-36, 0, 22}, 8.85)},
                                3);
  const double head = blend_all({ball(q, {34.85, 0, 24}, 10), capsule(q, {36, 0, 20}, {43.5, 0, 14}, 4),
                                 capsule(q, {30, 4.5, 27}, {23, 4.5, 30.5}, 3)},  // ears, laid back
                                2);
  const double fore =
      blend(capsule(q, {22, 4.9, 2}, {34, 4.6, -23}, 4.5), pebble(q, {35.22, 4.6, -26}, 8, 5), 2);
  const double hind =
      blend(capsule(q, {-24, 4.9, 2}, {-34, 4.6, -23}, 4.5), pebble(q, {-35.22, 4.6, -26}, 8, 5), 2);
  return blend_all({body, std::min(head, ball(q, {-34.85, 0, 24}, 10)), fore, hind}, 2);
}

double fork_mm(const Vec3& p) {
  double all =
      blend(rounded_box(p, {-30, 0, 0}, {22, 10, 38}, 8), capsule(p, {-60, 0, 0}, {-45, 0, 0}, 9), 6);
  const double lengths[] = {42, 50, 47, 36};
  for (int i = 0; i < 4; ++i) {
    const double z = 20.0 * i - 30;
    all = blend(all, capsule(p, {-20, 0, z}, {lengths[i], 0, z}, 7), 4);
  }
  return all;
}

double key_mm(const Vec3& p) {
  const double handle = capsule(p, {-65, 0, -36}, {-65, 0, 36}, 9);
  const double shaft = capsule(p, {-65, 0, 0}, {55, 0, 0}, 8);
  const double head = rounded_box(p, {58, 0, 0}, {18, 14, 14}, 2);
  const double socket = rounded_box(p, {78, 0, 0}, {22, 8, 8}, 1);
  return std::max(blend(blend(handle, shaft, 6), head, 4), -socket);
}

// A block as long, wide and high as the husky. Its edges are rounded with a radius of 8 mm, so that its
// outline from above is that of a plate.
double block_mm(const Vec3& p) {
  return rounded_box(p, Vec3::Zero(), {47.5, 10, 34}, 8);
}

double ball_mm(const Vec3& p) {
  return p.norm() - 10;
}

// Makes the mesh of a body that is given in mm and lies within +- half of the origin.
TriangleMesh meshed(double (*body_mm)(const Vec3&), const Vec3& half_mm, double cell_mm) {
  TriangleMesh mesh = marching_tetrahedra(body_mm, -half_mm, half_mm, cell_mm);
  for (Vec3& v : mesh.vertices) v *= kMm;
  return mesh;
}

TriangleMesh slab(double height_mm) {
  return box_mesh(kMm * Vec3(40, height_mm, 40));
}

const GeneratedTool kTools[] = {
    {"ball", "a ball, 20 mm across",
     [] {
       return meshed(ball_mm, {11.4, 11.4, 11.4}, 1.25);
     }},
    {"bar", "a bar with sharp edges, 80 mm (x) x 20 mm (y) x 10 mm (z)",
     [] { return box_mesh(kMm * Vec3(80, 20, 10)); }},
    {"block", "a block with round edges, 95 x 20 x 68 mm, the size of the husky",
     [] {
       return meshed(block_mm, {49.1, 11.6, 35.6}, 2.5);
     }},
    {"fork", "a hand with four stiff fingers, about 126 x 22 x 77 mm",
     [] {
       return meshed(fork_mm, {72.3, 12.8, 42.3}, 3);
     }},
    {"husky", "a dog lying on its side, 95 x 20 x 68 mm, the tool of Fig 6.3",
     [] {
       return meshed(husky_mm, {49.1, 11.6, 35.6}, 2.5);
     }},
    {"key", "a valve key with a T handle and a square socket, about 150 x 28 x 90 mm",
     [] {
       return meshed(key_mm, {79.3, 16.9, 48.3}, 2.5);
     }},
    {"slab-5", "a plate, 40 x 40 mm and 5 mm high (y)", [] { return slab(5); }},
    {"slab-10", "a plate, 40 x 40 mm and 10 mm high (y)", [] { return slab(10); }},
    {"slab-20", "a block, 40 x 40 mm and 20 mm high (y)", [] { return slab(20); }},
    {"slab-40", "a cube of 40 mm", [] { return slab(40); }},
};

}  // namespace

TriangleMesh box_mesh(const Vec3& sides_m, const Vec3& centre) {
  TriangleMesh mesh;
  for (int c = 0; c < 8; ++c)
    mesh.vertices.push_back(centre +
                            sides_m.cwiseProduct(Vec3(c & 1, c >> 1 & 1, c >> 2) - Vec3::Constant(0.5)));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

std::span<const GeneratedTool> generated_tools() {
  return kTools;
}

const GeneratedTool* find_generated_tool(const std::string& name) {
  const auto tools = generated_tools();
  const auto found = std::find_if(tools.begin(), tools.end(), [&](const auto& t) { return t.name == name; });
  return found == tools.end() ? nullptr : &*found;
}

}  // namespace remote_touch
