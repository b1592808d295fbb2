#include "analysis/comparison/paired_runs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "analysis/statistics/paired_test.h"
#include "analysis/statistics/proportion.h"

namespace remote_touch {

namespace {

constexpr double kNoOutcome = std::numeric_limits<double>::quiet_NaN();

double standard_deviation(const std::vector<double>& values) {
  if (values.empty()) return 0;
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  std::vector<double> centred;
  for (const double value : values) centred.push_back(value - sum);
  return root_mean_square(centred);
}

bool holds(const Estimate& interval, double margin) {
  return interval.low >= -margin && interval.high <= margin;
}

bool shows(const Estimate& difference, double alpha) {
  return difference.p < alpha && !difference.is_skewed;
}

// The direction of a change. pre: the measure has a direction.
Judgement direction_of_change(const RegionComparison& c, double alpha) {
  const bool one_way = shows(c.worse_share, alpha), on_average = shows(c.worse_by, alpha);
  if ((one_way && c.worse_share.value > 0) || (on_average && c.worse_by.value > 0)) return Judgement::worse;
  const bool is_better = (one_way || on_average) && c.unpaired == 0 && c.fixed_not_better == 0;
  return is_better ? Judgement::better : Judgement::changed;
}

// The change of a pair of finite values: 1, 0 or -1, and its size. All are 0 within the tolerance. unknown:
// the outcomes of an event of which at least one is not known.
struct PairChange {
  int shift = 0, worse = 0;
  double difference = 0, worse_by = 0;
  std::optional<OutcomePair> unknown = {};
};

PairChange change_of(const Pairs& pairs, std::size_t run) {
  if (pairs.equal(run)) return {};
  const double b = pairs.baseline[run], c = pairs.candidate[run];
  const Judgement judgement = pairs.judge_run(run);
  PairChange change;
  change.shift = c > b ? 1 : -1;
  change.worse = judgement == Judgement::worse ? 1 : judgement == Judgement::better ? -1 : 0;
  if (!std::isfinite(c - b)) return change;
  change.difference = c - b;
  if (change.worse != 0) change.worse_by = badness(c, pairs.better) - badness(b, pairs.better);
  return change;
}

// Returns the change of a pair of outcomes of which at least one is not known.
PairChange unknown_change(const Pairs& pairs, std::size_t run) {
  const auto outcome = [](double value) { return value == 0 || value == 1 ? value : kNoOutcome; };
  PairChange change;
  change.unknown = {outcome(pairs.baseline[run]), outcome(pairs.candidate[run])};
  return change;
}

// Returns the pair of outcomes in which 1 is worse. Without a direction nothing is worse.
OutcomePair worse_outcomes(const OutcomePair& pair, Better better) {
  if (better == Better::smaller) return pair;
  return better == Better::larger ? OutcomePair{pair.second, pair.first} : OutcomePair{};
}

// The changes of the pairs of each cluster.
struct ClusterChanges {
  std::vector<std::vector<OutcomePair>> shifts, worse;
  std::vector<double> differences, worse_by;  // means over the pairs of a cluster

  void add(const std::vector<PairChange>& cluster, Better better) {
    const auto outcome = [](int change) {
      return OutcomePair{change < 0 ? 1.0 : 0.0, change > 0 ? 1.0 : 0.0};
    };
    shifts.emplace_back(), worse.emplace_back(), differences.push_back(0), worse_by.push_back(0);
    for (const PairChange& change : cluster) {
      shifts.back().push_back(change.unknown.value_or(outcome(change.shift)));
      worse.back().push_back(change.unknown ? worse_outcomes(*change.unknown, better)
                                            : outcome(change.worse));
      differences.back() += change.difference / static_cast<double>(cluster.size());
      worse_by.back() += change.worse_by / static_cast<double>(cluster.size());
    }
  }
};

// The pairs that draw no random numbers.
struct FixedPairs {
  std::int64_t known = 0, unknown = 0;
  double sum = 0;              // sum of the known changes
  double least = 0, most = 0;  // sums of the least and the greatest possible changes of the unknown

  void add(const PairChange& change, double known_change) {
    if (!change.unknown) {
      ++known, sum += known_change;
      return;
    }
    ++unknown;
    least -= change.unknown->first == 0 || change.unknown->second == 1 ? 0 : 1;
    most += change.unknown->first == 1 || change.unknown->second == 0 ? 0 : 1;
  }
};

// Extends the interval of clusters that draw random numbers to all, by the exact values of the others. Equal
// differences have no interval; if they are enough for a test, they count as exact.
Estimate with_fixed(Estimate e, std::int64_t clusters, const FixedPairs& fixed) {
  if (clusters + fixed.known + fixed.unknown == 0) return e;
  if (clusters == 0) e.value = e.low = e.high = 0;
  if (std::isnan(e.low) && !std::isnan(e.p)) e.low = e.high = e.value;
  if (fixed.known + fixed.unknown == 0) return e;
  const auto tested = static_cast<double>(clusters), known = static_cast<double>(fixed.known);
  const double all = tested + known + static_cast<double>(fixed.unknown);
  if (tested + known > 0) e.value = (e.value * tested + fixed.sum) / (tested + known);
  e.low = (e.low * tested + fixed.sum + fixed.least) / all;
  e.high = (e.high * tested + fixed.sum + fixed.most) / all;
  return e;
}

}  // namespace

bool Pairs::finite(std::size_t run) const {
  const double value = candidate[run];
  return std::isfinite(baseline[run]) && std::isfinite(value) && (!event || value == 0 || value == 1);
}

Judgement Pairs::judge_run(std::size_t run) const {
  const bool has_direction = is_judged.empty() || is_judged[run];
  return remote_touch::judge_value(baseline[run], candidate[run], has_direction ? better : Better::neither,
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

RegionComparison paired_tests(const Pairs& pairs, const std::vector<RunCluster>& clusters) {
  RegionComparison result;
  ClusterChanges tested;
  std::vector<double> baseline;
  std::vector<EventCounts> events_before, events_now;  // one for each cluster
  FixedPairs fixed_shifts, fixed_differences;
  bool is_anything_to_test = false;
  for (const RunCluster& cluster : clusters) {
    std::vector<PairChange> changes;
    EventCounts& was = events_before.emplace_back();
    EventCounts& is = events_now.emplace_back();
    for (const std::size_t run : cluster.runs) {
      const bool finite = pairs.finite(run), equal = pairs.equal(run);
      ++result.runs;
      result.outside += equal ? 0 : 1, result.unpaired += equal || finite ? 0 : 1;
      if (!finite && pairs.event) {
        changes.push_back(unknown_change(pairs, run));
        ++was.unknown, ++is.unknown;
        if (cluster.is_fixed) fixed_shifts.add(changes.back(), 0);
      }
      is_anything_to_test |= !cluster.is_fixed && !equal && (finite || pairs.event);
      if (!finite) continue;
      changes.push_back(change_of(pairs, run)), baseline.push_back(pairs.baseline[run]);
      const PairChange& change = changes.back();
      ++result.pairs;
      result.up += change.shift > 0, result.down += change.shift < 0;
      result.got_better += change.worse<0, result.got_worse += change.worse> 0;
      ++(pairs.baseline[run] == 1 ? was.events : was.without);
      ++(pairs.candidate[run] == 1 ? is.events : is.without);
      if (!cluster.is_fixed) continue;
      fixed_shifts.add(change, change.shift), fixed_differences.add(change, change.difference);
      result.fixed_not_better += !equal && change.worse >= 0;
    }
    if (!cluster.is_fixed && !changes.empty()) tested.add(changes, pairs.better);
  }
  result.tested = static_cast<std::int64_t>(tested.shifts.size());
  result.clusters = static_cast<std::int64_t>(clusters.size());
  result.difference = with_fixed(estimated_event_difference(tested.shifts), result.tested, fixed_shifts);
  result.worse_share = estimated_event_difference(tested.worse);
  if (pairs.event) {
    const EventCounts before = sum_of(events_before), now = sum_of(events_now);
    result.baseline_events = static_cast<int>(before.events);
    result.candidate_events = static_cast<int>(now.events);
    const bool are_fixed = result.tested == 0;
    result.baseline_fraction = are_fixed ? exact_fraction(before) : estimated_fraction(events_before);
    result.candidate_fraction = are_fixed ? exact_fraction(now) : estimated_fraction(events_now);
  } else {
    result.mean = with_fixed(estimated_difference(tested.differences), result.tested, fixed_differences);
    result.baseline_spread = standard_deviation(baseline);
    result.worse_by = estimated_difference(tested.worse_by);
  }
  if (!is_anything_to_test) result.difference.p = result.mean.p = std::numeric_limits<double>::quiet_NaN();
  return result;
}

Judgement judgement_by_pairs(const RegionComparison& c, const MeasureComparison& measure,
                             const PairedRule& rule) {
  if (c.runs > 0 && c.outside == 0) return Judgement::equal;
  if (c.adjusted_p < rule.alpha || c.unpaired > 0)
    return measure.better == Better::neither ? Judgement::changed : direction_of_change(c, rule.alpha);
  if (c.pairs == 0) return Judgement::undecided;
  const bool within = measure.event ? holds(c.difference, rule.margin)
                                    : holds(c.difference, rule.shift_margin) &&
                                          holds(c.mean, rule.shift_margin * c.baseline_spread);
  if (within) return Judgement::within_margin;
  if (c.tested > 0) return Judgement::undecided;
  return c.got_worse == c.outside    ? Judgement::worse
         : c.got_better == c.outside ? Judgement::better
                                     : Judgement::changed;
}

}  // namespace remote_touch
