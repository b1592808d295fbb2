#include "analysis/comparison/paired_runs.h"

#include <algorithm>
#include <cmath>

namespace remote_touch {

namespace {

double standard_deviation(const std::vector<double>& values) {
  if (values.empty()) return 0;
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  std::vector<double> centred;
  for (const double value : values) centred.push_back(value - sum);
  return root_mean_square(centred);
}

bool holds(const std::pair<double, double>& interval, double margin) {
  return interval.first >= -margin && interval.second <= margin;
}

// The direction of a change. pre: the measure has a direction.
Judgement direction_of_change(const RegionComparison& c, double alpha) {
  const bool one_way = sign_test(c.got_worse, c.got_better) < alpha, on_average = c.worse_p < alpha;
  if ((one_way && c.got_worse > c.got_better) || (on_average && c.mean_worse > 0)) return Judgement::worse;
  return (one_way || on_average) && c.unpaired == 0 ? Judgement::better : Judgement::changed;
}

}  // namespace

bool Pairs::finite(std::size_t run) const {
  const double value = candidate[run];
  return std::isfinite(baseline[run]) && std::isfinite(value) && (!event || value == 0 || value == 1);
}

Judgement Pairs::judge_run(std::size_t run) const {
  const bool is_judged = same_outcome.empty() || same_outcome[run];
  return remote_touch::judge_value(baseline[run], candidate[run], is_judged ? better : Better::neither,
                                   tolerance);
}

MeasureComparison compare_values(const Pairs& pairs, const Runs& runs) {
  MeasureComparison result;
  result.better = pairs.better, result.tolerance = pairs.tolerance, result.event = pairs.event;
  result.compared = static_cast<std::int64_t>(runs.size());
  std::vector<double> deviations;
  for (const std::size_t run : runs) {
    const double deviation = std::abs(pairs.candidate[run] - pairs.baseline[run]);
    if (std::isfinite(deviation)) deviations.push_back(deviation);
    const Judgement judgement = pairs.judge_run(run);
    if (judgement == Judgement::equal) continue;
    if (result.outside++ == 0) result.first_outside = run;
    result.got_better += judgement == Judgement::better, result.got_worse += judgement == Judgement::worse;
  }
  for (const double d : deviations) result.max_deviation = std::max(result.max_deviation, d);
  result.rms_deviation = root_mean_square(deviations);
  result.run_by_run = result.outside == 0                             ? Judgement::equal
                      : result.got_worse == result.outside            ? Judgement::worse
                      : result.got_better == result.outside           ? Judgement::better
                      : result.got_worse > 0 || result.got_better > 0 ? Judgement::undecided
                                                                      : Judgement::changed;
  return result;
}

RegionComparison paired_tests(const Pairs& pairs, const Runs& runs) {
  RegionComparison result;
  result.runs = static_cast<std::int64_t>(runs.size());
  std::vector<double> all, outside, before, worse_by;
  for (const std::size_t run : runs) {
    const bool finite = pairs.finite(run), equal = pairs.equal(run);
    result.outside += equal ? 0 : 1, result.unpaired += equal || finite ? 0 : 1;
    if (!finite) continue;
    const double b = pairs.baseline[run], c = pairs.candidate[run];
    const Judgement judgement = pairs.judge_run(run);
    ++result.pairs;
    result.up += !equal && c > b ? 1 : 0, result.down += !equal && c < b ? 1 : 0;
    result.got_better += judgement == Judgement::better, result.got_worse += judgement == Judgement::worse;
    if (pairs.event) {
      result.baseline_events += b == 1 ? 1 : 0, result.candidate_events += c == 1 ? 1 : 0;
      continue;
    }
    all.push_back(c - b), before.push_back(b);
    if (equal || !std::isfinite(c - b)) continue;
    outside.push_back(c - b);
    if (judgement != Judgement::changed)
      worse_by.push_back(badness(c, pairs.better) - badness(b, pairs.better));
  }
  result.difference = paired_difference_interval(result.up, result.down, result.pairs);
  result.sign_p = sign_test(result.up, result.down);
  if (pairs.event) {
    result.baseline_fraction = wilson_interval(result.baseline_events, static_cast<int>(result.pairs));
    result.candidate_fraction = wilson_interval(result.candidate_events, static_cast<int>(result.pairs));
  } else {
    result.mean = mean_difference(all);
    result.baseline_spread = standard_deviation(before);
    result.symmetry_p = symmetry_test(outside);
    result.worse_p = symmetry_test(worse_by), result.mean_worse = mean_difference(worse_by).mean;
  }
  return result;
}

Judgement judgement_by_pairs(const RegionComparison& c, const MeasureComparison& measure,
                             const PairedRule& rule) {
  if (c.runs > 0 && c.outside == 0) return Judgement::equal;
  if (c.adjusted_p < rule.alpha || c.unpaired > 0)
    return measure.better == Better::neither ? Judgement::changed : direction_of_change(c, rule.alpha);
  if (c.pairs == 0) return Judgement::undecided;
  const bool within = measure.event
                          ? holds(c.difference, rule.margin)
                          : holds(c.difference, rule.shift_margin) &&
                                holds({c.mean.low, c.mean.high}, rule.shift_margin * c.baseline_spread);
  return within ? Judgement::within_margin : Judgement::undecided;
}

}  // namespace remote_touch
