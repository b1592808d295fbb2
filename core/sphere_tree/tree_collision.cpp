#include "core/sphere_tree/tree_collision.h"

namespace remote_touch {

namespace {

// Without a root, and without a branch more for what is no number: such spheres are never near.
bool is_near(const Sphere& a, const Sphere& b, double margin_m) {
  const double reach_m = a.radius_m + b.radius_m + margin_m;
  return reach_m >= 0 && (a.centre - b.centre).squaredNorm() <= reach_m * reach_m;
}

}  // namespace

TreeCollision::TreeCollision(const SphereTree& tool) : tool_(tool), leaves_W_(tool.leaves().size()) {
  for (std::size_t level = 0; level < tool.level_count(); ++level)
    levels_W_.emplace_back(tool.level(level).size());
}

std::span<const LeafPair> TreeCollision::near(const ToolPose& pose, const SphereTree& regions,
                                              double margin_m) {
  found_.clear();
  if (tool_.empty() || regions.empty()) return {};
  margin_m_ = margin_m;
  const Eigen::Matrix3d R_WT = pose.q_WT.toRotationMatrix();
  const auto placed = [&](const Sphere& sphere) {
    return Sphere{pose.p_W + R_WT * sphere.centre, sphere.radius_m};
  };
  for (std::size_t i = 0; i < leaves_W_.size(); ++i) leaves_W_[i] = placed(tool_.leaves()[i]);
  for (std::size_t level = 0; level < levels_W_.size(); ++level)
    for (std::size_t i = 0; i < levels_W_[level].size(); ++i)
      levels_W_[level][i] = placed(tool_.level(level)[i].sphere);
  const std::size_t top = tool_.level_count() - 1;
  for (std::uint32_t node = 0; node < tool_.top().size(); ++node)
    for (std::uint32_t region = 0; region < regions.top().size(); ++region)
      meet_tool(top, node, regions, region);
  return found_;
}

void TreeCollision::meet_tool(std::size_t level, std::uint32_t node, const SphereTree& regions,
                              std::uint32_t top) {
  const Sphere& region = regions.top()[top].sphere;
  if (!is_near(levels_W_[level][node], region, margin_m_)) return;
  const SphereNode& here = tool_.level(level)[node];
  for (std::uint32_t child = here.first; child < here.first + here.count; ++child)
    if (level > 0)
      meet_tool(level - 1, child, regions, top);
    else
      meet_regions(child, regions, regions.level_count() - 1, top);
}

void TreeCollision::meet_regions(std::uint32_t leaf, const SphereTree& regions, std::size_t level,
                                 std::uint32_t node) {
  const Sphere& tool = leaves_W_[leaf];
  const SphereNode& here = regions.level(level)[node];
  if (!is_near(tool, here.sphere, margin_m_)) return;
  for (std::uint32_t child = here.first; child < here.first + here.count; ++child) {
    if (level > 0) {
      meet_regions(leaf, regions, level - 1, child);
      continue;
    }
    const Sphere& region = regions.leaves()[child];
    const double gap_m = (tool.centre - region.centre).norm() - tool.radius_m - region.radius_m;
    if (gap_m <= margin_m_) found_.push_back({leaf, child, gap_m});
  }
}

}  // namespace remote_touch
