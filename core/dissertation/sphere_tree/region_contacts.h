// The contacts of a tool of spheres with forbidden regions, (7.4).
#pragma once

#include <memory>
#include <vector>

#include "core/dissertation/sphere_tree/pair_choice.h"
#include "core/dissertation/sphere_tree/region_tree.h"
#include "core/dissertation/sphere_tree/tree_collision.h"
#include "core/dissertation/tool/contact/contact_thinning.h"
#include "core/dissertation/tool/contact/near_contacts.h"
#include "core/kernels/kernels.h"

namespace remote_touch {

// Contact of a tool with regions at a pose.
struct RegionTouch {
  double nearest_distance_m;    // smallest gap, negative inside; infinite if none is within the look-ahead
  int leaf_pairs = 0;           // number of pairs with gaps of kTouch_m or less
  int touching_leaf_count = 0;  // number of tool leaves that have such a pair
  double stiffness_N_per_m;     // mean of k_s over these pairs, weighted by depth; the tool's own without any
};

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

}  // namespace remote_touch
