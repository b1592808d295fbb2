#include "core/sphere_tree/sphere_tree.h"

#include <algorithm>

namespace remote_touch {

namespace {

constexpr double kRounding = 1 + 1e-12;  // of the distances: a bounding sphere is never too small

// (7.3) over count items; item(i) -> const Sphere&.
template <class Item>
Sphere around(std::size_t count, const Item& item) {
  Sphere all;
  for (std::size_t i = 0; i < count; ++i) all.centre += item(i).centre;
  all.centre /= static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i)
    all.radius_m = std::max(all.radius_m, (item(i).centre - all.centre).norm() + item(i).radius_m);
  all.radius_m *= kRounding;
  return all;
}

}  // namespace

Sphere bounding_sphere(std::span<const Sphere> spheres) {
  return around(spheres.size(), [&](std::size_t i) -> const Sphere& { return spheres[i]; });
}

void SphereTree::clear() {
  leaves_.clear();
  levels_.clear();
}

void SphereTree::add(std::span<const Sphere> leaves) {
  if (leaves.empty()) return;
  if (levels_.empty()) levels_.emplace_back();
  levels_.front().push_back({bounding_sphere(leaves), static_cast<std::uint32_t>(leaves_.size()),
                             static_cast<std::uint32_t>(leaves.size())});
  leaves_.insert(leaves_.end(), leaves.begin(), leaves.end());
}

void SphereTree::finish() {
  while (!levels_.empty() && levels_.back().size() > kBranching) {
    const std::vector<SphereNode>& below = levels_.back();
    std::vector<SphereNode> level;
    for (std::size_t first = 0; first < below.size(); first += kBranching) {
      const std::size_t count = std::min(kBranching, below.size() - first);
      const Sphere sphere =
          around(count, [&](std::size_t i) -> const Sphere& { return below[first + i].sphere; });
      level.push_back({sphere, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
    }
    levels_.push_back(std::move(level));
  }
}

}  // namespace remote_touch
