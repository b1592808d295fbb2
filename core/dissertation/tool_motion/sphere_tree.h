// Trees of bounding spheres over spheres, 7.3.2 and 7.4, of forbidden regions and of tools: one test skips
// everything below a node that is far away.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/kernels/point_kernels.h"
#include "core/mesh/triangle_mesh.h"
#include "core/mesh/voxel_tool.h"
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

// The forbidden regions of a frame as a sphere tree, 7.3.2. Every measured point with r_f above 0 has a leaf
// of that radius, in the world frame. The points of a patch form a node of the lowest level. A patch is 16 x
// 16 pixels of an image, and patches follow each other in blocks of 4 x 4. If the cloud has no image, a patch
// is kPatchPoints such points along a space-filling curve.
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

// A tool as a sphere tree, made from its mesh in advance, 7.4: the dissertation uses the Sphere Tree Toolkit
// [118] for this. Leaves are balls inscribed in the tool, all enlarged by the same inflation_m. It is about
// the smallest with which max_leaves of them cover the surface.

// Returns positions on every triangle, its corners among them. They are no farther apart than spacing_m along
// its longest side and along the height above it.
std::vector<Vec3> surface_samples(const TriangleMesh& mesh, double spacing_m);

// Keeps the first of the positions in every cube of side spacing_m.
std::vector<Vec3> thinned(const std::vector<Vec3>& positions, double spacing_m);

double surface_area_m2(const TriangleMesh& mesh);

// Covers many points by few spheres with a greedy algorithm: each next sphere is the one that covers most of
// the remaining points.
class SphereCover {
 public:
  // points: to be covered; choice: spheres to choose from; cell_m: cell size of the grid that finds points,
  // about the size of a sphere.
  SphereCover(std::vector<Vec3> points, std::vector<Sphere> choice, double cell_m);

  // Selects spheres of the choice, grown by inflation_m. It ends when every point is covered that any of them
  // covers, or when more than max are selected. If two spheres cover equally many points, the one that comes
  // first is selected.
  struct Result {
    std::vector<Sphere> spheres;
    std::size_t uncovered_count = 0;  // points that are not covered
  };
  Result cover(double inflation_m, std::size_t max) const;

 private:
  // Calls act(point) for the points in the sphere.
  template <class Act>
  void within(const Sphere& sphere, const Act& act) const;
  std::int64_t cell_along(int axis, double x) const;

  std::vector<Sphere> choice_;
  double cell_m_;
  Vec3 low_;
  std::int64_t cells_[3];
  std::vector<Vec3> points_;           // sorted by cell
  std::vector<std::uint32_t> starts_;  // first point of each cell; one more at the end
};

struct ToolSpheres {
  SphereTree spheres;  // tree in the tool frame
  double inflation_m = 0;
  // Deviation of the union of the leaves from the mesh, measured on dense samples. outside_m: largest
  // distance between the mesh and a position of a leaf outside it, at most inflation_m. surface_outside_m:
  // largest distance between the leaves and a position of the surface outside them; 0 but for rounding,
  // because the leaves were enlarged until they contained these samples.
  double outside_m = 0, surface_outside_m = 0;
};
std::string text(const ToolSpheres& spheres);

inline constexpr int kMinLeaves = 1, kMaxLeaves = 10000;

// Makes at most max_leaves leaves, or fewer if these suffice. Throws InputError if no node of the tool's grid
// is inside the tool.
ToolSpheres make_tool_spheres(const VoxelTool& tool, int max_leaves);  // pre: kMinLeaves to kMaxLeaves

}  // namespace remote_touch
