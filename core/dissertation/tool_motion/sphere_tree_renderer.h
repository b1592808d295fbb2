// 6-DOF forbidden-region virtual fixtures, chapter 7: a tool of spheres is kept out of the regions around the
// points of a stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/dissertation/tool_motion/look_ahead_motion.h"
#include "core/dissertation/tool_motion/rigid_tool.h"
#include "core/dissertation/tool_motion/sphere_tree.h"
#include "core/dissertation/tool_motion/tool_parameters.h"
#include "core/kernels/kernels.h"
#include "core/mesh/voxel_tool.h"
#include "core/rendering/renderer.h"

namespace remote_touch {

// A leaf of the tool at a pose, world frame, and the patches of regions near the node that it belongs to.
struct CloseLeaf {
  std::uint32_t number;
  std::uint32_t first_patch, patch_count;  // range in the list of TreeCollision
  Sphere sphere_W;
};

// Detects near pairs of a leaf of a tool's sphere tree and a forbidden region, 7.4.1. Allocates in the
// constructor and in reserve(), and in on_frame() if reserve() was not called.
class TreeCollision {
 public:
  // tool: in the tool frame. Keeps references to tool and regions.
  TreeCollision(const SphereTree& tool, const Kernels& kernels);
  void on_frame(const SphereTree& regions);
  void reserve(std::size_t leaves, std::size_t patches);  // numbers of leaves and patches of the regions

  // Returns every leaf of the tool that has a pair within margin_m, and some others, in the order of their
  // numbers. Valid until the next call. The search first descends the tool's tree, depth first, against the
  // top level of the regions' tree. Then it descends the regions' tree against every node of the tool's
  // lowest level, so that the leaves of a node share this search.
  std::span<const CloseLeaf> close_leaves(const ToolPose& pose, double margin_m);

  // Returns all regions with gaps of margin_m or less to one of these leaves, in the order of their numbers;
  // margin_m is at most that of close_leaves(). The columns may be changed, and are valid until the next
  // call.
  struct Found {
    NearRegions regions;  // normals in the world
    std::size_t count;
  };
  Found regions_near(const CloseLeaf& leaf, double margin_m);

 private:
  void meet_tool(std::size_t level, std::uint32_t number, std::uint32_t tops);
  // Returns the nodes of the regions' top level, among those in the bits of `among`, that are near a sphere
  // of the tool.
  std::uint32_t tops_near(const Sphere& sphere_W, std::uint32_t among) const;
  Sphere placed(const Sphere& sphere_T) const;
  void meet_regions(std::size_t level, std::uint32_t number, const Sphere& node_W);

  const SphereTree& tool_;
  const SphereTree* regions_ = nullptr;
  const Kernels& kernels_;
  Vec3 p_W_ = Vec3::Zero();
  Eigen::Matrix3d R_WT_ = Eigen::Matrix3d::Identity();
  double margin_m_ = 0;
  std::vector<CloseLeaf> close_;
  std::vector<std::uint32_t> patches_;  // near patches of each node of the tool, one node after the other
  std::vector<double> gap_, nx_, ny_, nz_;
  std::vector<std::uint32_t> number_;
};

// Selection of the pairs of leaves that become constraints, (7.4): far more are near than the motion program
// can handle.

// A pair that is a constraint: n . u >= -gap for the motion u of the leaf's centre.
struct ChosenPair {
  std::uint32_t leaf;  // leaf of the tool
  double gap_m;
  Vec3 n_W;  // unit, out of the region
  // Shortest motion of the leaf that can violate the constraint and still obeys the deeper ones of the leaf.
  // It is the gap for a deep leaf, and until it is computed.
  double motion_m;
};

// All pairs of one leaf limit the motion of one point, its centre. They are visited from the deepest on, and
// a pair is kept unless a pair that is already kept makes it redundant. Pair j with the gap g_j is redundant
// if some deeper pair i has g_j - g_i >= |n_j - n_i| m, because then no motion up to the length m that obeys
// i violates j.
//
// If the leaf is no deeper than half the look-ahead, m is half the look-ahead. validate() of the renderer's
// settings refuses longer steps, so no pair is lost that a step could run into. A looser rule would be wrong.
// An example is the obtuse crease of two regions 1 mm apart: the pole of either region lies 9 um deep in the
// other region and 0.8 mm aside, and a tool that is limited by one region at a time moves back and forth
// between them.
//
// A deeper leaf is on its way out, or in a wedge, and its steps are longer, so m is twice the look-ahead.
// Pair j is dropped only if its normal is also within kAlike of that of i, so that the deepest pair of every
// direction is kept. A pair is also dropped if it is less than half as deep as the deepest one and not within
// a look-ahead of it; the next query finds it.
//
// The deepest pair of every leaf is kept, so no dropped pair is deeper than all that are kept. If a leaf has
// more than kMaxPairsOfLeaf pairs, the shallower ones are lost. When the list has no room for another leaf
// (kCapacity pairs), half of kCapacity is kept: the pairs that the shortest motions can violate. Pairs of
// deep leaves are compared by their gaps, so the deepest are kept. Allocates on construction only.
class PairChoice {
 public:
  static constexpr std::size_t kMaxPairsOfLeaf = 64, kCapacity = 4096;
  static constexpr double kAlike = 0.90630778703664996;  // cosine of 25 degrees

  PairChoice(double look_ahead_m, const Kernels& kernels);

  void begin();
  // Returns the largest gap that a kept pair of a leaf can have, if the leaf's deepest pair has a gap of
  // gap_m or less.
  double within_m(double gap_m) const;
  // Adds the pairs of a leaf to chosen(). found: all pairs of the leaf with gaps up to within_m(). Returns
  // the number of its deepest region.
  std::uint32_t choose(const CloseLeaf& leaf, const TreeCollision::Found& found);

  std::span<const ChosenPair> chosen() const { return chosen_; }
  // Keeps at most max pairs: those that the shortest motions can violate, sorted by that motion.
  void keep_shortest_motions(std::size_t max);
  bool is_deep(double gap_m) const { return gap_m < -motion_m_; }

 private:
  void rate();

  const double look_ahead_m_, motion_m_;
  const Kernels& kernels_;
  std::vector<ChosenPair> chosen_;
  std::size_t rated_ = 0;  // number of the first pairs whose motion_m is known
};

// Contact of a tool with regions at a pose.
struct RegionTouch {
  double nearest_distance_m;    // smallest gap, negative inside; infinite if none is within the look-ahead
  int leaf_pairs = 0;           // number of pairs with gaps of kTouch_m or less
  int touching_leaf_count = 0;  // number of tool leaves that have such a pair
  double stiffness_N_per_m;     // mean of k_s over these pairs, weighted by depth; the tool's own without any
};

// The contacts of a tool of spheres with forbidden regions, (7.4).
//
// Each pair of leaves nearer than look_ahead_m is a constraint along the line of their centres, unless
// another pair makes it redundant: see PairChoice. The motion program can handle only some of the remaining
// pairs. If there are more and no leaf is deep, the pairs are dropped that only the longest motions can
// violate. If a leaf is deep, half of the contacts are the most urgent pairs, the deepest first. The other
// half are the deepest pairs of every cell and octant of directions, which ContactThinning selects, so that
// they are spread over the tool. The result does not depend on the kernels' level. Allocates on construction
// and in on_frame() only.
class RegionContacts final : public NearContactSource {
 public:
  // A pair with a gap of this or less touches. Its weight in the stiffness rises linearly from 0 at this gap
  // to 1 at a gap of minus this.
  static constexpr double kTouch_m = 1e-4;

  // tool: in the tool frame.
  RegionContacts(std::shared_ptr<const SphereTree> tool, double look_ahead_m, const Kernels& kernels);

  void on_frame(std::shared_ptr<const RegionTree> regions);  // allocates unless reserved
  void reserve(std::size_t points);                          // allocates for clouds of this number of points
  const RegionTree& regions() const { return *regions_; }

  // within_m has no effect: the contacts are always chosen among all pairs within the look-ahead. side has no
  // effect either: a region has only one outside. deepest_m is over all pairs, not only the contacts.
  using NearContactSource::near;
  NearContacts near(const ToolPose& pose, double side, double within_m) override;

  // own_stiffness_N_per_m: k_s of points that have none.
  RegionTouch touched(const ToolPose& pose, double own_stiffness_N_per_m);

 private:
  static constexpr std::uint32_t kNone = ~0u;
  double bound_m(const CloseLeaf& leaf, std::uint32_t region) const;
  void take_contacts(const Eigen::Quaterniond& q_TW);
  ToolContact contact(const ChosenPair& pair, const Eigen::Quaterniond& q_TW) const;

  const std::shared_ptr<const SphereTree> tool_;
  const double look_ahead_m_;
  std::shared_ptr<const RegionTree> regions_ = std::make_shared<RegionTree>();
  TreeCollision collision_;
  PairChoice choice_;
  std::vector<std::uint32_t> deepest_;  // deepest region at the last query of every leaf of the tool
  ContactThinning thinning_;
  std::vector<ToolContact> contacts_, others_;
};

// The device holds the tool by its centre of mass. Only points with r_f above 0 have a region. If a point has
// a k_s, it is the stiffness of the coupling while the tool touches its region, (5.3).
//
// Outputs: `nearest_distance_m` is the smallest gap between a leaf of the tool and a region; infinite beyond
// the look-ahead. `contact_count` is the number of touching pairs of leaves. `contact_clusters` is the number
// of the tool's leaves in these pairs. `tool_penetration_m` is the depth of the deepest leaf in a region.
class SphereTreeRenderer final : public Renderer {
 public:
  // Uses only the parameters that region_parameters() lists. spheres: leaves of the tool, in its frame.
  SphereTreeRenderer(const ToolParameters& parameters, std::shared_ptr<const VoxelTool> tool,
                     const std::shared_ptr<const SphereTree>& spheres, const Kernels& kernels);

  void prepare(Frame& frame) const override;
  void reserve(std::size_t points) override;
  void on_frame(const Frame& frame) override;
  Parameters live_parameters() override;
  RenderOutput step(const DeviceState& device, double time_s) override;

 private:
  void follow(const ToolPose& device, RenderOutput& out);

  ToolParameters p_;
  const std::shared_ptr<const VoxelTool> tool_;
  const Kernels& kernels_;
  RegionContacts contacts_;
  LookAheadMotion motion_;

  ToolPose pose_;
  Vec3 normal_W_ = Vec3::Zero();  // contact normal: direction in which the regions push the tool
  bool placed_ = false;           // the tool starts at the first device pose
  bool updated_ = false;          // a frame came in since the last tick
  SlavePosition slave_;
  FrameOrder order_;
};

// Returns the parameters of a tool that have an effect on the motion among regions.
Parameters region_parameters(ToolParameters& p);

}  // namespace remote_touch
