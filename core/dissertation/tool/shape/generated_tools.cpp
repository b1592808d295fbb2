#include "core/dissertation/tool/shape/generated_tools.h"

#include <algorithm>
#include <cmath>

#include "core/dissertation/tool/shape/marching_tetrahedra.h"

namespace remote_touch {

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
