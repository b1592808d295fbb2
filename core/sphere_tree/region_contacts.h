// What holds a tool of spheres among forbidden regions, (7.4).
#pragma once

#include <memory>
#include <vector>

#include "core/kernels/kernels.h"
#include "core/sphere_tree/pair_choice.h"
#include "core/sphere_tree/region_tree.h"
#include "core/sphere_tree/tree_collision.h"
#include "core/tool/contact/contact_thinning.h"
#include "core/tool/contact/near_contacts.h"

namespace remote_touch {

// What a tool touches at a pose.
struct RegionTouch {
  double nearest_distance_m;  // smallest gap, negative inside; infinite where none is within the look-ahead
  int leaf_pairs = 0;         // with gaps of kTouch_m or less
  int max_tool_leaves = 0;    // that have one
  double stiffness_N_per_m;   // mean of k_s over them, by how deep each is; the tool's own without any
};

// Each pair of leaves nearer than look_ahead_m is a constraint along the line of their centres, unless others
// stand for it: see PairChoice. Where more are left than the motion takes, and no leaf is deep, those go that
// only the longest motions can violate. While one is deep, half the room is for the deepest, and for the
// other half ContactThinning keeps the deepest of every place and octant of directions, so that what is left
// is spread over the tool. Does not depend on the kernels' level. Allocates on construction and in
// on_frame() only.
class RegionContacts final : public NearContactSource {
 public:
  // Half the band of gaps in which a pair counts as touching, the less the less deep it is.
  static constexpr double kTouch_m = 1e-4;

  // tool: in the tool frame.
  RegionContacts(std::shared_ptr<const SphereTree> tool, double look_ahead_m, const Kernels& kernels);

  void on_frame(std::shared_ptr<const RegionTree> regions);  // allocates where room was not reserved
  void reserve(std::size_t points);                          // for clouds of so many
  const RegionTree& regions() const { return *regions_; }

  // A region has one outside, so the side says nothing. The deepest gap is that of all pairs, not only of the
  // contacts.
  NearContacts near(const ToolPose& pose, double side) override;

  // own_stiffness: k_s of points that have none.
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
  std::vector<std::uint32_t> deepest_;  // of every leaf of the tool, its deepest region when last looked at
  ContactThinning thinning_;
  std::vector<ToolContact> contacts_, others_;
};

}  // namespace remote_touch
