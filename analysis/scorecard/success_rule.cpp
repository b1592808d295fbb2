#include "analysis/scorecard/success_rule.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace remote_touch {

std::vector<bool> successes(const SweepResult& result, const std::vector<Bound>& bounds) {
  std::vector<bool> kept;
  for (const RunState state : result.state) kept.push_back(state == RunState::done);
  for (const Bound& bound : bounds) {
    const std::vector<double>& values = result.measure(bound.measure);
    for (std::size_t run = 0; run < kept.size(); ++run) kept[run] = kept[run] && bound.holds(values[run]);
  }
  return kept;
}

long typical_failure(const SweepResult& result, const std::vector<Bound>& bounds, std::size_t cell) {
  using Failure = std::tuple<std::size_t, double, std::size_t>;  // bound, value, run: no two are equal
  std::vector<Failure> failures;
  for (int replicate = 0; replicate < result.replicates; ++replicate) {
    const std::size_t run = result.run(cell, replicate);
    if (result.state[run] == RunState::failed) failures.emplace_back(bounds.size(), 0, run);
    if (result.state[run] != RunState::done) continue;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
      const double value = result.measure(bounds[i].measure)[run];
      if (bounds[i].holds(value)) continue;
      // NaN sorts behind all numbers.
      failures.emplace_back(i, std::isnan(value) ? std::numeric_limits<double>::infinity() : value, run);
      break;
    }
  }
  if (failures.empty()) return -1;
  std::sort(failures.begin(), failures.end());
  return static_cast<long>(std::get<2>(failures[(failures.size() - 1) / 2]));
}

}  // namespace remote_touch
