#include "analysis/standing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "analysis/paired_bootstrap.h"

namespace remote_touch {

namespace {

// So that smaller is better.
double badness(double value, Better better) {
  return better == Better::larger ? -value : better == Better::near_zero ? std::abs(value) : value;
}

PairedValues differences(const PairedValues& a, const PairedValues& b, Better better) {
  PairedValues d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < a[i].size(); ++k)
      d[i].push_back(badness(a[i][k], better) - badness(b[i][k], better));
  return d;
}

bool excludes_zero(double low, double high) {
  return low > 0 || high < 0;
}

bool are_apart(const PairedValues& a, const PairedValues& b, Better better, bool event, std::uint64_t key) {
  const PairedValues d = differences(a, b, better);
  if (!event) {
    const MeanDifference mean = bootstrap_mean(d, key);
    return mean.pairs > 1 && excludes_zero(mean.low, mean.high);
  }
  std::int64_t plus = 0, minus = 0, pairs = 0;
  for (const auto& group : d)
    for (const double one : group)
      if (!std::isnan(one)) plus += one > 0, minus += one < 0, ++pairs;
  const auto [low, high] = paired_difference_interval(plus, minus, pairs);
  return excludes_zero(low, high);
}

double mean_badness(const PairedValues& values, Better better) {
  double sum = 0, count = 0;
  for (const auto& group : values)
    for (const double value : group)
      if (!std::isnan(value)) sum += badness(value, better), ++count;
  return sum / count;
}

}  // namespace

Standing standing(const std::vector<PairedValues>& contenders, Better better, bool event, std::uint64_t key) {
  Standing result;
  std::vector<double> bad;
  for (const PairedValues& values : contenders) {
    result.mean.push_back(bootstrap_mean(values, key));
    bad.push_back(result.mean.back().pairs > 0 ? mean_badness(values, better)
                                               : std::numeric_limits<double>::infinity());
  }
  result.order.resize(contenders.size());
  std::iota(result.order.begin(), result.order.end(), std::size_t{0});
  std::stable_sort(result.order.begin(), result.order.end(),
                   [&](std::size_t a, std::size_t b) { return bad[a] < bad[b]; });
  for (const double each : bad) result.placed += each < std::numeric_limits<double>::infinity() ? 1 : 0;
  const std::size_t known = result.placed;
  if (better == Better::reported || known == 0) return result;
  const auto apart = [&](std::size_t i, std::size_t k) {
    return are_apart(contenders[result.order[i]], contenders[result.order[k]], better, event, key);
  };
  result.at_the_top = {result.order[0]};
  for (std::size_t i = 1; i < known; ++i)
    if (!apart(0, i)) result.at_the_top.push_back(result.order[i]);
  if (known < 2) return result;
  result.has_best = apart(0, 1);
  result.has_worst = apart(known - 2, known - 1);
  return result;
}

}  // namespace remote_touch
