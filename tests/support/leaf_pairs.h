// Pairs of leaves of a tool and of regions: all of them by a plain loop, and those that TreeCollision finds.
#pragma once

#include <vector>

#include "core/dissertation/tool_motion/sphere_tree_renderer.h"

namespace remote_touch {

struct LeafPair {
  std::uint32_t tool, region;  // numbers of the leaves
  double gap_m;                // gap between their surfaces, negative where they overlap
  bool operator==(const LeafPair&) const = default;
};

// Every pair of leaves with a gap of margin_m or less, by a plain loop over all pairs.
inline std::vector<LeafPair> naive_pairs(const SphereTree& tool, const ToolPose& pose,
                                         const SphereTree& regions, double margin_m) {
  const Eigen::Matrix3d R_WT = pose.q_WT.toRotationMatrix();
  std::vector<LeafPair> pairs;
  for (std::uint32_t i = 0; i < tool.leaves().size(); ++i) {
    const Sphere& leaf = tool.leaves()[i];
    const Vec3 centre_W = pose.p_W + R_WT * leaf.centre;
    for (std::uint32_t j = 0; j < regions.leaves().size(); ++j) {
      const Sphere& region = regions.leaves()[j];
      const double gap_m = (centre_W - region.centre).norm() - leaf.radius_m - region.radius_m;
      if (gap_m <= margin_m) pairs.push_back({i, j, gap_m});
    }
  }
  return pairs;
}

// The same pairs in the same order, as the trees find them.
inline std::vector<LeafPair> near_pairs(TreeCollision& collision, const ToolPose& pose, double margin_m) {
  std::vector<LeafPair> pairs;
  for (const CloseLeaf& leaf : collision.close_leaves(pose, margin_m)) {
    const TreeCollision::Found found = collision.regions_near(leaf, margin_m);
    for (std::size_t i = 0; i < found.count; ++i)
      pairs.push_back({leaf.number, found.regions.number[i], found.regions.gap[i]});
  }
  return pairs;
}

}  // namespace remote_touch
