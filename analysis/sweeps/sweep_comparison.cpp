#include "analysis/sweeps/sweep_comparison.h"

#include <algorithm>
#include <cmath>

#include "analysis/storage/digest.h"
#include "analysis/trace/interval_estimates.h"

namespace remote_touch {

namespace {

// One measure in the same runs of two sweeps, and the results of its paired tests.

using Runs = std::vector<std::size_t>;  // increasing

struct Pairs {
  const std::vector<double>&baseline, &candidate;
  Tolerance tolerance;
  Better better = Better::neither;
  bool event = false;                // true: a candidate's value other than 0 and 1 has no partner
  std::vector<bool> is_judged = {};  // runs that may get better or worse. Empty: all

  bool finite(std::size_t run) const {
    const double value = candidate[run];
    return std::isfinite(baseline[run]) && std::isfinite(value) && (!event || value == 0 || value == 1);
  }
  bool equal(std::size_t run) const { return within(tolerance, baseline[run], candidate[run]); }
  // equal, better, worse or changed
  Judgement judge_run(std::size_t run) const {
    const bool has_direction = is_judged.empty() || is_judged[run];
    return judge_value(baseline[run], candidate[run], has_direction ? better : Better::neither, tolerance);
  }
};

constexpr double kNoOutcome = std::numeric_limits<double>::quiet_NaN();

double standard_deviation(std::vector<double> values) {
  double sum = 0;
  for (const double value : values) sum += value / static_cast<double>(values.size());
  for (double& value : values) value -= sum;
  return root_mean_square(values);
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
  return {.unknown = OutcomePair{outcome(pairs.baseline[run]), outcome(pairs.candidate[run])}};
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

// Sets all of MeasureComparison except the name and the units. If runs went both ways, run_by_run is
// undecided until the paired tests are known.
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
  if (!deviations.empty()) result.max_deviation = std::ranges::max(deviations);
  result.rms_deviation = root_mean_square(deviations);
  result.run_by_run = result.outside == 0                             ? Judgement::equal
                      : result.got_worse == result.outside            ? Judgement::worse
                      : result.got_better == result.outside           ? Judgement::better
                      : result.got_worse > 0 || result.got_better > 0 ? Judgement::undecided
                                                                      : Judgement::changed;
  return result;
}

// Computes the tests of a region. Their p values are not yet adjusted, and there is no judgement yet.
// Clusters that draw no random numbers are counted, but not tested.
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

// pre: adjusted_p is set.
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

// May the sweeps be compared?

using Problems = std::vector<std::string>;

void expect_same(const std::string& what, const std::string& a, const std::string& b, Problems& problems) {
  if (a != b) problems.push_back(what + ": " + a + " against " + b);
}

void check_axis(const Column& a, const Column& b, Problems& problems) {
  if (a.name != b.name) return expect_same("axis", a.name, b.name, problems);
  const std::string label = "axis " + a.name;
  expect_same(label + ", parameter", a.long_name, b.long_name, problems);
  expect_same(label + ", unit", a.units, b.units, problems);
  expect_same(label + ", values", std::to_string(a.length()), std::to_string(b.length()), problems);
  if (a.length() == b.length() && (digest({a}) != digest({b}) || a.value_names != b.value_names))
    problems.push_back(label + ": the values differ");
}

std::vector<Column>::const_iterator find(const std::vector<Column>& columns, const std::string& name) {
  return std::ranges::find(columns, name, &Column::name);
}

void check_measures(const SweepResult& a, const SweepResult& b, SweepComparison& result) {
  if (a.measures.empty()) result.problems.emplace_back("the baseline has no measures");
  auto last = b.measures.begin();
  for (const Column& measure : a.measures) {
    const std::string label = "measure " + measure.name;
    const auto found = find(b.measures, measure.name);
    if (found == b.measures.end()) {
      result.problems.push_back(label + ": the candidate has none");
      continue;
    }
    expect_same(label + ", unit", measure.units, found->units, result.problems);
    if (found < last) result.problems.push_back(label + ": comes before " + last->name + " in the candidate");
    last = std::max(last, found);
  }
  for (const Column& measure : b.measures)
    if (find(a.measures, measure.name) == a.measures.end())
      result.notes.push_back("measure " + measure.name + ": only the candidate has it");
}

void check_definitions(const SweepResult& a, const SweepResult& b, SweepComparison& result) {
  expect_same("axes", std::to_string(a.axes.size()), std::to_string(b.axes.size()), result.problems);
  for (std::size_t i = 0; i < std::min(a.axes.size(), b.axes.size()); ++i)
    check_axis(a.axes[i], b.axes[i], result.problems);
  expect_same("replicates", std::to_string(a.replicates), std::to_string(b.replicates), result.problems);
  check_measures(a, b, result);
}

// Returns the runs done in both.
Runs check_states(const SweepResult& a, const SweepResult& b, SweepComparison& result) {
  Runs both;
  for (std::size_t run = 0; run < a.run_count(); ++run) {
    const bool in_a = a.state[run] == RunState::done, in_b = b.state[run] == RunState::done;
    if (in_a && in_b) both.push_back(run);
    if (in_a && !in_b) result.baseline_only.push_back(run);
    if (in_a && b.state[run] == RunState::failed) ++result.newly_failed;
    if (!in_a && in_b) result.candidate_only.push_back(run);
  }
  const std::size_t neither =
      a.run_count() - both.size() - result.baseline_only.size() - result.candidate_only.size();
  if (neither > 0) result.notes.push_back("runs done in neither: " + std::to_string(neither));
  if (both.empty()) result.problems.emplace_back("no run is done in both");
  result.done_in_both = both.size();
  return both;
}

bool is_0_or_1(double value) {
  return value == 0 || value == 1 || !std::isfinite(value);
}

// True if the measure is an event: the finite values of the baseline are 0 or 1. If none of them is 1, the
// event may not have happened in the baseline; then those of the candidate must be 0 or 1, too.
bool is_event(const std::vector<double>& baseline, const std::vector<double>& candidate, const Runs& runs) {
  bool any = false, happened = false, in_candidate = true;
  for (const std::size_t run : runs) {
    if (!is_0_or_1(baseline[run])) return false;
    any |= std::isfinite(baseline[run]), happened |= baseline[run] == 1;
    in_candidate &= is_0_or_1(candidate[run]);
  }
  return any && (happened || in_candidate);
}

// True for each run whose outcomes agree, see is_outcome().
std::vector<bool> same_outcomes(const SweepResult& a, const SweepResult& b) {
  std::vector<bool> same(a.run_count(), true);
  for (const Column& measure : a.measures)
    if (is_outcome(measure.name))
      for (std::size_t run = 0; run < same.size(); ++run)
        if (!within({}, a.measure(measure.name)[run], b.measure(measure.name)[run])) same[run] = false;
  return same;
}

// Sets the runs to false in which the sweep has the note "no contact".
void exclude_without_contact(const SweepResult& sweep, std::vector<bool>& runs) {
  const auto kind = std::find(sweep.note_kinds.begin(), sweep.note_kinds.end(), "no contact");
  if (kind == sweep.note_kinds.end() || sweep.notes.size() != runs.size()) return;
  const auto bit = kind - sweep.note_kinds.begin();
  for (std::size_t run = 0; run < runs.size(); ++run)
    if ((sweep.notes[run] >> bit & 1) != 0) runs[run] = false;
}

std::optional<FirstDifference> first_difference(const SweepResult& a, const SweepResult& b,
                                                const SweepComparison& comparison) {
  std::optional<FirstDifference> first;
  const auto consider = [&](std::size_t run, const std::string& measure) {
    if (first && first->run <= run) return;
    const std::size_t cell = a.cell_of(run);
    first = FirstDifference{run, cell, a.axis_indices(cell), a.replicate_of(run), measure};
    if (!measure.empty())
      first->baseline = a.measure(measure)[run], first->candidate = b.measure(measure)[run];
  };
  for (const auto* only : {&comparison.baseline_only, &comparison.candidate_only})
    if (!only->empty()) consider(only->front(), "");
  for (const MeasureComparison& measure : comparison.measures)
    if (measure.first_outside) consider(*measure.first_outside, measure.name);
  return first;
}

// Returns the sweep without values, in which just these runs are done.
SweepResult with_runs(const SweepResult& sweep, const Runs& runs) {
  SweepResult outline;
  outline.axes = sweep.axes, outline.replicates = sweep.replicates;
  outline.state.assign(sweep.run_count(), RunState::not_sampled);
  for (const std::size_t run : runs) outline.state[run] = RunState::done;
  return outline;
}

// Returns the clusters of the finished runs in a region.
std::vector<RunCluster> clusters_in(const Region& region, const SweepResult& sweep,
                                    const CellStreams& streams) {
  std::vector<std::size_t> cells;
  for (std::size_t cell = 0; cell < sweep.cell_count(); ++cell)
    if (region.contains(sweep.axis_indices(cell))) cells.push_back(cell);
  return clusters_of(sweep, streams, cells, streams.share_replicates(cells));
}

// The p values of all tests are adjusted together: one test of each event, and two of each other measure.
void judge(const PairedRule& rule, bool needs_tests, SweepComparison& result) {
  std::vector<double> p;
  for (const RegionComparison& c : result.by_region) p.push_back(c.difference.p), p.push_back(c.mean.p);
  const std::vector<double> adjusted = holm_adjusted(p);
  result.tests = tests_among(p);
  const std::int64_t needed = pairs_for_family(result.tests, rule.alpha);
  if (result.tests > 0 && std::ranges::max(result.by_region, {}, &RegionComparison::tested).tested < needed)
    result.needed_clusters = needed;
  auto next = adjusted.begin();
  for (RegionComparison& c : result.by_region) {
    for (const Estimate* test : {&c.difference, &c.mean}) {
      if (!test->is_skewed) c.adjusted_p = std::fmin(c.adjusted_p, *next);
      ++next;
    }
    c.judgement = judgement_by_pairs(c, result.measures[c.measure], rule);
  }
  for (std::size_t i = 0; i < result.measures.size(); ++i) {
    if (result.at(0, i).tested == 0) continue;  // no test can show a direction
    Judgement& run_by_run = result.measures[i].run_by_run;
    const Judgement prevails = judgement_of(result, i, true);
    const auto has_direction = [](Judgement j) { return j == Judgement::better || j == Judgement::worse; };
    if (needs_tests && has_direction(run_by_run)) run_by_run = Judgement::undecided;
    if (run_by_run == Judgement::undecided && has_direction(prevails)) run_by_run = prevails;
  }
}

// True for a run of the first round of a refined sweep, and for every run of another sweep. Later rounds
// depend on results.
bool is_planned(const SweepResult& sweep, std::size_t run) {
  return sweep.round.empty() || sweep.round[run] == 0;
}

PairedVerdict paired_verdict(const SweepResult& baseline, const SweepComparison& result) {
  for (const auto* only : {&result.baseline_only, &result.candidate_only})
    for (const std::size_t run : *only)
      if (is_planned(baseline, run)) return PairedVerdict::runs_missing;
  if (result.is_equal()) return PairedVerdict::equal;
  bool undecided = false;
  for (const RegionComparison& c : result.by_region) {
    if (is_change(c.judgement)) return PairedVerdict::changed;
    undecided = undecided || (c.region == 0 && c.judgement == Judgement::undecided);
  }
  return undecided ? PairedVerdict::undecided : PairedVerdict::within_margin;
}

}  // namespace

SweepComparison compare(const SweepResult& baseline, const SweepResult& candidate,
                        const Tolerances& tolerances, const PairedRule& rule, const Directions& directions,
                        const SweepPairing& pairing) {
  SweepComparison result;
  check_definitions(baseline, candidate, result);
  for (const auto& [name, tolerance] : tolerances)
    if (name != "*" && find(baseline.measures, name) == baseline.measures.end())
      result.problems.push_back("a tolerance is given for " + name + ", which the baseline does not measure");
  if (!result.problems.empty()) return result;
  const Runs both = check_states(baseline, candidate, result);
  if (!result.problems.empty()) return result;
  result.regions = regions_of(baseline.axes);
  Runs planned;
  for (const std::size_t run : both)
    if (is_planned(baseline, run)) planned.push_back(run);
  const std::vector<bool> same_outcome = same_outcomes(baseline, candidate);
  std::vector<bool> with_contact = same_outcome;
  for (const SweepResult* sweep : {&baseline, &candidate}) exclude_without_contact(*sweep, with_contact);
  std::vector<Pairs> pairs;
  for (const Column& measure : baseline.measures) {
    pairs.push_back({baseline.measure(measure.name), candidate.measure(measure.name),
                     tolerance_of(tolerances, measure.name), direction_of(directions, measure.name),
                     is_event(baseline.measure(measure.name), candidate.measure(measure.name), both),
                     is_outcome(measure.name)      ? std::vector<bool>()
                     : needs_contact(measure.name) ? with_contact
                                                   : same_outcome});
    result.measures.push_back(compare_values(pairs.back(), both));
    result.measures.back().name = measure.name, result.measures.back().units = measure.units;
  }
  const SweepResult outline = with_runs(baseline, planned);
  const CellStreams streams = pairing.streams.value_or(independent_streams(baseline.cell_count()));
  for (std::size_t region = 0; region < result.regions.size(); ++region) {
    const std::vector<RunCluster> clusters = clusters_in(result.regions[region], outline, streams);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      result.by_region.push_back(paired_tests(pairs[i], clusters));
      result.by_region.back().region = region, result.by_region.back().measure = i;
    }
  }
  result.first = first_difference(baseline, candidate, result);
  judge(rule, pairing.needs_tests, result);
  result.paired = paired_verdict(baseline, result);
  return result;
}

Judgement judgement_of(const SweepComparison& sweep, std::size_t measure, bool paired) {
  if (!paired) return sweep.measures[measure].run_by_run;
  for (const Judgement counts : {Judgement::worse, Judgement::changed, Judgement::better})
    for (std::size_t region = 0; region < sweep.regions.size(); ++region)
      if (sweep.at(region, measure).judgement == counts) return counts;
  return sweep.at(0, measure).judgement;
}

}  // namespace remote_touch
