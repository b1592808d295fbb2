#include "core/search/point_order.h"

#include <algorithm>
#include <utility>

namespace remote_touch {
namespace {

// Moves bit k of the lowest 21 bits to bit 3 k.
std::uint64_t spread(std::uint64_t bits) {
  bits &= 0x1fffff;
  bits = (bits | bits << 32) & 0x1f00000000ffff;
  bits = (bits | bits << 16) & 0x1f0000ff0000ff;
  bits = (bits | bits << 8) & 0x100f00f00f00f00f;
  bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
  return (bits | bits << 2) & 0x1249249249249249;
}

}  // namespace

std::vector<std::uint32_t> morton_order(const PointCloud& cloud) {
  BoundingBox box;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (cloud.is_measured(i)) box.extend(cloud.point(i));
  const double max = std::max(box.sizes().maxCoeff(), 1e-9);
  const double per_m = 0x1ffffe / max;
  std::vector<std::pair<std::uint64_t, std::uint32_t>> codes;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const Vec3 u = (cloud.point(i) - box.min()) * per_m;
    const auto part = [&](int axis) { return spread(static_cast<std::uint64_t>(u[axis])) << axis; };
    codes.emplace_back(part(0) | part(1) | part(2), static_cast<std::uint32_t>(i));
  }
  std::sort(codes.begin(), codes.end());
  std::vector<std::uint32_t> order;
  for (const auto& code : codes) order.push_back(code.second);
  return order;
}

namespace {

constexpr std::size_t kRuns[] = {4096, 512, 64, 8};

// Returns the length of the first part of a run that is halved; 0 if it is not halved any more.
std::size_t half(std::size_t count) {
  for (const std::size_t run : kRuns)
    if (count > run) return std::max<std::size_t>(count / run / 2, 1) * run;
  return 0;
}

struct Item {
  Vec3 p;
  std::uint32_t index;
};

void sort(std::span<Item> items) {
  const std::size_t first = half(items.size());
  if (first == 0) return;
  BoundingBox box;
  for (const Item& item : items) box.extend(item.p);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  // Equal coordinates are ordered by index, so that the parts do not depend on the library.
  const auto is_before = [axis](const Item& a, const Item& b) {
    return a.p[axis] < b.p[axis] || (a.p[axis] == b.p[axis] && a.index < b.index);
  };
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(first), items.end(), is_before);
  sort(items.first(first)), sort(items.subspan(first));
}

}  // namespace

std::vector<std::uint32_t> compact_order(std::span<const Vec3> points) {
  std::vector<Item> items;
  items.reserve(points.size());
  for (const Vec3& p : points) items.push_back({p, static_cast<std::uint32_t>(items.size())});
  sort(items);
  std::vector<std::uint32_t> order;
  order.reserve(items.size());
  for (const Item& item : items) order.push_back(item.index);
  return order;
}

}  // namespace remote_touch
