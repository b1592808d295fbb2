#include "core/search/morton_order.h"

#include <algorithm>
#include <utility>

#include "core/geometry/vector.h"

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

}  // namespace remote_touch
