#include "runners/view/true_heights.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

constexpr int kMaxTimes = 200;
constexpr double kEvery_s = 1.0 / 60;

std::vector<float> heights_at(const Scenario& scenario, const BoundingBox& box_W, double time_s) {
  constexpr int n = TrueHeights::kColumns;
  std::vector<float> heights;
  heights.reserve(n * n);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) {
      const Vec3 at = box_W.min() + Vec3(i, 0, k).cwiseProduct(box_W.sizes()) / (n - 1);
      heights.push_back(static_cast<float>(scenario.surface_height(at.x(), at.z(), time_s)));
    }
  return heights;
}

bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

}  // namespace

TrueHeights true_heights(const Scenario& scenario, const BoundingBox& box_W, double from_s, double to_s) {
  const int count = std::clamp(static_cast<int>((to_s - from_s) / kEvery_s) + 2, 2, kMaxTimes);
  TrueHeights all;
  std::vector<float> first;
  bool moves = false, known = false;
  for (int i = 0; i < count; ++i) {
    const double time_s = from_s + (to_s - from_s) * i / (count - 1);
    std::vector<float> heights = heights_at(scenario, box_W, time_s);
    known |= std::any_of(heights.begin(), heights.end(), [](float h) { return std::isfinite(h); });
    if (i == 0) first = heights;
    moves |= !same(heights, first);
    all.time_s.push_back(time_s);
    all.height_m.insert(all.height_m.end(), heights.begin(), heights.end());
  }
  if (!known) return {};
  if (!moves) all.time_s.resize(1), all.height_m.resize(first.size());
  return all;
}

}  // namespace remote_touch
