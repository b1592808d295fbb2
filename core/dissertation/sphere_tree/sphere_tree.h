// A tree of bounding spheres over spheres, 7.3.2 and 7.4: one test skips everything below a node that is far
// away.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/kernels/point_kernels.h"
#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

struct Sphere {
  Vec3 centre = Vec3::Zero();
  double radius_m = 0;
};

// Returns the bounding sphere around the mean of the centres, (7.3). It is fast to compute, but not the
// smallest.
Sphere bounding_sphere(std::span<const Sphere> spheres);

// A box around the centres of spheres, and their largest radius: tighter than a bounding sphere if many large
// spheres lie close together, as regions do.
struct SphereBox {
  Vec3 low, high;
  double max_radius_m;

  static SphereBox around(const Sphere& one) { return {one.centre, one.centre, one.radius_m}; }
  void add(const SphereBox& other) {
    low = low.cwiseMin(other.low), high = high.cwiseMax(other.high);
    max_radius_m = std::max(max_radius_m, other.max_radius_m);
  }
};

// The children of a node are first .. first + count - 1 of the level below, or of the leaves if the node is
// on the lowest level.
struct SphereNode {
  Sphere sphere;
  SphereBox box;  // around all leaves below
  std::uint32_t first = 0, count = 0;
};

// NOLINTNEXTLINE(bugprone-reserved-identifier): a name that the compiler gives in a comparison of arrays
class SphereTree {
 public:
  // Number of children of a node above the lowest level; the last node of a level can have fewer. The top
  // level has no more nodes than this.
  static constexpr std::size_t kBranching = 8;

  void clear();  // keeps the memory
  // Adds a node of the lowest level with these leaves; no node if there are none. Nodes added one after the
  // other should be near each other, because they share a node of the next level.
  void add(std::span<const Sphere> leaves);
  // Makes the levels above. To be called once, after the last add().
  void finish();

  bool empty() const { return leaves_.empty(); }
  std::span<const Sphere> leaves() const { return leaves_; }
  // Levels from the lowest up, at least one unless the tree is empty.
  std::size_t level_count() const { return level_count_; }
  std::span<const SphereNode> level(std::size_t i) const { return levels_[i]; }
  std::span<const SphereNode> top() const { return levels_[level_count_ - 1]; }
  // The leaves of a node of the lowest level, for the kernels.
  SphereRun run(std::size_t node) const;

 private:
  std::vector<SphereNode>& new_level();
  void append_run(std::span<const Sphere> leaves);
  void append_group(std::span<const Sphere> leaves);
  void pad_groups(std::size_t padding);

  std::vector<Sphere> leaves_;
  std::vector<std::vector<SphereNode>> levels_;  // the first level_count_ are in use
  std::size_t level_count_ = 0;
  // The leaves once more, in the layout of SphereRun: each node's leaves in columns, and a box around each
  // kLanes of them.
  struct RunStart {
    std::size_t leaf, group;
  };
  std::vector<double> x_, y_, z_, radius_;
  std::vector<double> low_[3], high_[3], max_radius_;
  std::vector<RunStart> run_starts_;  // start of each node in these columns
};

// The forbidden regions of a frame as a sphere tree, 7.3.2.

// Every measured point with r_f above 0 has a leaf of that radius, in the world frame. The points of a patch
// form a node of the lowest level. A patch is 16 x 16 pixels of an image, and patches follow each other in
// blocks of 4 x 4. If the cloud has no image, a patch is kPatchPoints such points along a space-filling
// curve.
class RegionTree {
 public:
  static constexpr int kPatchSide_px = 16;
  static constexpr std::size_t kPatchPoints = 256;

  void assign(const PointCloud& cloud);

  const SphereTree& spheres() const { return spheres_; }
  // Number in the cloud of the point of each leaf.
  const std::vector<std::uint32_t>& points() const { return points_; }
  // k_s of a leaf; NaN if its point has none.
  double stiffness_N_per_m(std::uint32_t leaf) const { return stiffness_N_per_m_[leaf]; }

 private:
  void add_patches_of_image(const PointCloud& cloud);
  void add_patches_along_curve(const PointCloud& cloud);
  void gather(const PointCloud& cloud, std::uint32_t first, std::uint32_t count);
  void close_patch();

  SphereTree spheres_;
  std::vector<std::uint32_t> points_;
  std::vector<double> stiffness_N_per_m_;
  std::vector<Sphere> patch_;
};

}  // namespace remote_touch
