// What holds a tool of spheres among forbidden regions, (7.4).
#pragma once

#include <memory>
#include <vector>

#include "core/sphere_tree/region_tree.h"
#include "core/sphere_tree/tree_collision.h"
#include "core/tool/contact_thinning.h"
#include "core/tool/near_contacts.h"

namespace remote_touch {

// Each pair of leaves nearer than look_ahead_m is a constraint along the line of their centres. Where there
// are more than the motion takes, of the pairs of one leaf of the tool whose lines are alike the deepest
// counts: regions overlap, and deep inside there are tens of thousands of pairs. Their list grows with the
// most that were found: such a detection allocates.
class RegionContacts final : public NearContactSource {
 public:
  // tool: in the tool frame.
  RegionContacts(std::shared_ptr<const SphereTree> tool, double look_ahead_m);

  void on_frame(const PointCloud& cloud) { regions_.assign(cloud); }  // allocates
  const RegionTree& regions() const { return regions_; }

  // A region has one outside, so the side says nothing.
  NearContacts near(const ToolPose& pose, double side) override;

 private:
  // Lines are alike in one octant and with one largest coordinate.
  static constexpr std::size_t kWays = 24;
  struct Deepest {
    LeafPair pair;
    std::uint32_t detection = 0;  // that it was found in
  };
  void choose_deepest(std::span<const LeafPair> pairs);
  ToolContact contact(const LeafPair& pair, const ToolPose& pose) const;
  Vec3 way_out_W(const LeafPair& pair) const;

  const std::shared_ptr<const SphereTree> tool_;
  const double look_ahead_m_;
  RegionTree regions_;
  TreeCollision collision_;
  std::vector<Deepest> deepest_;       // of every leaf of the tool and way
  std::vector<std::uint32_t> chosen_;  // those of this detection, as numbers in deepest_
  std::uint32_t detection_ = 0;
  ContactThinning thinning_;
  std::vector<ToolContact> contacts_;
};

}  // namespace remote_touch
