#include "core/mesh/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/points/vector.h"

namespace remote_touch {
namespace {

constexpr int kLeaf = 4;
constexpr int kDeepest = 64;       // trees are halved: no tree of 2^31 triangles is deeper than 32
constexpr double kFar = 3;         // triangles farther away than this many radii are combined
constexpr double kNoArea = 1e-10;  // a smaller sine of the angle at a triangle's first corner is rounding
constexpr double kPi = 3.14159265358979323846;

// Returns the squared distance from v to the segment from 0 to d. dd: squared length of d; vd = v d.
double squared_to_segment(const Vec3& v, const Vec3& d, double vd, double dd) {
  const double t = dd > 0 ? std::min(std::max(vd / dd, 0.0), 1.0) : 0;
  return (v - t * d).squaredNorm();
}

Vec3 sum_of_corners(const TriangleMesh& mesh, int face) {
  const auto [a, b, c] = mesh.triangles[face];
  return mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c];
}

// Divides the faces begin to end into two ranges, along the longest side of the box of their middles. Returns
// the start of the second range. The first one fills its blocks, so that no more than one block of the tree
// has free lanes. A single block is not divided: the second range is empty.
int divided(const TriangleMesh& mesh, std::vector<int>& order, int begin, int end, int block) {
  const int blocks = (end - begin + block - 1) / block;
  if (blocks <= 1) return end;
  BoundingBox middles;
  for (int f = begin; f < end; ++f) middles.extend(sum_of_corners(mesh, order[f]));
  int axis = 0;
  middles.sizes().maxCoeff(&axis);
  const int middle = begin + blocks / 2 * block;
  const auto before = [&](int f, int g) {
    const double a = sum_of_corners(mesh, f)[axis], b = sum_of_corners(mesh, g)[axis];
    return a < b || (a == b && f < g);
  };
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, before);
  return middle;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  std::vector<int> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(order.size());
  faces_.reserve(order.size());
  build(mesh, order, 0, static_cast<int>(order.size()));
  for (const int t : order) {
    const auto [i, j, k] = mesh.triangles[t];
    const Vec3 a = mesh.vertices[i], ab = mesh.vertices[j] - a, ac = mesh.vertices[k] - a;
    const Vec3 cross = ab.cross(ac);
    const double area = cross.norm();
    const bool has_area = area > kNoArea * ab.norm() * ac.norm();
    faces_.push_back({a, ab, ac, has_area ? Vec3(cross / area) : Vec3::Zero(), ab.squaredNorm(), ab.dot(ac),
                      ac.squaredNorm()});
  }
}

void TriangleTree::gather(const TriangleMesh& mesh, const std::vector<int>& order, int begin, int end,
                          Node& node) const {
  double whole = 0;
  for (int t = begin; t < end; ++t) {
    const auto [i, j, k] = mesh.triangles[order[t]];
    const Vec3 &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
    const Vec3 area = 0.5 * (b - a).cross(c - a);
    node.area += area;
    node.centre += area.norm() / 3 * (a + b + c);
    whole += area.norm();
  }
  node.centre = whole > 0 ? Vec3(node.centre / whole) : mesh.vertices[mesh.triangles[order[begin]][0]];
  // A closed surface has no mean normal: any axis will do.
  if (node.area.norm() > 0.1 * whole) node.axis = node.area.normalized();
  for (int t = begin; t < end; ++t)
    for (const int corner : mesh.triangles[order[t]]) {
      const Vec3 v = mesh.vertices[corner] - node.centre;
      const double height = v.dot(node.axis);
      node.half_height = std::max(node.half_height, std::abs(height));
      node.radius = std::max(node.radius, (v - height * node.axis).norm());
      node.reach = std::max(node.reach, v.norm());
    }
}

// Builds the node of a range of triangles, and the nodes below it, and returns its index. The range is halved
// by the triangles' middles along the longest side of its box.
int TriangleTree::build(const TriangleMesh& mesh, std::vector<int>& order, int begin, int end) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  gather(mesh, order, begin, end, nodes_[index]);
  if (end - begin <= kLeaf) {
    nodes_[index].left = begin, nodes_[index].right = begin - end;
    return index;
  }
  BoundingBox box;
  for (int t = begin; t < end; ++t)
    for (const int corner : mesh.triangles[order[t]]) box.extend(mesh.vertices[corner]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto place = [&](int t) {
    const auto [i, j, k] = mesh.triangles[t];
    return mesh.vertices[i][axis] + mesh.vertices[j][axis] + mesh.vertices[k][axis];
  };
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order.begin() + begin, order.begin() + middle, order.begin() + end, [&](int s, int t) {
    const double a = place(s), b = place(t);
    return a < b || (a == b && s < t);
  });
  const int left = build(mesh, order, begin, middle), right = build(mesh, order, middle, end);
  nodes_[index].left = left, nodes_[index].right = right;
  return index;
}

// Returns the squared distance to the triangle's plane if p projects into the triangle, else to its nearest
// edge. This is also right for slivers, where a decision by regions would fail. A triangle without area has
// only edges, because rounding alone would decide whether p projects into it.
double TriangleTree::squared_to(const Face& f, const Vec3& p) {
  const Vec3 v = p - f.a;
  const double vb = v.dot(f.ab), vc = v.dot(f.ac);
  const double s = vb * f.cc - vc * f.bc, t = vc * f.bb - vb * f.bc, all = f.bb * f.cc - f.bc * f.bc;
  if (s > 0 && t > 0 && s + t < all && !f.normal.isZero(0)) {
    const double height = v.dot(f.normal);
    return height * height;
  }
  const Vec3 w = v - f.ab, bc = f.ac - f.ab;
  return std::min({squared_to_segment(v, f.ab, vb, f.bb), squared_to_segment(v, f.ac, vc, f.cc),
                   squared_to_segment(w, bc, w.dot(bc), f.bb - 2 * f.bc + f.cc)});
}

double TriangleTree::squared_to(const Node& node, const Vec3& p) {
  const Vec3 v = p - node.centre;
  const double height = v.dot(node.axis);
  const double along = std::max(std::abs(height) - node.half_height, 0.0);
  const double across =
      std::max(std::sqrt(std::max(v.squaredNorm() - height * height, 0.0)) - node.radius, 0.0);
  return along * along + across * across;
}

TriangleTree::Nearest TriangleTree::nearest(const Vec3& p, int first) const {
  Nearest best{first, squared_to(faces_[first], p)};
  struct Open {
    int node;
    double squared;
  } stack[kDeepest];
  int open = 0;
  stack[open++] = {0, 0};
  while (open > 0) {
    const Open top = stack[--open];
    if (top.squared >= best.squared_m2) continue;
    const Node& node = nodes_[top.node];
    if (node.right < 0) {
      for (int f = node.left; f < node.left - node.right; ++f) {
        const double squared = squared_to(faces_[f], p);
        if (squared < best.squared_m2) best = {f, squared};
      }
      continue;
    }
    Open near{node.left, squared_to(nodes_[node.left], p)};
    Open far{node.right, squared_to(nodes_[node.right], p)};
    if (far.squared < near.squared) std::swap(near, far);
    if (far.squared < best.squared_m2) stack[open++] = far;
    if (near.squared < best.squared_m2) stack[open++] = near;
  }
  return best;
}

void TriangleTree::faces_within(const Vec3& p, double distance_m, std::vector<Candidate>& faces) const {
  faces.clear();
  int stack[kDeepest], open = 0;
  stack[open++] = 0;
  while (open > 0) {
    const Node& node = nodes_[stack[--open]];
    if (squared_to(node, p) > distance_m * distance_m) continue;
    if (node.right >= 0) {
      stack[open++] = node.right, stack[open++] = node.left;
      continue;
    }
    for (int f = node.left; f < node.left - node.right; ++f) {
      const Vec3 middle = (faces_[f].ab + faces_[f].ac) / 3;
      const double radius = std::sqrt(std::max({middle.squaredNorm(), (faces_[f].ab - middle).squaredNorm(),
                                                (faces_[f].ac - middle).squaredNorm()}));
      const double distance = std::sqrt(squared_to(faces_[f], p));
      if (distance <= distance_m) faces.push_back({distance, f, faces_[f].a + middle, radius});
    }
  }
  std::sort(faces.begin(), faces.end(), [](const Candidate& a, const Candidate& b) {
    return a.distance_m < b.distance_m || (a.distance_m == b.distance_m && a.face < b.face);
  });
}

// Returns the solid angle of a face at p, after Van Oosterom and Strackee 1983.
double TriangleTree::solid_angle(const Face& f, const Vec3& p) {
  const Vec3 a = f.a - p, b = a + f.ab, c = a + f.ac;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

double TriangleTree::winding_number(const Vec3& p) const {
  double angle = 0;
  int stack[kDeepest], open = 0;
  stack[open++] = 0;
  while (open > 0) {
    const Node& node = nodes_[stack[--open]];
    const Vec3 displacement = node.centre - p;
    const double squared = displacement.squaredNorm();
    if (squared > kFar * kFar * node.reach * node.reach) {
      angle += node.area.dot(displacement) / (squared * std::sqrt(squared));
    } else if (node.right < 0) {
      for (int f = node.left; f < node.left - node.right; ++f) angle += solid_angle(faces_[f], p);
    } else {
      stack[open++] = node.right, stack[open++] = node.left;
    }
  }
  return angle / (4 * kPi);
}

FaceTree::FaceTree(const TriangleMesh& mesh) {
  centre_ = bounding_box(mesh.vertices).center();
  for (const Vec3& v : mesh.vertices) radius_m_ = std::max(radius_m_, (v - centre_).norm());
  std::vector<int> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  blocks_.reserve(order.size() / kLanes + 1);
  nodes_.reserve(order.size() / kLanes / 2 + 1);
  BoundingBox box;
  root_ = build(mesh, order, 0, static_cast<int>(order.size()), box);
}

// Builds the subtree of a range of faces. Returns it as the child of a node, and its box.
int FaceTree::build(const TriangleMesh& mesh, std::vector<int>& order, int begin, int end, BoundingBox& box) {
  box = BoundingBox();
  for (int f = begin; f < end; ++f)
    for (const int corner : mesh.triangles[order[f]]) box.extend(mesh.vertices[corner]);
  const int middle = divided(mesh, order, begin, end, kLanes);
  if (middle == end) return ~add_block(mesh, order, begin, end);
  const std::array<int, 5> cut{begin, divided(mesh, order, begin, middle, kLanes), middle,
                               divided(mesh, order, middle, end, kLanes), end};
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Node node{};
  for (int lane = 0; lane < kLanes; ++lane) {
    if (cut[lane] == cut[lane + 1]) continue;
    BoundingBox around;
    node.child[lane] = build(mesh, order, cut[lane], cut[lane + 1], around);
    node.used |= 1u << lane;
    for (int axis = 0; axis < 3; ++axis) {
      node.low[axis][lane] = static_cast<float>(around.min()[axis] - centre_[axis]);
      node.high[axis][lane] = static_cast<float>(around.max()[axis] - centre_[axis]);
    }
  }
  nodes_[index] = node;
  return index;
}

int FaceTree::add_block(const TriangleMesh& mesh, const std::vector<int>& order, int begin, int end) {
  Block block{};
  for (int lane = 0; lane < kLanes; ++lane) {
    if (begin + lane < end)
      add_face(mesh, order[begin + lane], block, lane);
    else
      block.at_a[2][lane] = std::numeric_limits<float>::infinity();
  }
  blocks_.push_back(block);
  return static_cast<int>(blocks_.size()) - 1;
}

void FaceTree::add_face(const TriangleMesh& mesh, int face, Block& block, int lane) const {
  std::array<Vec3, 3> corner;
  for (int i = 0; i < 3; ++i) corner[i] = mesh.vertices[mesh.triangles[face][i]] - centre_;
  const auto squared_side = [&](int i) { return (corner[(i + 1) % 3] - corner[i]).squaredNorm(); };
  int longest = 0;
  for (const int i : {1, 2})
    if (squared_side(i) > squared_side(longest)) longest = i;
  const Vec3 &a = corner[longest], &b = corner[(longest + 1) % 3], &c = corner[(longest + 2) % 3];
  const Vec3 x = (b - a).normalized(), z = (b - a).cross(c - a).normalized();
  const std::array<Vec3, 3> axes{x, z.cross(x), z};
  for (int k = 0; k < 3; ++k) {
    block.axis_x[k][lane] = static_cast<float>(x[k]);
    block.axis_z[k][lane] = static_cast<float>(z[k]);
    block.at_a[k][lane] = static_cast<float>(axes[k].dot(a));
  }
  for (int k = 0; k < 2; ++k) {
    block.along_ac[k][lane] = static_cast<float>((c - a).normalized().dot(axes[k]));
    block.along_bc[k][lane] = static_cast<float>((c - b).normalized().dot(axes[k]));
  }
  block.ab[lane] = static_cast<float>((b - a).norm());
  block.ac[lane] = static_cast<float>((c - a).norm());
  block.bc[lane] = static_cast<float>((c - b).norm());
  block.face[lane] = face;
}

}  // namespace remote_touch
