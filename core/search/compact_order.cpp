#include "core/search/compact_order.h"

#include <algorithm>
#include <numeric>

#include "core/geometry/bounding_box.h"

namespace remote_touch {

namespace {

constexpr std::size_t kRuns[] = {4096, 512, 64, 8};

// Returns the length of the first part of a run that is halved; 0 if it is not halved any more.
std::size_t half(std::size_t count) {
  for (const std::size_t run : kRuns)
    if (count > run) return std::max<std::size_t>(count / run / 2, 1) * run;
  return 0;
}

void sort(std::span<const Vec3> points, std::span<std::uint32_t> order) {
  const std::size_t first = half(order.size());
  if (first == 0) return;
  BoundingBox box;
  for (const std::uint32_t i : order) box.extend(points[i]);
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  // Equal coordinates are ordered by index, so that the parts do not depend on the library.
  const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
    return points[a][axis] < points[b][axis] || (points[a][axis] == points[b][axis] && a < b);
  };
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(first), order.end(), is_before);
  sort(points, order.first(first)), sort(points, order.subspan(first));
}

}  // namespace

std::vector<std::uint32_t> compact_order(std::span<const Vec3> points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  sort(points, order);
  return order;
}

}  // namespace remote_touch
