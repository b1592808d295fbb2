#include "analysis/comparison/sweep_comparison.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "analysis/comparison/paired_runs.h"

namespace remote_touch {

namespace {

using Problems = std::vector<std::string>;

// --- may they be compared? ---

bool same_values(const Column& a, const Column& b) {
  const auto* numbers = std::get_if<std::vector<double>>(&a.values);
  const auto* others = std::get_if<std::vector<double>>(&b.values);
  if (numbers == nullptr || others == nullptr) return a.values == b.values;
  return std::equal(numbers->begin(), numbers->end(), others->begin(), others->end(), [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) == std::bit_cast<std::uint64_t>(y);
  });
}

void expect_same(const std::string& what, const std::string& a, const std::string& b, Problems& problems) {
  if (a != b) problems.push_back(what + ": " + a + " against " + b);
}

void check_axis(const Column& a, const Column& b, Problems& problems) {
  if (a.name != b.name) return expect_same("axis", a.name, b.name, problems);
  const std::string label = "axis " + a.name;
  expect_same(label + ", parameter", a.long_name, b.long_name, problems);
  expect_same(label + ", unit", a.units, b.units, problems);
  expect_same(label + ", values", std::to_string(a.length()), std::to_string(b.length()), problems);
  if (a.length() == b.length() && !(same_values(a, b) && a.value_names == b.value_names))
    problems.push_back(label + ": the values differ");
}

std::vector<Column>::const_iterator find(const std::vector<Column>& columns, const std::string& name) {
  return std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
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

// --- measures ---

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

// --- paired tests ---

// The p values of all tests are adjusted together: one test of each event, and two of each other measure.
void judge(const PairedRule& rule, bool needs_tests, SweepComparison& result) {
  std::vector<double> p;
  for (const RegionComparison& c : result.by_region) p.push_back(c.difference.p), p.push_back(c.mean.p);
  const std::vector<double> adjusted = holm_adjusted(p);
  result.tests = tests_among(p);
  const std::int64_t needed = pairs_for_family(result.tests, rule.alpha);
  if (result.tests > 0 && std::all_of(result.by_region.begin(), result.by_region.end(),
                                      [&](const RegionComparison& c) { return c.tested < needed; }))
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
  if (!result.first) return PairedVerdict::equal;
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
  result.exact = result.first ? ExactVerdict::different : ExactVerdict::equal;
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
