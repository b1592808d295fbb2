#include "core/search/compact_order.h"

#include <algorithm>

#include "core/geometry/vector.h"

namespace remote_touch {

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
