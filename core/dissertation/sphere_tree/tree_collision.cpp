#include "core/dissertation/sphere_tree/tree_collision.h"

#include <bit>

namespace remote_touch {

namespace {

static_assert(SphereTree::kBranching <= 32, "the topmost nodes are the bits of a word");

constexpr double kRoundingOfSums = 1 + 1e-12;  // factor on sums: no region within the margin is skipped

// True if some region below a node may be within the margin. The test needs no root, and no extra branch for
// NaN: a sphere with NaN is never near, because cwiseMax() keeps a NaN on its left.
bool is_near(const Sphere& a, const SphereNode& node, double margin_m) {
  const SphereBox& box = node.box;
  const double reach_m = (a.radius_m + box.max_radius_m + margin_m) * kRoundingOfSums;
  const Vec3 beyond = (box.low - a.centre).cwiseMax(a.centre - box.high).cwiseMax(0);
  return reach_m >= 0 && beyond.squaredNorm() <= reach_m * reach_m;
}

}  // namespace

TreeCollision::TreeCollision(const SphereTree& tool, const Kernels& kernels)
    : tool_(tool), kernels_(kernels) {
  close_.reserve(tool.leaves().size());
}

void TreeCollision::on_frame(const SphereTree& regions) {
  regions_ = &regions;
  reserve(regions.leaves().size(), regions.empty() ? 0 : regions.level(0).size());
}

void TreeCollision::reserve(std::size_t leaves, std::size_t patches) {
  if (!tool_.empty()) patches_.reserve(tool_.level(0).size() * patches);
  const std::size_t pairs = leaves + 2 * kLanes;
  if (number_.size() >= pairs) return;
  for (std::vector<double>* column : {&gap_, &nx_, &ny_, &nz_}) column->resize(pairs);
  number_.resize(pairs);
}

Sphere TreeCollision::placed(const Sphere& sphere_T) const {
  return {p_W_ + R_WT_ * sphere_T.centre, sphere_T.radius_m};
}

std::uint32_t TreeCollision::tops_near(const Sphere& sphere_W, std::uint32_t among) const {
  std::uint32_t near = 0;
  for (; among != 0; among &= among - 1) {
    const int top = std::countr_zero(among);
    if (is_near(sphere_W, regions_->top()[static_cast<std::size_t>(top)], margin_m_)) near |= 1u << top;
  }
  return near;
}

std::span<const CloseLeaf> TreeCollision::close_leaves(const ToolPose& pose, double margin_m) {
  close_.clear(), patches_.clear();
  if (tool_.empty() || !regions_ || regions_->empty()) return {};
  p_W_ = pose.p_W, R_WT_ = pose.q_WT.toRotationMatrix(), margin_m_ = margin_m;
  const auto every_top = static_cast<std::uint32_t>((std::uint64_t{1} << regions_->top().size()) - 1);
  for (std::uint32_t node = 0; node < tool_.top().size(); ++node)
    meet_tool(tool_.level_count() - 1, node, every_top);
  return close_;
}

void TreeCollision::meet_tool(std::size_t level, std::uint32_t number, std::uint32_t tops) {
  const SphereNode& node = tool_.level(level)[number];
  const Sphere node_W = placed(node.sphere);
  tops = tops_near(node_W, tops);
  if (tops == 0) return;
  if (level > 0) {
    for (std::uint32_t child = node.first; child < node.first + node.count; ++child)
      meet_tool(level - 1, child, tops);
    return;
  }
  const auto first_patch = static_cast<std::uint32_t>(patches_.size());
  for (; tops != 0; tops &= tops - 1)
    meet_regions(regions_->level_count() - 1, static_cast<std::uint32_t>(std::countr_zero(tops)), node_W);
  const auto patch_count = static_cast<std::uint32_t>(patches_.size()) - first_patch;
  if (patch_count == 0) return;
  for (std::uint32_t leaf = node.first; leaf < node.first + node.count; ++leaf)
    close_.push_back({leaf, first_patch, patch_count, placed(tool_.leaves()[leaf])});
}

void TreeCollision::meet_regions(std::size_t level, std::uint32_t number, const Sphere& node_W) {
  const SphereNode& node = regions_->level(level)[number];
  if (!is_near(node_W, node, margin_m_)) return;
  if (level == 0) return patches_.push_back(number);
  for (std::uint32_t child = node.first; child < node.first + node.count; ++child)
    meet_regions(level - 1, child, node_W);
}

TreeCollision::Found TreeCollision::regions_near(const CloseLeaf& leaf, double margin_m) {
  Found found{{gap_.data(), nx_.data(), ny_.data(), nz_.data(), number_.data()}, 0};
  const Vec3& middle = leaf.sphere_W.centre;
  const double columns[4] = {middle.x(), middle.y(), middle.z(), leaf.sphere_W.radius_m};
  for (std::uint32_t i = leaf.first_patch; i < leaf.first_patch + leaf.patch_count; ++i)
    if (is_near(leaf.sphere_W, regions_->level(0)[patches_[i]], margin_m))
      found.count = kernels_.regions.append_near_regions(regions_->run(patches_[i]), columns, margin_m,
                                                         found.regions, found.count);
  return found;
}

}  // namespace remote_touch
