// Which leaves of a tool's sphere tree and of the forbidden regions are near each other, 7.4.1.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/sphere_tree/sphere_tree.h"
#include "core/tool/tool_pose.h"

namespace remote_touch {

struct LeafPair {
  std::uint32_t tool, region;  // numbers of the leaves
  double gap_m;                // between their surfaces, negative where they overlap
};

class TreeCollision {
 public:
  // tool: in the tool frame; stays in use.
  explicit TreeCollision(const SphereTree& tool);

  // All pairs of leaves with gaps of margin_m or less, for a tool at a pose: the tool's tree is gone down
  // depth first against the topmost regions, then the regions' against its leaf. The order depends on the
  // trees alone. Valid until the next call.
  std::span<const LeafPair> near(const ToolPose& pose, const SphereTree& regions, double margin_m);

  // Of the last call, in the world.
  const Sphere& tool_leaf(std::uint32_t i) const { return leaves_W_[i]; }

 private:
  void meet_tool(std::size_t level, std::uint32_t node, const SphereTree& regions, std::uint32_t top);
  void meet_regions(std::uint32_t leaf, const SphereTree& regions, std::size_t level, std::uint32_t node);

  const SphereTree& tool_;
  std::vector<Sphere> leaves_W_;
  std::vector<std::vector<Sphere>> levels_W_;
  double margin_m_ = 0;
  std::vector<LeafPair> found_;
};

}  // namespace remote_touch
