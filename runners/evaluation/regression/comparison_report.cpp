#include "runners/evaluation/regression/result_comparison.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cinttypes>
#include <cmath>

#include "analysis/report/report.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/catalog.h"

namespace remote_touch {

std::string shortest_text(double number) {
  std::array<char, 40> digits{};
  char* const begin = digits.data();
  return {begin, std::to_chars(begin, begin + digits.size(), number, std::chars_format::general).ptr};
}

namespace {

using CaseState = ReportCase::State;

constexpr const char* kNoValueText = "no value";

ReportValue interval(const Estimate& of) {
  return list_of(std::vector{of.low, of.high});
}

// "exact", or "1e-09 + 1e-06 relative".
std::string tolerance_text(const Tolerance& tolerance) {
  if (tolerance.absolute == 0 && tolerance.relative == 0) return "exact";
  const std::string all = formatted("%.3g", tolerance.absolute);
  return tolerance.relative > 0 ? all + formatted(" + %.3g relative", tolerance.relative) : all;
}

// The shortest text of a number, in words if there is none.
std::string value_text(double value) {
  return std::isnan(value) ? kNoValueText : shortest_text(value);
}

// "2 of 867 rows outside, the largest deviation 0.25"; empty for none.
std::string outside_text(std::size_t outside, std::size_t of, const char* things, double max) {
  if (outside == 0) return {};
  return formatted("%zu of %zu %s outside, the largest deviation %.6g", outside, of, things, max);
}

// --- columns ---

ReportCase case_of(const ColumnComparison& column) {
  std::string why = column.problem;
  if (!why.empty() && column.outside > 0) why += "; ";
  why += outside_text(column.outside, column.rows, "rows", column.max);
  return {column.name, column.is_same() ? CaseState::passed : CaseState::skipped, why};
}

// "1e-09; 3 rows without a finite difference  DIFFERS"
std::string rule_text(const ColumnComparison& column) {
  std::string text = tolerance_text(column.tolerance);
  if (column.not_numbers > 0) text += formatted("; %zu rows without a finite difference", column.not_numbers);
  if (!column.problem.empty()) text += "; " + column.problem;
  return text + (column.is_same() ? "" : "  DIFFERS");
}

ReportRow row_of(const ColumnComparison& column) {
  const double percent =
      column.rows == 0 ? 0 : 100.0 * static_cast<double>(column.outside) / static_cast<double>(column.rows);
  ReportRow row{.is_shown = !column.is_same() || column.first_difference, .result = case_of(column)};
  row.add("name", "column", column.name).add("units", "units", column.units);
  row.tell("same", column.is_same()).tell("problem", column.problem);
  row.tell("absolute_tolerance", column.tolerance.absolute);
  row.tell("relative_tolerance", column.tolerance.relative);
  row.add("rows", "rows", column.rows);
  row.tell("outside", column.outside).tell("not_numbers", column.not_numbers);
  row.add("max", "max", column.max, formatted("%.4g", column.max));
  row.add("rms", "rms", column.rms, formatted("%.4g", column.rms));
  row.show("outside", formatted("%.3g%%", percent), percent).show("tolerance", rule_text(column));
  row.tell("first_difference", column.first_difference).tell("first_outside", column.first_outside);
  return row;
}

// Returns the values of a column. The name of an enumeration replaces each number that has one.
ReportValue values_of(const Column& column) {
  const auto* const integers = std::get_if<std::vector<std::int32_t>>(&column.values);
  if (!integers || column.value_names.empty())
    return std::visit([](const auto& values) { return list_of(values); }, column.values);
  std::vector<ReportValue> values;
  for (const std::int32_t value : *integers) {
    const auto place = static_cast<std::size_t>(value);
    values.push_back(place < column.value_names.size() ? ReportValue(column.value_names[place])
                                                       : ReportValue(value));
  }
  return values;
}

Report rows_of(const std::vector<Column>& columns) {
  Report rows;
  for (const Column& column : columns) rows.tell(column.name, values_of(column));
  return rows;
}

void add_columns(const TraceComparison& comparison, Report& report) {
  ReportTable table{"columns"};
  std::vector<std::string> equal;
  for (const ColumnComparison& column : comparison.columns) {
    table.rows.push_back(row_of(column));
    if (!table.rows.back().is_shown) equal.push_back(column.name);
  }
  report.add(table);
  if (!equal.empty())
    report.line(formatted("  %zu of %zu columns are equal: ", equal.size(), comparison.columns.size()) +
                joined(equal, ", "));
  for (const std::string& name : comparison.added)
    report.line("  " + name + "  only in the candidate: not compared");
  report.tell("columns_only_in_candidate", list_of(comparison.added));
}

// Returns one row of a column, with enough digits to show the last bit.
std::string row_text(const Column& column, std::size_t row) {
  std::string all;
  const auto width = static_cast<std::size_t>(column.width);
  for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
    if (!all.empty()) all += " ";
    if (const auto* numbers = std::get_if<std::vector<double>>(&column.values))
      all += value_text((*numbers)[i]);
    else if (const auto* hashes = std::get_if<std::vector<std::uint64_t>>(&column.values))
      all += formatted("%016" PRIx64, (*hashes)[i]);
    else if (const auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values)) {
      const auto value = static_cast<std::size_t>((*integers)[i]);
      all += value < column.value_names.size() ? column.value_names[value] : std::to_string((*integers)[i]);
    }
  }
  return all;
}

std::string headline_of(const Divergence& found) {
  const std::string time = std::isnan(found.time_s) ? "" : formatted(" (%.6g s)", found.time_s);
  const std::string by =
      std::isnan(found.deviation) ? ", without a finite difference" : formatted(", by %.4g", found.deviation);
  return formatted("first divergent tick %zu%s: ", found.tick, time.c_str()) + found.quantity + by;
}

// Returns the columns at the tick of the first difference, and at the tick before if they were not at rest.
ReportTable values_around(const Divergence& found) {
  ReportTable table{.has_headings = false};
  const std::size_t here = found.first_difference - found.first_row;
  for (std::size_t i = 0; i < found.baseline.size(); ++i) {
    const Column &ours = found.baseline[i], &theirs = found.candidate[i];
    const std::string before = row_text(ours, 0), was = row_text(ours, here), is = row_text(theirs, here);
    std::string label = ours.name + (ours.units == "1" ? "" : " / " + ours.units);
    const auto add = [&](const std::string& what, const std::string& row) {
      table.rows.emplace_back().show("column", label).show("at", what).show("value", row);
      label.clear();
    };
    if (here > 0 && (before != was || was != is)) add("tick " + std::to_string(found.first_row), before);
    if (was == is)
      add("tick " + std::to_string(found.first_difference), was);
    else
      add("  baseline", was), add("  candidate", is);
  }
  return table;
}

Report report_of(const Divergence& found) {
  Report report;
  report.line(found.first_difference == found.tick
                  ? "  at the first divergent tick:"
                  : "  the runs first differ at tick " + std::to_string(found.first_difference) +
                        ", within the tolerances; the lines below describe that tick");
  report.line(std::string("  cause   ") + name_of(found.cause) + ": " + found.explanation);
  if (found.cause != found.situation)
    report.line(std::string("  there   ") + name_of(found.situation) + ": " + found.observation);
  report.line("  frames  " + found.frame);
  report.add(values_around(found));
  report.tell("tick", found.tick), report.tell("time_s", found.time_s);
  report.tell("quantity", found.quantity), report.tell("deviation", found.deviation);
  report.tell("first_difference", found.first_difference);
  report.tell("cause", name_of(found.cause)), report.tell("explanation", found.explanation);
  report.tell("situation", name_of(found.situation)), report.tell("observation", found.observation);
  report.tell("frame", found.frame), report.tell("rows_from_tick", found.first_row);
  report.add("baseline", rows_of(found.baseline)), report.add("candidate", rows_of(found.candidate));
  return report;
}

// --- measures ---

const char* word_for(Judgement judgement) {
  constexpr const char* kWords[] = {"equal", "within the margin", "better", "WORSE", "changed", "undecided"};
  return kWords[static_cast<int>(judgement)];
}

// An undecided measure is an error only if the whole comparison could not decide either.
CaseState state_of(Judgement judgement, Outcome whole) {
  if (judgement == Judgement::equal || judgement == Judgement::within_margin) return CaseState::passed;
  if (judgement == Judgement::worse) return CaseState::failed;
  return judgement == Judgement::undecided && whole == Outcome::not_comparable ? CaseState::error
                                                                               : CaseState::skipped;
}

template <class Measure>
ReportCase case_of(const Measure& measure, Judgement judgement, Outcome whole, const std::string& numbers) {
  return {measure.name, state_of(judgement, whole),
          numbers + ": " + name_of(judgement) + " (" + text_of(measure.better) + ")"};
}

// "changed", "WORSE (smaller is better)"
std::string verdict_text(const ValueComparison& measure) {
  std::string verdict = word_for(measure.judgement);
  if (measure.judgement == Judgement::better || measure.judgement == Judgement::worse)
    verdict += std::string(" (") + text_of(measure.better) + ")";
  return verdict;
}

ReportRow row_of(const ValueComparison& measure, Outcome whole) {
  const auto text = [](const char* format, double value, const char* none) {
    return std::isnan(value) ? none : formatted(format, value);
  };
  const double difference = measure.candidate - measure.baseline;
  ReportRow row{
      .is_shown = measure.judgement != Judgement::equal,
      .result = case_of(measure, measure.judgement, whole,
                        shortest_text(measure.baseline) + " against " + shortest_text(measure.candidate))};
  row.add("name", "measure", measure.name).add("units", "units", measure.units);
  row.tell("direction", text_of(measure.better));
  row.tell("absolute_tolerance", measure.tolerance.absolute);
  row.tell("relative_tolerance", measure.tolerance.relative);
  row.add("baseline", "baseline", measure.baseline, text("%.7g", measure.baseline, kNoValueText));
  row.add("candidate", "candidate", measure.candidate, text("%.7g", measure.candidate, kNoValueText));
  row.tell("judgement", name_of(measure.judgement));
  row.show("difference", text("%+.3g", difference, "-"), difference).show("verdict", verdict_text(measure));
  return row;
}

// Adds the measures of two traces that differ.
void add_measures(const ResultComparison& comparison, Report& report) {
  ReportTable table{"measures"};
  for (const ValueComparison& measure : comparison.measures)
    table.rows.push_back(row_of(measure, comparison.outcome));
  report.add(table);
  report.tell("no_measures", comparison.no_measures), report.tell("not_judged", comparison.not_judged);
  if (table.rows.empty()) return;
  report.line(formatted("  %td of %zu measures are equal",
                        std::ranges::count(table.rows, false, &ReportRow::is_shown), table.rows.size()));
  if (!comparison.not_judged.empty()) report.line("  " + comparison.not_judged);
  std::vector<std::string> left_out;
  for (const Measure& measure : measures())
    if (needs_true_contact(measure)) left_out.push_back(measure.name);
  report.line("  not compared, since traces do not store what they need (compare sweeps): " +
              joined(left_out, ", "));
}

// --- sweeps ---

// "equal", "WORSE (smaller is better): 3 runs better, 40 worse, 2 not judged (another outcome, or NaN)"
std::string verdict_text(const MeasureComparison& measure, Judgement judgement) {
  std::string all = word_for(judgement);
  if (judgement != Judgement::equal) all += std::string(" (") + text_of(measure.better) + ")";
  if (measure.outside == 0 || measure.better == Better::neither) return all;
  all += ": " + std::to_string(measure.got_better) + " runs better, " + std::to_string(measure.got_worse) +
         " worse";
  const std::int64_t others = measure.outside - measure.got_better - measure.got_worse;
  return others == 0 ? all : all + ", " + std::to_string(others) + " not judged (another outcome, or NaN)";
}

ReportRow row_of(const MeasureComparison& measure, Judgement judgement) {
  ReportRow row;
  row.add("name", "measure", measure.name).add("units", "units", measure.units);
  row.tell("direction", text_of(measure.better)).tell("event", measure.event);
  row.add("runs", "runs", measure.compared);
  row.tell("outside", measure.outside);
  row.tell("got_better", measure.got_better).tell("got_worse", measure.got_worse);
  row.add("max", "max", measure.max_deviation, formatted("%.4g", measure.max_deviation));
  row.add("rms", "rms", measure.rms_deviation, formatted("%.4g", measure.rms_deviation));
  row.show("outside", std::to_string(measure.outside), measure.outside);
  row.show("tolerance", tolerance_text(measure.tolerance)).show("verdict", verdict_text(measure, judgement));
  row.tell("judgement", name_of(judgement));
  return row;
}

// Only programs read the measures of sweeps that cannot be compared.
ReportTable measures_of(const SweepComparison& sweep, const ResultComparison& whole) {
  ReportTable table{"measures"};
  for (std::size_t i = 0; i < sweep.measures.size(); ++i) {
    const MeasureComparison& measure = sweep.measures[i];
    const Judgement judgement = judgement_of(sweep, i, whole.paired);
    ReportRow& row = table.rows.emplace_back(row_of(measure, judgement));
    row.is_shown = sweep.problems.empty();
    if (!row.is_shown) continue;
    row.result =
        case_of(measure, judgement, whole.outcome,
                outside_text(static_cast<std::size_t>(measure.outside),
                             static_cast<std::size_t>(measure.compared), "runs", measure.max_deviation));
  }
  return table;
}

// True if a measure is printed for a region. An event is printed for all regions. Other measures are printed
// for the whole map, and for regions in which they changed.
bool is_reported(const SweepComparison& sweep, std::size_t region, std::size_t measure) {
  return region == 0 || sweep.measures[measure].event || is_change(sweep.at(region, measure).judgement);
}

// Returns the smaller p of the tests of a region, as it is and adjusted, with its test. Skewed tests do not
// count.
std::string p_text(const RegionComparison& region, bool is_event) {
  const Estimate* least = nullptr;
  for (const Estimate* const test : {&region.difference, &region.mean})
    if (!std::isnan(test->p) && !test->is_skewed && (!least || test->p < least->p)) least = test;
  if (!least) return region.difference.is_skewed || region.mean.is_skewed ? kSkewedNote : "no p";
  const std::string name = least->method == "Tango, sign test" ? "sign test" : least->method;
  const char* const of = is_event ? "" : least == &region.mean ? " of the mean" : " of the shares";
  return formatted("p %.3g, adjusted %.3g (%s%s)", least->p, region.adjusted_p, name.c_str(), of);
}

// "0.500 (0.400 to 0.600)", "0.500 (exact)"
std::string with_interval(const char* format, const Estimate& e) {
  if (std::isnan(e.value)) return "-";
  const std::string value = formatted(format, e.value);
  if (e.method == kExactMethod) return value + " (exact)";
  if (std::isnan(e.low + e.high)) return value;
  return value + " (" + formatted(format, e.low) + " to " + formatted(format, e.high) + ")";
}

std::string runs_text(const RegionComparison& region) {
  const auto runs = static_cast<long long>(region.runs), clusters = static_cast<long long>(region.clusters);
  std::string all = clusters == runs ? formatted("%lld runs", runs)
                                     : formatted("%lld clusters of %lld runs", clusters, runs);
  if (region.pairs < region.runs)
    all += formatted(", %lld unknown", static_cast<long long>(region.runs - region.pairs));
  return all;
}

// Returns shares with their intervals, the flips both ways, and the result of the paired test.
ReportRow row_of(const SweepComparison& sweep, const RegionComparison& region) {
  const MeasureComparison& measure = sweep.measures[region.measure];
  const std::string& label = sweep.regions[region.region].label;
  const Estimate& d = region.difference;
  ReportRow row{.is_shown = sweep.first && sweep.problems.empty() && measure.outside > 0 &&
                            is_reported(sweep, region.region, region.measure)};
  row.show("runs", runs_text(region), region.runs);
  row.show("values", measure.event ? with_interval("%.3f", region.baseline_fraction) + "  " +
                                         with_interval("%.3f", region.candidate_fraction)
                                   : with_interval("%.4g", region.mean));
  row.show("more / less", std::to_string(region.up) + " / " + std::to_string(region.down));
  row.show("interval",
           std::isnan(d.low + d.high) ? "no interval" : formatted("%+.4f to %+.4f", d.low, d.high));
  row.show("p", p_text(region, measure.event)).show("verdict", word_for(region.judgement));
  row.add("region", "region", label).tell("measure", measure.name);
  row.tell("runs", region.runs).tell("pairs", region.pairs).tell("clusters", region.tested);
  row.tell("outside", region.outside).tell("up", region.up).tell("down", region.down);
  row.tell("got_better", region.got_better).tell("got_worse", region.got_worse);
  row.tell("difference", interval(region.difference));
  row.tell("baseline_events", region.baseline_events).tell("candidate_events", region.candidate_events);
  row.tell("baseline_fraction", interval(region.baseline_fraction));
  row.tell("candidate_fraction", interval(region.candidate_fraction));
  row.tell("unpaired", region.unpaired).tell("mean_difference", region.mean.value);
  row.tell("mean_interval", interval(region.mean)).tell("baseline_spread", region.baseline_spread);
  row.tell("mean_p", region.mean.p).tell("p", region.difference.p).tell("adjusted_p", region.adjusted_p);
  row.tell("judgement", name_of(region.judgement));
  return row;
}

// Returns what the table of the regions of a measure shows.
std::string heading_of(const SweepComparison& sweep, const MeasureComparison& measure) {
  return "  " + measure.name +
         " by region: " + (measure.event ? "share of runs before and now" : "mean difference") +
         ", more / less in the candidate, interval of the difference of shares, p, and adjusted for all " +
         std::to_string(sweep.tests) +
         " tests (Holm), with the test; a cluster has the runs that share random numbers";
}

// People read a table for each measure that changed, programs one of all regions.
void add_regions(const SweepComparison& sweep, Report& report) {
  ReportTable all{"regions"};
  for (const RegionComparison& region : sweep.by_region) {
    all.rows.push_back(row_of(sweep, region));
    all.rows.back().is_shown = false;
  }
  report.add(all);
  if (!sweep.first || !sweep.problems.empty()) return;
  for (std::size_t m = 0; m < sweep.measures.size(); ++m) {
    if (sweep.measures[m].outside == 0) continue;
    report.line(heading_of(sweep, sweep.measures[m]));
    ReportTable table{.indent = "    ", .has_headings = false};
    for (std::size_t r = 0; r < sweep.regions.size(); ++r)
      if (is_reported(sweep, r, m)) table.rows.push_back(row_of(sweep, sweep.at(r, m)));
    report.add(table);
  }
  if (sweep.needed_clusters > 0)
    report.line("  " + std::to_string(sweep.tests) + " tests show no direction in a region of fewer than " +
                std::to_string(sweep.needed_clusters) + " independent runs");
}

// The cell of a run: "0,2".
std::string cell_of(const FirstDifference& first) {
  std::string cell;
  for (const std::size_t index : first.axis_indices)
    cell.append(cell.empty() ? "" : ",").append(std::to_string(index));
  return cell;
}

void add_headline(const FirstDifference& first, Report& report) {
  const std::string cell = cell_of(first), replicate = std::to_string(first.replicate);
  std::string text = "first run that differs: cell " + cell + ", replicate " + replicate;
  if (!first.measure.empty())
    text +=
        ", " + first.measure + " " + value_text(first.baseline) + " against " + value_text(first.candidate);
  report.line(text);
  report.line("see it: remote-touch replay FILE --cell " + cell + " --replicate " + replicate +
              " -o trace.h5, of both, then compare");
}

Report report_of(const FirstDifference& first) {
  Report report;
  report.tell("cell", list_of(first.axis_indices)), report.tell("replicate", first.replicate);
  report.tell("measure", first.measure);
  report.tell("baseline", first.baseline), report.tell("candidate", first.candidate);
  return report;
}

void add_sweep(const ResultComparison& comparison, Report& report) {
  const SweepComparison& sweep = *comparison.sweep;
  for (const auto* const lines : {&sweep.problems, &sweep.notes})
    for (const std::string& line : *lines) report.line("  " + line);
  Report details;
  details.tell("problems", list_of(sweep.problems)), details.tell("notes", list_of(sweep.notes));
  details.tell("runs", sweep.done_in_both);
  details.tell("done_in_baseline_only", sweep.baseline_only.size());
  details.tell("done_in_candidate_only", sweep.candidate_only.size());
  details.tell("newly_failed", sweep.newly_failed), details.tell("tests", sweep.tests);
  details.add(measures_of(sweep, comparison));
  if (sweep.first) details.add("first_difference", report_of(*sweep.first));
  add_regions(sweep, details);
  report.add("sweep", details);
}

// --- the headline ---

// Returns one act of the story: "the candidate first touches at 0.434 s, the baseline does not". Empty if
// the two runs do not differ in it, or if it is not known whether one does it.
std::string act_of(const ValueComparison& time_s, const std::string& what, bool is_known) {
  const auto at = [](double time) { return formatted(" at %.6g s", time); };
  const bool has_first = std::isfinite(time_s.baseline), has_second = std::isfinite(time_s.candidate);
  if (has_first && has_second && time_s.baseline != time_s.candidate)
    return "the baseline " + what + at(time_s.baseline) + ", the candidate" + at(time_s.candidate);
  if (!is_known || has_first == has_second) return {};
  return has_first ? "the baseline " + what + at(time_s.baseline) + ", the candidate does not"
                   : "the candidate " + what + at(time_s.candidate) + ", the baseline does not";
}

// Returns in one line what happens in only one of two runs, or at another time; else how far their proxies
// are apart. Empty if neither is so.
std::string story_of(const ResultComparison& comparison) {
  const std::vector<ValueComparison>& measures = comparison.measures;
  const auto is_unknown = [](const ValueComparison& measure) {
    return measure.name.ends_with("popped_through") &&
           (std::isnan(measure.baseline) || std::isnan(measure.candidate));
  };
  const bool is_known = std::none_of(measures.begin(), measures.end(), is_unknown);
  for (const bool passes : {true, false})
    for (const ValueComparison& measure : measures) {
      if (measure.judgement == Judgement::equal) continue;
      if (measure.name != (passes ? "first_pop_through_time" : "first_contact_time")) continue;
      const std::string act = passes ? act_of(measure, "passes through the surface", is_known)
                                     : act_of(measure, "first touches", true);
      if (!act.empty()) return act;
    }
  // Proxies of one tick are compared, which is of interest only if its time is the same in both runs.
  const ColumnComparison *time = nullptr, *proxy = nullptr;
  for (const ColumnComparison& column : comparison.columns->columns)
    if (column.name == "time")
      time = &column;
    else if (column.name == "proxy_position" && column.problem.empty() && column.not_numbers == 0)
      proxy = &column;
  if (!time || !time->is_same() || !proxy || proxy->is_same()) return {};
  return formatted("the proxies are at most %.4g mm apart", 1e3 * proxy->max);
}

// Adds the verdict, the first difference, and what happens in only one of two runs.
void add_headline(const ResultComparison& comparison, Report& report) {
  constexpr const char* kWords[] = {"same", "REGRESSED", "COULD NOT COMPARE", "", "CHANGED"};
  report.line(kWords[static_cast<std::size_t>(comparison.outcome)] + std::string(": ") + comparison.verdict);
  if (comparison.columns && comparison.columns->divergence) {
    report.line(headline_of(*comparison.columns->divergence));
    report.line(story_of(comparison));
  }
  if (comparison.sweep && comparison.sweep->first && comparison.sweep->problems.empty())
    add_headline(*comparison.sweep->first, report);
}

// Adds the two files; the baseline is first in the lines below, too: "seed 1 against 7".
void add_files(const ResultComparison& comparison, Report& report) {
  report.line(comparison.kind + ": baseline " + printable(comparison.baseline) + " against candidate " +
              printable(comparison.candidate));
  report.tell("baseline", comparison.baseline), report.tell("candidate", comparison.candidate);
  report.tell("kind", comparison.kind), report.tell("outcome", name_of(comparison.outcome));
  report.tell("verdict", comparison.verdict);
  report.tell("configuration", list_of(comparison.configuration));
  report.tell("provenance", list_of(comparison.provenance));
  for (const std::string& line : comparison.configuration) report.line("  configuration: " + line);
  for (const std::string& line : comparison.provenance) report.line("  provenance: " + line);
}

Report report_of(const HashComparison& hashes) {
  Report report;
  report.tell("compared", hashes.compared), report.tell("same_up_to_tick", hashes.same);
  report.tell("different_at_tick", hashes.different);
  return report;
}

}  // namespace

Report report_of(const ResultComparison& comparison) {
  constexpr CaseState kStates[] = {
      CaseState::passed, CaseState::failed, CaseState::error, {}, CaseState::skipped};
  Report report;
  add_headline(comparison, report);
  add_files(comparison, report);
  if (comparison.columns) {
    add_columns(*comparison.columns, report);
    if (const auto& divergence = comparison.columns->divergence)
      report.add("divergence", report_of(*divergence));
    else
      report.tell("divergence", {});
  }
  add_measures(comparison, report);
  if (comparison.sweep) add_sweep(comparison, report);
  if (comparison.hashes) report.add("hashes", report_of(*comparison.hashes));
  report.add(
      ReportCase{comparison.kind, kStates[static_cast<std::size_t>(comparison.outcome)], comparison.verdict});
  return report;
}

}  // namespace remote_touch
