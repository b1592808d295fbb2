#include "core/dissertation/sphere_tree/sphere_tree.h"

#include <cmath>
#include <limits>

#include "core/points/neighbour_search.h"

namespace remote_touch {
namespace {

constexpr double kRounding = 1 + 1e-12;  // factor on distances: a bounding sphere is never too small

// Returns the bounding sphere (7.3) of count items; item(i) returns a const Sphere&.
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

std::size_t in_whole_groups(std::size_t count) {
  return (count + kLanes - 1) / kLanes * kLanes;
}

}  // namespace

Sphere bounding_sphere(std::span<const Sphere> spheres) {
  assert(!spheres.empty());
  return around(spheres.size(), [&](std::size_t i) -> const Sphere& { return spheres[i]; });
}

void SphereTree::clear() {
  leaves_.clear();
  level_count_ = 0;
  for (std::vector<double>* column : {&x_, &y_, &z_, &radius_, &max_radius_}) column->clear();
  for (std::size_t axis = 0; axis < 3; ++axis) low_[axis].clear(), high_[axis].clear();
  run_starts_.clear();
}

std::vector<SphereNode>& SphereTree::new_level() {
  if (levels_.size() == level_count_) levels_.emplace_back();
  std::vector<SphereNode>& level = levels_[level_count_++];
  level.clear();
  return level;
}

void SphereTree::append_run(std::span<const Sphere> leaves) {
  run_starts_.push_back({x_.size(), max_radius_.size()});
  for (std::size_t first = 0; first < leaves.size(); first += kLanes)
    append_group(leaves.subspan(first, std::min(kLanes, leaves.size() - first)));
  const std::size_t padded = in_whole_groups(x_.size());
  for (std::vector<double>* column : {&x_, &y_, &z_}) column->resize(padded, kFarAway);
  radius_.resize(padded, 0);
  const std::size_t groups = max_radius_.size() - run_starts_.back().group;
  pad_groups(in_whole_groups(groups) - groups);
}

void SphereTree::append_group(std::span<const Sphere> leaves) {
  SphereBox box = SphereBox::around(leaves.front());
  for (const Sphere& leaf : leaves) {
    x_.push_back(leaf.centre.x()), y_.push_back(leaf.centre.y()), z_.push_back(leaf.centre.z());
    radius_.push_back(leaf.radius_m);
    box.add(SphereBox::around(leaf));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    low_[axis].push_back(box.low[i]), high_[axis].push_back(box.high[i]);
  }
  max_radius_.push_back(box.max_radius_m);
}

void SphereTree::pad_groups(std::size_t padding) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::vector<double>* column : {&low_[axis], &high_[axis]})
      column->insert(column->end(), padding, kFarAway);
  max_radius_.insert(max_radius_.end(), padding, 0);
}

void SphereTree::add(std::span<const Sphere> leaves) {
  if (leaves.empty()) return;
  if (level_count_ == 0) new_level();
  SphereBox box = SphereBox::around(leaves.front());
  for (const Sphere& leaf : leaves) box.add(SphereBox::around(leaf));
  levels_.front().push_back({bounding_sphere(leaves), box, static_cast<std::uint32_t>(leaves_.size()),
                             static_cast<std::uint32_t>(leaves.size())});
  leaves_.insert(leaves_.end(), leaves.begin(), leaves.end());
  append_run(leaves);
}

SphereRun SphereTree::run(std::size_t node) const {
  const auto [leaf, group] = run_starts_[node];
  const std::size_t end = node + 1 < run_starts_.size() ? run_starts_[node + 1].group : max_radius_.size();
  const auto from = [](const std::vector<double>& column, std::size_t start) {
    return column.data() + start;
  };
  return {from(x_, leaf),
          from(y_, leaf),
          from(z_, leaf),
          from(radius_, leaf),
          {from(low_[0], group), from(low_[1], group), from(low_[2], group)},
          {from(high_[0], group), from(high_[1], group), from(high_[2], group)},
          from(max_radius_, group),
          end - group,
          levels_.front()[node].first};
}

void SphereTree::finish() {
  while (level_count_ > 0 && top().size() > kBranching) {
    std::vector<SphereNode>& level = new_level();  // this may move the other levels
    const std::vector<SphereNode>& below = levels_[level_count_ - 2];
    for (std::size_t first = 0; first < below.size(); first += kBranching) {
      const std::size_t count = std::min(kBranching, below.size() - first);
      const Sphere sphere =
          around(count, [&](std::size_t i) -> const Sphere& { return below[first + i].sphere; });
      SphereBox box = below[first].box;
      for (std::size_t i = 1; i < count; ++i) box.add(below[first + i].box);
      level.push_back({sphere, box, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)});
    }
  }
}

// Adds the regions of points first .. first + count - 1 to the present patch. The radius is tested first,
// because most points of most frames have no region.
void RegionTree::gather(const PointCloud& cloud, std::uint32_t first, std::uint32_t count) {
  for (std::uint32_t point = first; point < first + count; ++point) {
    const double radius_m = cloud.fixture_radius_m[point];
    if (!(radius_m > 0)) continue;
    if (!std::isfinite(radius_m) || !cloud.is_measured(point)) continue;
    patch_.push_back({cloud.point(point), radius_m});
    points_.push_back(point);
    stiffness_N_per_m_.push_back(cloud.stiffness_N_per_m.empty() ? std::numeric_limits<double>::quiet_NaN()
                                                                 : cloud.stiffness_N_per_m[point]);
  }
}

void RegionTree::close_patch() {
  spheres_.add(patch_);
  patch_.clear();
}

void RegionTree::add_patches_of_image(const PointCloud& cloud) {
  constexpr std::uint32_t kPatch = kPatchSide_px, kBlock = 4 * kPatch;
  const auto width = static_cast<std::uint32_t>(cloud.image->camera.width),
             height = static_cast<std::uint32_t>(cloud.image->camera.height);
  for (std::uint32_t v0 = 0; v0 < height; v0 += kBlock)
    for (std::uint32_t u0 = 0; u0 < width; u0 += kBlock)
      for (std::uint32_t v = v0; v < std::min(v0 + kBlock, height); v += kPatch)
        for (std::uint32_t u = u0; u < std::min(u0 + kBlock, width); u += kPatch) {
          for (std::uint32_t row = v; row < std::min(v + kPatch, height); ++row)
            gather(cloud, row * width + u, std::min(kPatch, width - u));
          close_patch();
        }
}

void RegionTree::add_patches_along_curve(const PointCloud& cloud) {
  for (const std::uint32_t point : morton_order(cloud)) {
    gather(cloud, point, 1);
    if (patch_.size() == kPatchPoints) close_patch();
  }
  close_patch();
}

void RegionTree::assign(const PointCloud& cloud) {
  spheres_.clear();
  points_.clear();
  stiffness_N_per_m_.clear();
  if (cloud.fixture_radius_m.empty()) return;
  if (cloud.image)
    add_patches_of_image(cloud);
  else
    add_patches_along_curve(cloud);
  spheres_.finish();
}

}  // namespace remote_touch
