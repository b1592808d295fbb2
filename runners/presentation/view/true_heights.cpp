#include "runners/presentation/view/true_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch {

namespace {

constexpr std::size_t kMaxTimes = 200, kMaxChanges = 2000;
constexpr double kEvery_s = 1.0 / 60, kAbove_m = 1e-6;

// Returns NaN if the height is unknown, or if the distance to the surface is unknown because the surface has
// vanished. The distance is that of a position slightly above the surface: beyond the border of a surface it
// is unknown below.
float height_at(const Scenario& scenario, double x, double z, double time_s) {
  const double y = scenario.surface_height(x, z, scenario.truth_time_s(time_s));
  if (std::isnan(y) || std::isnan(scenario.signed_distance({x, y + kAbove_m, z}, time_s)))
    return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(y);
}

std::vector<float> heights_at(const Scenario& scenario, const BoundingBox& box_W, double time_s) {
  constexpr int n = TrueHeights::kColumns;
  std::vector<float> heights;
  heights.reserve(n * n);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) {
      const Vec3 at = box_W.min() + Vec3(i, 0, k).cwiseProduct(box_W.sizes()) / (n - 1);
      heights.push_back(height_at(scenario, at.x(), at.z(), time_s));
    }
  return heights;
}

bool same(std::span<const float> a, std::span<const float> b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

// Returns the first tick and each tick at which another capture became the newest one; at most kMaxChanges.
std::vector<double> changes(const Scenario& scenario, std::span<const double> time_s) {
  std::vector<double> list = {time_s.front()};
  for (std::size_t i = 1; i < time_s.size(); ++i)
    if (scenario.truth_time_s(time_s[i]) != scenario.truth_time_s(time_s[i - 1])) list.push_back(time_s[i]);
  if (list.size() <= kMaxChanges) return list;
  std::vector<double> some;
  for (std::size_t i = 0; i < kMaxChanges; ++i) some.push_back(list[i * list.size() / kMaxChanges]);
  return some;
}

std::vector<double> even_times(double from_s, double to_s) {
  const std::size_t count =
      std::clamp<std::size_t>(static_cast<std::size_t>((to_s - from_s) / kEvery_s) + 2, 2, kMaxTimes);
  std::vector<double> list;
  for (std::size_t i = 0; i < count; ++i)
    list.push_back(from_s + (to_s - from_s) * static_cast<double>(i) / static_cast<double>(count - 1));
  return list;
}

}  // namespace

TrueHeights true_heights(const Scenario& scenario, const BoundingBox& box_W, std::span<const double> time_s) {
  constexpr std::size_t kSize = TrueHeights::kColumns * TrueHeights::kColumns;
  TrueHeights all;
  all.stays =
      std::any_of(time_s.begin(), time_s.end(), [&](double t) { return scenario.truth_time_s(t) != t; });
  bool moves = false, known = false;
  for (const double t : all.stays ? changes(scenario, time_s) : even_times(time_s.front(), time_s.back())) {
    const std::vector<float> heights = heights_at(scenario, box_W, t);
    known |= std::any_of(heights.begin(), heights.end(), [](float h) { return std::isfinite(h); });
    const bool is_new = all.empty() || !same(heights, std::span(all.height_m).last(kSize));
    moves |= is_new && !all.empty();
    if (all.stays && !is_new) continue;
    all.time_s.push_back(t);
    all.height_m.insert(all.height_m.end(), heights.begin(), heights.end());
  }
  if (!known) return {};
  if (!moves) all.time_s.resize(1), all.height_m.resize(kSize);
  return all;
}

}  // namespace remote_touch
