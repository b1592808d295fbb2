#include "analysis/scorecard/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/statistics/paired_bootstrap.h"

namespace remote_touch {

namespace {

// So that smaller is better.
double badness(double value, Better better) {
  return better == Better::larger ? -value : better == Better::near_zero ? std::abs(value) : value;
}

// Of two methods, above 0 where a is worse; repeats: of both.
PairedValues differences(const PairedValues& a, const PairedValues& b, Better better,
                         const Repeats& repeats) {
  PairedValues d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < a[i].size(); ++k)
      d[i].push_back(badness(a[i][k], better) - badness(b[i][k], better));
  return distinct(d, repeats);
}

// A single number that is left of a level shows no spread: drawn from within its level it would be certain.
// All those are drawn from together. A level that is one run is certain.
PairedValues with_lone_pairs_together(const PairedValues& d, const Repeats& repeats) {
  PairedValues groups(1);
  for (std::size_t i = 0; i < d.size(); ++i) {
    std::vector<double> known;
    for (const double one : d[i])
      if (!std::isnan(one)) known.push_back(one);
    if (known.size() == 1 && !(i < repeats.size() && repeats[i]))
      groups.front().push_back(known.front());
    else
      groups.push_back(known);
  }
  return groups;
}

// Do the pairs show that a is better than b?
bool is_better(const PairedValues& a, const PairedValues& b, Better better, bool event, std::uint64_t key,
               const Repeats& repeats) {
  const PairedValues d = differences(a, b, better, repeats);
  if (!event) {
    const MeanDifference mean = bootstrap_mean(with_lone_pairs_together(d, repeats), key);
    return mean.pairs >= kMinPairs && mean.high < 0;
  }
  std::int64_t plus = 0, minus = 0, pairs = 0;
  for (const auto& group : d)
    for (const double one : group)
      if (!std::isnan(one)) plus += one > 0, minus += one < 0, ++pairs;
  return paired_difference_interval(plus, minus, pairs).second < 0;
}

double mean_badness(const PairedValues& values, Better better) {
  double sum = 0, count = 0;
  for (const auto& group : values)
    for (const double value : group)
      if (!std::isnan(value)) sum += badness(value, better), ++count;
  return sum / count;
}

Repeats of_both(const Repeats& a, const Repeats& b) {
  Repeats both(std::min(a.size(), b.size()));
  for (std::size_t i = 0; i < both.size(); ++i) both[i] = a[i] && b[i];
  return both;
}

}  // namespace

PairedValues distinct(const PairedValues& values, const Repeats& repeats) {
  PairedValues once = values;
  for (std::size_t i = 0; i < std::min(once.size(), repeats.size()); ++i)
    if (repeats[i] && once[i].size() > 1) once[i].erase(once[i].begin() + 1, once[i].end());
  return once;
}

Ranking ranking(const std::vector<PairedValues>& methods, Better better, bool event, std::uint64_t key,
                const std::vector<Repeats>& repeats) {
  Ranking result;
  std::vector<double> bad;
  const auto repeats_of = [&](std::size_t c) { return c < repeats.size() ? repeats[c] : Repeats{}; };
  for (std::size_t c = 0; c < methods.size(); ++c) {
    const PairedValues values = distinct(methods[c], repeats_of(c));
    result.mean.push_back(bootstrap_mean(with_lone_pairs_together(values, repeats_of(c)), key));
    bad.push_back(result.mean.back().pairs >= (event ? 1 : kMinPairs)
                      ? mean_badness(values, better)
                      : std::numeric_limits<double>::infinity());
  }
  result.order.resize(methods.size());
  std::iota(result.order.begin(), result.order.end(), std::size_t{0});
  std::stable_sort(result.order.begin(), result.order.end(),
                   [&](std::size_t a, std::size_t b) { return bad[a] < bad[b]; });
  for (const double each : bad) result.ranked += each < std::numeric_limits<double>::infinity() ? 1 : 0;
  const std::size_t ranked = result.ranked;
  if (better == Better::reported || ranked == 0) return result;
  const auto is_above = [&](std::size_t i, std::size_t k) {
    const std::size_t a = result.order[i], b = result.order[k];
    return is_better(methods[a], methods[b], better, event, key, of_both(repeats_of(a), repeats_of(b)));
  };
  result.top_group = {result.order[0]};
  for (std::size_t i = 1; i < ranked; ++i)
    if (!is_above(0, i)) result.top_group.push_back(result.order[i]);
  if (ranked < 2) return result;
  result.has_best = result.top_group.size() == 1;
  result.has_worst = true;
  for (std::size_t i = 0; i + 1 < ranked; ++i) result.has_worst = result.has_worst && is_above(i, ranked - 1);
  return result;
}

}  // namespace remote_touch
