#include "runners/presentation/view/shown_points.h"

#include <algorithm>
#include <limits>

namespace remote_touch {

namespace {

// Returns a rank from 1 to 2^32 - 1. The ranks of successive numbers are spread evenly (multiplicative
// hashing, Knuth 6.4).
std::uint32_t rank_of(std::uint32_t number) {
  number *= 2654435769u;
  number ^= number >> 16;
  number *= 2246822519u;
  return std::max(number ^ number >> 13, 1u);
}

// Returns the path without positions that are within side_m of the last one that was kept. The proxy moves
// little from one tick to the next, so most positions need not be compared with the points.
std::vector<Vec3> thinned_path(std::span<const Vec3> path_W, double side_m) {
  std::vector<Vec3> kept;
  for (const Vec3& p : path_W)
    if (p.allFinite() && (kept.empty() || (p - kept.back()).norm() > side_m)) kept.push_back(p);
  return kept;
}

}  // namespace

std::uint32_t rank_limit(std::size_t others, std::size_t wanted_others) {
  constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();
  if (others <= wanted_others) return kAll;
  return static_cast<std::uint32_t>(static_cast<double>(wanted_others) / static_cast<double>(others) * kAll);
}

ShownPoints shown_points(const PointCloud& cloud, std::span<const std::uint32_t> always,
                         std::span<const Vec3> proxies_W, const ShownPointsRule& rule) {
  ShownPoints shown;
  const double step_m = 0.1 * rule.near_m;
  const std::vector<Vec3> path = thinned_path(proxies_W, step_m);
  const double squared = (rule.near_m + step_m) * (rule.near_m + step_m);
  std::vector<std::uint32_t> others;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    ++shown.measured;
    const Vec3 p = cloud.point(i);
    const bool in_box = rule.box_W.contains(p);
    shown.in_box += in_box ? 1 : 0;
    if (std::binary_search(always.begin(), always.end(), i)) {
      shown.indices.push_back(static_cast<std::uint32_t>(i));
      continue;
    }
    if (!in_box) continue;
    const bool is_near = rule.near_m > 0 && std::any_of(path.begin(), path.end(), [&](const Vec3& proxy) {
                           return (p - proxy).squaredNorm() <= squared;
                         });
    (is_near ? shown.indices : others).push_back(static_cast<std::uint32_t>(i));
  }
  shown.others = others.size();
  const std::uint32_t limit = rank_limit(others.size(), rule.wanted_others);
  const std::vector<std::uint32_t> near = shown.indices;
  for (const std::uint32_t i : others)
    if (rank_of(i) < limit) shown.indices.push_back(i);
  std::sort(shown.indices.begin(), shown.indices.end());
  for (const std::uint32_t i : shown.indices)
    shown.rank.push_back(std::binary_search(near.begin(), near.end(), i) ? 0 : rank_of(i));
  return shown;
}

}  // namespace remote_touch
