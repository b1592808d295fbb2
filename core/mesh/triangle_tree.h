// Trees over the triangles of a mesh. They find the nearest triangle, and TriangleTree computes the
// generalised winding number.
#pragma once

#include <xmmintrin.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/triangle_mesh.h"
#include "core/points/vector.h"

namespace remote_touch {

class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);  // pre: indices in range, vertices finite, not empty

  struct Nearest {
    int face = 0;  // index in the tree's own order, for squared_to() and nearest()
    double squared_m2 = 0;
  };
  // Returns the face that is nearest to p. first: a face from which the search starts; a near one, such as
  // the result for a position close by, makes it fast, but any is correct.
  Nearest nearest(const Vec3& p, int first) const;

  // Gathers all faces within distance_m of p, sorted by distance.
  struct Candidate {
    double distance_m;
    int face;
    Vec3 middle;  // the face lies within radius of it
    double radius;
  };
  void faces_within(const Vec3& p, double distance_m, std::vector<Candidate>& faces) const;

  // Returns the squared distance from p to one face.
  double squared_to(int face, const Vec3& p) const { return squared_to(faces_[face], p); }

  // Returns how often the mesh winds around p, by solid angles: 1 inside and 0 outside of a closed mesh, a
  // value between them where there are gaps (Jacobson 2013). Far triangles are combined by their sum of area
  // vectors (Barill 2018). The result is good to about 0.02.
  double winding_number(const Vec3& p) const;

 private:
  struct Face {
    Vec3 a, ab, ac, normal;  // the normal a unit vector, zero for a triangle without area
    double bb, bc, cc;       // products of ab and ac
  };
  // A node is bounded by a disc rather than a box: a patch of a smooth surface is flat, and a box around it
  // would give a much too small distance.
  struct Node {
    Vec3 centre = Vec3::Zero(), axis = Vec3::UnitX();  // mean position and normal of the triangles below
    double radius = 0, half_height = 0;                // size of the disc, across and along its axis
    double reach = 0;                                  // radius of a ball around the centre
    Vec3 area = Vec3::Zero();                          // area vector
    int left = 0, right = 0;  // children; for a leaf its first face and -(number of faces)
  };

  int build(const TriangleMesh& mesh, std::vector<int>& order, int begin, int end);
  void gather(const TriangleMesh& mesh, const std::vector<int>& order, int begin, int end, Node& node) const;
  static double squared_to(const Face& face, const Vec3& p);
  static double squared_to(const Node& node, const Vec3& p);  // lower bound for all faces below
  static double solid_angle(const Face& face, const Vec3& p);

  std::vector<Face> faces_;
  std::vector<Node> nodes_;
};

// A tree that finds the faces of a mesh that may be nearest to a position. It compares four boxes, or four
// faces, at a time in single precision. These comparisons only rule faces out, with a margin for their
// rounding, so no result depends on them. TriangleTree finds the nearest face as well, faster if it may start
// at a face close by; this tree needs no such start, so its answer depends on the position alone.
class FaceTree {
 public:
  // pre: mesh is the result of welded_mesh(), and has a triangle. Its size is below 1e15 m.
  explicit FaceTree(const TriangleMesh& mesh);

  // Calls measure(face) once for every face that may be the nearest one to p, in any order. All faces at the
  // smallest distance are among them if this distance is limit_m or less, which may be infinite. Other faces
  // among them are few. No face is measured if p is not finite, or 1e15 m away.
  template <class Measure>
  void visit(const Vec3& p, double limit_m, const Measure& measure) const;

 private:
  static constexpr int kLanes = 4;     // single numbers of a vector of SSE2, which every x86-64 machine has
  static constexpr int kDeepest = 64;  // open nodes: a level adds 3, and 2^31 faces have 16 levels
  static constexpr int kCandidates = 64;
  static constexpr double kFarthest_m = 1e15;
  // A bound on the error of a distance in single precision, relative to the largest coordinate: 67 roundings
  // of 2^-24. The coordinates in the frame of a face have errors of 15 such roundings at most, and distances
  // in this frame add a few.
  static constexpr double kMargin = 4e-6;

  // Four subtrees and their boxes.
  struct alignas(16) Node {
    float low[3][kLanes], high[3][kLanes];
    int child[kLanes];  // index of a node, or ~index of a block
    unsigned used;      // the lanes that have a child, as bits
  };
  // Four faces, each in a frame of its own: x is the direction of its longest side AB, z that of its normal,
  // and the origin is A. In the plane of the face, A = (0, 0), B = (ab, 0) and C = A + ac along_ac = B + bc
  // along_bc, with y > 0.
  struct alignas(16) Block {
    float axis_x[3][kLanes], axis_z[3][kLanes];
    float at_a[3][kLanes];  // A, along the axes x, y and z. Lanes without a face are infinitely far
    float ab[kLanes], ac[kLanes], bc[kLanes], along_ac[2][kLanes], along_bc[2][kLanes];
    int face[kLanes];
  };
  // A position relative to the centre of the mesh, in all lanes.
  struct Position {
    __m128 coordinate[3];
  };
  // The faces that may be the nearest one, as far as the tree is searched.
  struct Candidates {
    Candidates(double margin_m_, float limit_) : margin_m(margin_m_), limit(limit_), nearest(limit_) {}

    double margin_m;       // exceeds the error of any distance
    float limit, nearest;  // squared: farther faces are ruled out; the nearest face so far
    int count = 0;
    std::array<std::pair<float, int>, kCandidates + kLanes> found;  // squared distance, face

    bool is_full() const { return count >= kCandidates; }
    void add(const Block& block, __m128 squared);
  };

  int build(const TriangleMesh& mesh, std::vector<int>& order, int begin, int end, BoundingBox& box);
  int add_block(const TriangleMesh& mesh, const std::vector<int>& order, int begin, int end);
  void add_face(const TriangleMesh& mesh, int face, Block& block, int lane) const;

  // Squared distances, one for each lane.
  static __m128 squared_to(const Node& node, const Position& at);
  static __m128 squared_to(const Block& block, const Position& at);
  // Returns the lanes that a limit does not rule out, as bits.
  static unsigned within(__m128 squared, float limit) {
    return static_cast<unsigned>(_mm_movemask_ps(_mm_cmple_ps(squared, _mm_set1_ps(limit))));
  }
  static float least(__m128 squared);
  static float squared_limit(double limit_m, double margin_m) {
    const double limit = std::min(limit_m, 4 * kFarthest_m) + margin_m;
    return static_cast<float>((1 + 1e-6) * limit * limit);
  }
  static int push_nearest_last(const Node& node, __m128 squared, unsigned lanes, std::uint64_t* stack,
                               int open);
  // A child and its squared distance as one number, never 0, that is ordered by distance: the bits of floats
  // that are not negative have the order of the floats.
  static std::uint64_t opened(int child, float squared) {
    return (std::uint64_t{std::bit_cast<std::uint32_t>(squared)} + 1) << 32 |
           static_cast<std::uint32_t>(child);
  }
  void prefetch_children(const Node& node) const;

  Vec3 centre_;
  double radius_m_ = 0;  // all vertices are within it of the centre
  int root_ = 0;
  std::vector<Node> nodes_;
  std::vector<Block> blocks_;
};

inline __m128 FaceTree::squared_to(const Node& node, const Position& at) {
  __m128 sum = _mm_setzero_ps();
  for (int axis = 0; axis < 3; ++axis) {
    const __m128 below = _mm_sub_ps(_mm_load_ps(node.low[axis]), at.coordinate[axis]);
    const __m128 above = _mm_sub_ps(at.coordinate[axis], _mm_load_ps(node.high[axis]));
    const __m128 outside = _mm_max_ps(_mm_max_ps(below, above), _mm_setzero_ps());
    sum = _mm_add_ps(sum, _mm_mul_ps(outside, outside));
  }
  return sum;
}

// The squared distance is z^2 plus that in the plane of the face: 0 on the inner side of all three sides, and
// the least distance from a side otherwise.
inline __m128 FaceTree::squared_to(const Block& block, const Position& at) {
  const __m128 zero = _mm_setzero_ps();
  __m128 axis_x[3], axis_z[3], x = zero, y = zero, z = zero;
  for (int k = 0; k < 3; ++k)
    axis_x[k] = _mm_load_ps(block.axis_x[k]), axis_z[k] = _mm_load_ps(block.axis_z[k]);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const __m128 axis_y = _mm_sub_ps(_mm_mul_ps(axis_z[i], axis_x[j]), _mm_mul_ps(axis_z[j], axis_x[i]));
    x = _mm_add_ps(x, _mm_mul_ps(axis_x[k], at.coordinate[k]));
    y = _mm_add_ps(y, _mm_mul_ps(axis_y, at.coordinate[k]));
    z = _mm_add_ps(z, _mm_mul_ps(axis_z[k], at.coordinate[k]));
  }
  x = _mm_sub_ps(x, _mm_load_ps(block.at_a[0])), y = _mm_sub_ps(y, _mm_load_ps(block.at_a[1])),
  z = _mm_sub_ps(z, _mm_load_ps(block.at_a[2]));
  const __m128 ab = _mm_load_ps(block.ab), beyond_ab = _mm_sub_ps(x, _mm_min_ps(_mm_max_ps(x, zero), ab));
  __m128 in_plane = _mm_add_ps(_mm_mul_ps(beyond_ab, beyond_ab), _mm_mul_ps(y, y));
  __m128 is_outside = _mm_cmplt_ps(y, zero);
  // A side from the x axis to C; from_x is x relative to its start. C is to the left of AC, and B to its
  // right.
  const auto add_side = [&](__m128 from_x, const float(&along)[2][kLanes], const float* length, bool is_ac) {
    const __m128 u = _mm_load_ps(along[0]), v = _mm_load_ps(along[1]);
    const __m128 foot = _mm_add_ps(_mm_mul_ps(from_x, u), _mm_mul_ps(y, v));
    const __m128 on_side = _mm_min_ps(_mm_max_ps(foot, zero), _mm_load_ps(length));
    const __m128 dx = _mm_sub_ps(from_x, _mm_mul_ps(on_side, u)), dy = _mm_sub_ps(y, _mm_mul_ps(on_side, v));
    in_plane = _mm_min_ps(in_plane, _mm_add_ps(_mm_mul_ps(dx, dx), _mm_mul_ps(dy, dy)));
    const __m128 left = _mm_mul_ps(u, y), right = _mm_mul_ps(v, from_x);
    is_outside = _mm_or_ps(is_outside, is_ac ? _mm_cmplt_ps(right, left) : _mm_cmplt_ps(left, right));
  };
  add_side(x, block.along_ac, block.ac, true);
  add_side(_mm_sub_ps(x, ab), block.along_bc, block.bc, false);
  return _mm_add_ps(_mm_and_ps(is_outside, in_plane), _mm_mul_ps(z, z));
}

inline float FaceTree::least(__m128 squared) {
  squared = _mm_min_ps(squared, _mm_shuffle_ps(squared, squared, _MM_SHUFFLE(1, 0, 3, 2)));
  squared = _mm_min_ps(squared, _mm_shuffle_ps(squared, squared, _MM_SHUFFLE(2, 3, 0, 1)));
  return _mm_cvtss_f32(squared);
}

// A face is ruled out if its distance minus the margin is more than that of another face plus the margin.
inline void FaceTree::Candidates::add(const Block& block, __m128 squared) {
  if (const float nearest_here = least(squared); nearest_here < nearest) {
    nearest = nearest_here;
    limit = std::min(limit, squared_limit(std::sqrt(nearest), 2 * margin_m));
  }
  alignas(16) float each[kLanes];
  _mm_store_ps(each, squared);
  for (unsigned lanes = within(squared, limit); lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    found[count++] = {each[lane], block.face[lane]};
  }
}

// Appends the children of the lanes to the stack, the nearest last, and returns the new size of the stack.
// The network of five comparisons sorts four numbers without a branch that would be mispredicted. Lanes that
// are ruled out are 0, so they follow the nearest one.
inline int FaceTree::push_nearest_last(const Node& node, __m128 squared, unsigned lanes, std::uint64_t* stack,
                                       int open) {
  alignas(16) float each[kLanes];
  _mm_store_ps(each, squared);
  std::uint64_t key[kLanes];
  int size = open;
  for (int lane = 0; lane < kLanes; ++lane) {
    const std::uint64_t used = (lanes >> lane) & 1;
    key[lane] = -used & opened(node.child[lane], each[lane]);
    size += static_cast<int>(used);
  }
  for (const auto& [i, j] : {std::pair{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}}) {
    const std::uint64_t is_before = key[i] < key[j], changed = -is_before & (key[i] ^ key[j]);
    key[i] ^= changed, key[j] ^= changed;
  }
  for (int lane = 0; lane < kLanes; ++lane) stack[open + lane] = key[lane];
  return size;
}

// Loads the children into the cache while their distances are computed.
inline void FaceTree::prefetch_children(const Node& node) const {
  constexpr std::size_t kLine = 64;
  const auto prefetch = [](const auto& part) {
    for (std::size_t at = 0; at < sizeof(part); at += kLine)
      _mm_prefetch(reinterpret_cast<const char*>(&part) + at, _MM_HINT_T0);
  };
  for (const int child : node.child) child >= 0 ? prefetch(nodes_[child]) : prefetch(blocks_[~child]);
}

template <class Measure>
void FaceTree::visit(const Vec3& p, double limit_m, const Measure& measure) const {
  const Vec3 q = p - centre_;
  const double distance_m = q.norm();
  if (!(distance_m < kFarthest_m)) return;
  const Position at{{_mm_set1_ps(static_cast<float>(q.x())), _mm_set1_ps(static_cast<float>(q.y())),
                     _mm_set1_ps(static_cast<float>(q.z()))}};
  const double margin_m = kMargin * (distance_m + radius_m_);
  Candidates candidates(margin_m, squared_limit(limit_m, margin_m));
  const auto measure_candidates = [&] {
    for (const auto& [squared, face] : std::span(candidates.found).first(candidates.count))
      if (squared <= candidates.limit) measure(face);
    candidates.count = 0;
  };
  std::uint64_t stack[kDeepest];
  int open = 0;
  stack[open++] = opened(root_, 0);
  while (open > 0) {
    const std::uint64_t top = stack[--open];
    if (top > opened(-1, candidates.limit)) continue;
    const int child = static_cast<int>(static_cast<std::uint32_t>(top));
    if (child >= 0) {
      const Node& node = nodes_[child];
      prefetch_children(node);
      const __m128 squared = squared_to(node, at);
      const unsigned lanes = within(squared, candidates.limit) & node.used;
      open = push_nearest_last(node, squared, lanes, stack, open);
    } else {
      const Block& block = blocks_[~child];
      candidates.add(block, squared_to(block, at));
      if (candidates.is_full()) measure_candidates();
    }
  }
  measure_candidates();
}

}  // namespace remote_touch
