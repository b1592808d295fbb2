#include "runners/presentation/pages/true_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace remote_touch {

namespace {

constexpr std::size_t kMaxTimes = 200, kMaxMoreTimes = 600, kMaxChanges = 2000;
constexpr double kEvery_s = 1.0 / 60, kAbove_m = 1e-6, kSmallError_m = 2e-4;

// Returns NaN if the height is unknown, or if the distance to the surface is unknown because the surface has
// vanished. The distance is that of a position slightly above the surface: beyond the border of a surface it
// is unknown below.
float height_at(const Scenario& scenario, double x, double z, double time_s) {
  const double y = scenario.surface_height(x, z, scenario.truth_time_s(time_s));
  if (std::isnan(y) || std::isnan(scenario.signed_distance({x, y + kAbove_m, z}, time_s)))
    return std::numeric_limits<float>::quiet_NaN();
  return static_cast<float>(y);
}

// i, k: numbers of the node along x and z; 0.5 lies between two nodes.
float height_at_node(const Scenario& scenario, const BoundingBox& box_W, double i, double k, double time_s) {
  const Vec3 at = box_W.min() + Vec3(i, 0, k).cwiseProduct(box_W.sizes()) / (TrueHeights::kColumns - 1);
  return height_at(scenario, at.x(), at.z(), time_s);
}

std::vector<float> heights_at(const Scenario& scenario, const BoundingBox& box_W, double time_s) {
  constexpr int n = TrueHeights::kColumns;
  std::vector<float> heights;
  heights.reserve(n * n);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i) heights.push_back(height_at_node(scenario, box_W, i, k, time_s));
  return heights;
}

// Returns the largest difference of the heights in the middle between two neighbouring nodes from the mean of
// these two, along x and along z. Heights that are unknown do not count.
double error_between_nodes_m(const Scenario& scenario, const BoundingBox& box_W,
                             std::span<const float> heights, double time_s) {
  constexpr int n = TrueHeights::kColumns;
  double largest_m = 0;
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      for (const auto& [x, z] : {std::pair{1, 0}, std::pair{0, 1}}) {
        if (i + x >= n || k + z >= n) continue;
        const float mean_m = 0.5f * (heights[static_cast<std::size_t>(k * n + i)] +
                                     heights[static_cast<std::size_t>((k + z) * n + i + x)]);
        const float height_m = height_at_node(scenario, box_W, i + 0.5 * x, k + 0.5 * z, time_s);
        largest_m = std::fmax(largest_m, std::abs(height_m - mean_m));  // ignores NaN
      }
  return largest_m;
}

// Returns the largest difference of b from the mean of a and c; NaN counts as 0.
double error_between_times_m(std::span<const float> a, std::span<const float> b, std::span<const float> c) {
  double largest_m = 0;
  for (std::size_t i = 0; i < b.size(); ++i)
    largest_m = std::fmax(largest_m, std::abs(b[i] - 0.5f * (a[i] + c[i])));
  return largest_m;
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

struct HeightsAtTime {
  double time_s;
  std::vector<float> height_m;
};

// Returns the heights at some times, so that a motion which is even between them is off by kSmallError_m at
// most. The interval with the largest error is halved again and again, until there are too many times.
// error_m: receives the error that is left.
std::vector<HeightsAtTime> refined(const Scenario& scenario, const BoundingBox& box_W,
                                   const std::vector<double>& times_s, double& error_m) {
  std::vector<HeightsAtTime> list;
  const auto at = [&](double time_s) { return HeightsAtTime{time_s, heights_at(scenario, box_W, time_s)}; };
  for (const double time_s : times_s) list.push_back(at(time_s));
  struct Gap {  // two times that follow each other, and the middle between them
    double error_m;
    HeightsAtTime before, middle, after;
    bool operator<(const Gap& other) const { return error_m < other.error_m; }
  };
  std::priority_queue<Gap> gaps;
  const auto add = [&](const HeightsAtTime& before, const HeightsAtTime& after) {
    HeightsAtTime middle = at(0.5 * (before.time_s + after.time_s));
    const double error = error_between_times_m(before.height_m, middle.height_m, after.height_m);
    gaps.push({error, before, std::move(middle), after});
  };
  for (std::size_t i = 1; i < list.size(); ++i) add(list[i - 1], list[i]);
  while (!gaps.empty() && gaps.top().error_m > kSmallError_m && list.size() < kMaxMoreTimes) {
    const Gap gap = gaps.top();
    gaps.pop();
    list.push_back(gap.middle);
    add(gap.before, gap.middle), add(gap.middle, gap.after);
  }
  error_m = gaps.empty() ? 0 : gaps.top().error_m;
  std::ranges::sort(list, {}, &HeightsAtTime::time_s);
  return list;
}

std::vector<HeightsAtTime> all_changes(const Scenario& scenario, const BoundingBox& box_W,
                                       const std::vector<double>& times_s) {
  std::vector<HeightsAtTime> list;
  for (const double time_s : times_s) {
    HeightsAtTime next{time_s, heights_at(scenario, box_W, time_s)};
    if (list.empty() || !same(next.height_m, list.back().height_m)) list.push_back(std::move(next));
  }
  return list;
}

}  // namespace

TrueHeights true_heights(const Scenario& scenario, const BoundingBox& box_W, std::span<const double> time_s) {
  TrueHeights all;
  all.stays =
      std::any_of(time_s.begin(), time_s.end(), [&](double t) { return scenario.truth_time_s(t) != t; });
  std::vector<HeightsAtTime> list =
      all.stays ? all_changes(scenario, box_W, changes(scenario, time_s))
                : refined(scenario, box_W, even_times(time_s.front(), time_s.back()), all.error_m);
  const auto is_known = [](const HeightsAtTime& at) {
    return std::ranges::any_of(at.height_m, [](float h) { return std::isfinite(h); });
  };
  if (std::ranges::none_of(list, is_known)) return {};
  const auto is_first = [&](const HeightsAtTime& at) { return same(at.height_m, list.front().height_m); };
  if (std::ranges::all_of(list, is_first)) list.resize(1);
  for (const std::size_t i : {std::size_t{0}, list.size() / 2, list.size() - 1})
    all.error_m =
        std::max(all.error_m, error_between_nodes_m(scenario, box_W, list[i].height_m, list[i].time_s));
  for (const HeightsAtTime& at : list) {
    all.time_s.push_back(at.time_s);
    all.height_m.insert(all.height_m.end(), at.height_m.begin(), at.height_m.end());
  }
  return all;
}

}  // namespace remote_touch
