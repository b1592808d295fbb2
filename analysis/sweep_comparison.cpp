#include "analysis/sweep_comparison.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace remote_touch {

namespace {

constexpr std::size_t kMostParts = 36;
using Problems = std::vector<std::string>;
using Runs = std::vector<std::size_t>;  // rising

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

struct Pairs {
  const std::vector<double>&baseline, &candidate;
  Tolerance tolerance;

  bool finite(std::size_t run) const { return std::isfinite(baseline[run]) && std::isfinite(candidate[run]); }
  bool equal(std::size_t run) const { return within(tolerance, baseline[run], candidate[run]); }
};

bool is_event(const Pairs& pairs, const Runs& runs) {
  bool any = false;
  for (const std::size_t run : runs)
    for (const double value : {pairs.baseline[run], pairs.candidate[run]}) {
      if (!std::isfinite(value)) continue;
      if (value != 0 && value != 1) return false;
      any = true;
    }
  return any;
}

MeasureComparison compare_values(const Pairs& pairs, const Runs& runs) {
  MeasureComparison result;
  result.tolerance = pairs.tolerance, result.event = is_event(pairs, runs);
  result.compared = static_cast<std::int64_t>(runs.size());
  std::vector<double> deviations;
  for (const std::size_t run : runs) {
    if (pairs.finite(run)) deviations.push_back(std::abs(pairs.candidate[run] - pairs.baseline[run]));
    if (pairs.equal(run)) continue;
    if (result.outside++ == 0) result.first_outside = run;
  }
  for (const double d : deviations) result.largest_deviation = std::max(result.largest_deviation, d);
  result.rms_deviation = root_mean_square(deviations);
  return result;
}

std::optional<FirstDifference> first_difference(const SweepResult& a, const SweepResult& b,
                                                const SweepComparison& comparison) {
  std::optional<FirstDifference> first;
  const auto consider = [&](std::size_t run, const std::string& measure) {
    if (first && first->run <= run) return;
    const std::size_t cell = a.cell_of(run);
    first = FirstDifference{run, cell, a.place(cell), a.replicate_of(run), measure};
    if (!measure.empty())
      first->baseline = a.measure(measure)[run], first->candidate = b.measure(measure)[run];
  };
  for (const auto* only : {&comparison.baseline_only, &comparison.candidate_only})
    if (!only->empty()) consider(only->front(), "");
  for (const MeasureComparison& measure : comparison.measures)
    if (measure.first_outside) consider(*measure.first_outside, measure.name);
  return first;
}

// --- regions ---

std::string text_of(const Column& axis, std::size_t place) {
  if (const auto* texts = std::get_if<std::vector<std::string>>(&axis.values)) return (*texts)[place];
  const auto number_at = [place](const auto& values) {
    if constexpr (std::is_same_v<decltype(values), const std::vector<std::string>&>)
      return 0.0;
    else
      return static_cast<double>(values[place]);
  };
  const double number = std::visit(number_at, axis.values);
  if (!axis.value_names.empty()) return axis.value_names[static_cast<std::size_t>(number)];
  char text[32];  // 6 digits: 0.3 for 0.30000000000000004
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::general, 6).ptr};
}

std::vector<Region> regions_of(const std::vector<Column>& axes) {
  std::vector<Region> parts = {{"", {}}};
  Region whole{"all runs", {}};
  for (const Column& axis : axes) {
    const std::size_t length = axis.length();
    const bool named =
        !axis.value_names.empty() || std::holds_alternative<std::vector<std::string>>(axis.values);
    whole.places.emplace_back(0, length);
    std::size_t count = length <= 4 ? length : length >= 6 && !named ? 3 : 1;
    if (parts.size() * count > kMostParts) count = 1;
    std::vector<Region> finer;
    for (const Region& part : parts)
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t from = i * length / count, to = (i + 1) * length / count;
        finer.push_back(part);
        finer.back().places.emplace_back(from, to);
        if (count == 1) continue;
        std::string& label = finer.back().label;
        label += (label.empty() ? "" : ", ") + axis.name + " " + text_of(axis, from);
        if (to - from > 1) label += " to " + text_of(axis, to - 1);
      }
    parts = std::move(finer);
  }
  if (parts.size() == 1) parts.clear();
  parts.insert(parts.begin(), whole);
  return parts;
}

std::vector<Runs> by_region(const SweepResult& result, const Runs& runs, const std::vector<Region>& regions) {
  std::vector<Runs> split(regions.size());
  for (const std::size_t run : runs) {
    const std::vector<std::size_t> place = result.place(result.cell_of(run));
    for (std::size_t i = 0; i < regions.size(); ++i)
      if (regions[i].contains(place)) split[i].push_back(run);
  }
  return split;
}

// --- paired tests ---

RegionComparison tested(const Pairs& pairs, const Runs& runs, bool event) {
  RegionComparison result;
  result.runs = static_cast<std::int64_t>(runs.size());
  std::vector<double> all, outside;
  for (const std::size_t run : runs) {
    const bool finite = pairs.finite(run), equal = pairs.equal(run);
    result.outside += equal ? 0 : 1, result.unpaired += equal || finite ? 0 : 1;
    if (!finite) continue;
    const double b = pairs.baseline[run], c = pairs.candidate[run];
    ++result.pairs;
    result.up += !equal && c > b ? 1 : 0, result.down += !equal && c < b ? 1 : 0;
    if (event) {
      result.baseline_events += b == 1 ? 1 : 0, result.candidate_events += c == 1 ? 1 : 0;
      continue;
    }
    all.push_back(c - b);
    if (!equal && std::isfinite(c - b)) outside.push_back(c - b);
  }
  result.difference = paired_difference_interval(result.up, result.down, result.pairs);
  result.sign_p = sign_test(result.up, result.down);
  if (event) {
    result.baseline_share = wilson_interval(result.baseline_events, static_cast<int>(result.pairs));
    result.candidate_share = wilson_interval(result.candidate_events, static_cast<int>(result.pairs));
  } else {
    result.mean = mean_difference(all);
    result.symmetry_p = symmetry_test(outside);
  }
  return result;
}

Judgement judgement(const RegionComparison& c, double margin, double alpha) {
  if (c.runs > 0 && c.outside == 0) return Judgement::equal;
  if (c.adjusted_p < alpha) return Judgement::changed;
  const bool within = c.difference.first >= -margin && c.difference.second <= margin;
  return within && c.pairs > 0 && c.unpaired == 0 ? Judgement::within_margin : Judgement::undecided;
}

// Both tests of a measure that is no event are members of the family that is adjusted together.
void judge(const PairedRule& rule, SweepComparison& result) {
  std::vector<double> p;
  for (const RegionComparison& c : result.by_region) {
    p.push_back(c.sign_p);
    if (!result.measures[c.measure].event) p.push_back(c.symmetry_p);
  }
  const std::vector<double> adjusted = holm_adjusted(p);
  auto next = adjusted.begin();
  for (RegionComparison& c : result.by_region) {
    c.adjusted_p = *next++;
    if (!result.measures[c.measure].event) c.adjusted_p = std::min(c.adjusted_p, *next++);
    const double margin = result.measures[c.measure].event ? rule.margin : rule.shift_margin;
    c.judgement = judgement(c, margin, rule.alpha);
  }
}

PairedVerdict paired_verdict(const SweepComparison& result) {
  if (!result.baseline_only.empty() || !result.candidate_only.empty()) return PairedVerdict::runs_missing;
  if (!result.first) return PairedVerdict::equal;
  bool undecided = false;
  for (const RegionComparison& c : result.by_region) {
    if (c.judgement == Judgement::changed) return PairedVerdict::changed;
    undecided = undecided || (c.region == 0 && c.judgement == Judgement::undecided);
  }
  return undecided ? PairedVerdict::undecided : PairedVerdict::within_margin;
}

}  // namespace

bool Region::contains(const std::vector<std::size_t>& place) const {
  for (std::size_t i = 0; i < places.size(); ++i)
    if (place[i] < places[i].first || place[i] >= places[i].second) return false;
  return true;
}

SweepComparison compare(const SweepResult& baseline, const SweepResult& candidate,
                        const Tolerances& tolerances, const PairedRule& rule) {
  SweepComparison result;
  check_definitions(baseline, candidate, result);
  for (const auto& [name, tolerance] : tolerances)
    if (name != "*" && find(baseline.measures, name) == baseline.measures.end())
      result.problems.push_back("a tolerance is given for " + name + ", which the baseline does not measure");
  if (!result.problems.empty()) return result;
  const Runs both = check_states(baseline, candidate, result);
  if (!result.problems.empty()) return result;
  result.regions = regions_of(baseline.axes);
  const std::vector<Runs> runs = by_region(baseline, both, result.regions);
  std::vector<Pairs> pairs;
  for (const Column& measure : baseline.measures) {
    pairs.push_back({baseline.measure(measure.name), candidate.measure(measure.name),
                     tolerance_of(tolerances, measure.name)});
    result.measures.push_back(compare_values(pairs.back(), both));
    result.measures.back().name = measure.name, result.measures.back().units = measure.units;
  }
  for (std::size_t region = 0; region < runs.size(); ++region)
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      result.by_region.push_back(tested(pairs[i], runs[region], result.measures[i].event));
      result.by_region.back().region = region, result.by_region.back().measure = i;
    }
  result.first = first_difference(baseline, candidate, result);
  result.exact = result.first ? ExactVerdict::different : ExactVerdict::equal;
  judge(rule, result);
  result.paired = paired_verdict(result);
  return result;
}

}  // namespace remote_touch
