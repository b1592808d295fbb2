#include "core/mesh/face_tree.h"

#include <limits>
#include <numeric>

namespace remote_touch {

namespace {

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
