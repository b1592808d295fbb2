#include "runners/evaluation/regression/result_comparison.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/catalog/catalog.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

std::string shortest_text(double number) {
  std::array<char, 40> digits{};
  char* const begin = digits.data();
  return {begin, std::to_chars(begin, begin + digits.size(), number, std::chars_format::general).ptr};
}

namespace {

using CaseState = ReportCase::State;

constexpr const char* kNoValueText = "no value";

// A report whose JSON is not yet text. The text is that of the details, below the verdict.
struct DraftReport {
  std::string text;
  Json json;
  std::vector<ReportCase> cases = {};
};

template <class Number>
Json optional_json(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

Json interval(const Estimate& of) {
  return {of.low, of.high};
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

// Returns the width of a column of a table that has these names.
template <class Named>
int width_of(const std::vector<Named>& all, const std::string& heading) {
  std::size_t width = heading.size();
  for (const Named& each : all) width = std::max(width, each.name.size());
  return static_cast<int>(width);
}

// "2 of 867 rows outside, the largest deviation 0.25"; empty for none.
std::string outside_text(std::size_t outside, std::size_t of, const char* things, double max) {
  if (outside == 0) return {};
  return formatted("%zu of %zu %s outside, the largest deviation %.6g", outside, of, things, max);
}

// --- columns ---

std::string line_of(const ColumnComparison& column, int width) {
  const double percent =
      column.rows == 0 ? 0 : 100.0 * static_cast<double>(column.outside) / static_cast<double>(column.rows);
  std::string line = formatted("  %-*s %-5s %7zu %10.4g %10.4g %7.3g%%  %s", width, column.name.c_str(),
                               column.units.c_str(), column.rows, column.max, column.rms, percent,
                               tolerance_text(column.tolerance).c_str());
  if (column.not_numbers > 0) line += formatted("; %zu rows without a finite difference", column.not_numbers);
  if (!column.problem.empty()) line += "; " + column.problem;
  return line + (column.is_same() ? "\n" : "  DIFFERS\n");
}

ReportCase case_of(const ColumnComparison& column) {
  std::string why = column.problem;
  if (!why.empty() && column.outside > 0) why += "; ";
  why += outside_text(column.outside, column.rows, "rows", column.max);
  return {column.name, column.is_same() ? CaseState::passed : CaseState::skipped, why};
}

Json column_json(const ColumnComparison& column) {
  return {{"name", column.name},
          {"units", column.units},
          {"same", column.is_same()},
          {"problem", column.problem},
          {"absolute_tolerance", column.tolerance.absolute},
          {"relative_tolerance", column.tolerance.relative},
          {"rows", column.rows},
          {"outside", column.outside},
          {"not_numbers", column.not_numbers},
          {"max", column.max},
          {"rms", column.rms},
          {"first_difference", optional_json(column.first_difference)},
          {"first_outside", optional_json(column.first_outside)}};
}

// Returns the columns as lists of their rows. The name of an enumeration replaces each number that has one.
Json rows_json(const std::vector<Column>& columns) {
  Json all = Json::object();
  for (const Column& column : columns) {
    Json values = Json::array();
    if (const auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values);
        integers && !column.value_names.empty()) {
      for (const std::int32_t value : *integers) {
        const auto place = static_cast<std::size_t>(value);
        values.push_back(place < column.value_names.size() ? Json(column.value_names[place]) : Json(value));
      }
    } else {
      std::visit([&](const auto& v) { values = v; }, column.values);
    }
    all[column.name] = values;
  }
  return all;
}

Json divergence_json(const Divergence& found) {
  return {{"tick", found.tick},
          {"time_s", found.time_s},
          {"quantity", found.quantity},
          {"deviation", found.deviation},
          {"first_difference", found.first_difference},
          {"cause", name_of(found.cause)},
          {"explanation", found.explanation},
          {"situation", name_of(found.situation)},
          {"observation", found.observation},
          {"frame", found.frame},
          {"rows_from_tick", found.first_row},
          {"baseline", rows_json(found.baseline)},
          {"candidate", rows_json(found.candidate)}};
}

// Returns the columns with any difference as a table, and the names of the others.
std::string columns_text(const std::vector<ColumnComparison>& columns) {
  const int width = width_of(columns, "column");
  std::string rows;
  std::vector<std::string> equal;
  for (const ColumnComparison& column : columns)
    if (column.is_same() && !column.first_difference)
      equal.push_back(column.name);
    else
      rows += line_of(column, width);
  if (!rows.empty())
    rows.insert(0, formatted("  %-*s %-5s %7s %10s %10s %8s  %s\n", width, "column", "units", "rows", "max",
                             "rms", "outside", "tolerance"));
  if (equal.empty()) return rows;
  return rows + formatted("  %zu of %zu columns are equal: ", equal.size(), columns.size()) +
         joined(equal, ", ") + "\n";
}

void add_columns(const TraceComparison& comparison, DraftReport& report) {
  report.text += columns_text(comparison.columns);
  for (const ColumnComparison& column : comparison.columns) {
    report.json["columns"].push_back(column_json(column));
    report.cases.push_back(case_of(column));
  }
  for (const std::string& name : comparison.added)
    report.text += formatted("  %-28s only in the candidate: not compared\n", name.c_str());
  report.json["columns_only_in_candidate"] = comparison.added;
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
  return formatted("first divergent tick %zu%s: ", found.tick, time.c_str()) + found.quantity + by + "\n";
}

std::string divergence_text(const Divergence& found) {
  std::string all = "  at the first divergent tick:\n";
  if (found.first_difference != found.tick)
    all = "  the runs first differ at tick " + std::to_string(found.first_difference) +
          ", within the tolerances; the lines below describe that tick\n";
  all += std::string("  cause   ") + name_of(found.cause) + ": " + found.explanation + "\n";
  if (found.cause != found.situation)
    all += std::string("  there   ") + name_of(found.situation) + ": " + found.observation + "\n";
  all += "  frames  " + found.frame + "\n";
  const std::size_t here = found.first_difference - found.first_row;
  for (std::size_t i = 0; i < found.baseline.size(); ++i) {
    const Column &ours = found.baseline[i], &theirs = found.candidate[i];
    const std::string before = row_text(ours, 0), was = row_text(ours, here), is = row_text(theirs, here);
    std::string label = ours.name + (ours.units == "1" ? "" : " / " + ours.units);
    const auto add = [&](const std::string& what, const std::string& row) {
      all += formatted("  %-26s %s %s\n", label.c_str(), what.c_str(), row.c_str());
      label.clear();
    };
    // A value at rest is printed once.
    if (here > 0 && (before != was || was != is)) add(formatted("tick %-9zu", found.first_row), before);
    if (was == is)
      add(formatted("tick %-9zu", found.first_difference), was);
    else
      add("  baseline    ", was), add("  candidate   ", is);
  }
  return all;
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

Json measure_json(const ValueComparison& measure) {
  return {{"name", measure.name},
          {"units", measure.units},
          {"direction", text_of(measure.better)},
          {"absolute_tolerance", measure.tolerance.absolute},
          {"relative_tolerance", measure.tolerance.relative},
          {"baseline", measure.baseline},
          {"candidate", measure.candidate},
          {"judgement", name_of(measure.judgement)}};
}

Json measure_json(const MeasureComparison& measure, Judgement judgement) {
  return {{"name", measure.name},
          {"units", measure.units},
          {"direction", text_of(measure.better)},
          {"event", measure.event},
          {"runs", measure.compared},
          {"outside", measure.outside},
          {"got_better", measure.got_better},
          {"got_worse", measure.got_worse},
          {"max", measure.max_deviation},
          {"rms", measure.rms_deviation},
          {"judgement", name_of(judgement)}};
}

// "max_force  N  40.57389  no value  -  changed"
std::string line_of(const ValueComparison& measure, int width) {
  const auto text = [](const char* format, double value, const char* none) {
    return std::isnan(value) ? none : formatted(format, value);
  };
  std::string verdict = word_for(measure.judgement);
  if (measure.judgement == Judgement::better || measure.judgement == Judgement::worse)
    verdict += std::string(" (") + text_of(measure.better) + ")";
  return formatted("  %-*s %-5s %12s %12s %10s  ", width, measure.name.c_str(), measure.units.c_str(),
                   text("%.7g", measure.baseline, kNoValueText).c_str(),
                   text("%.7g", measure.candidate, kNoValueText).c_str(),
                   text("%+.3g", measure.candidate - measure.baseline, "-").c_str()) +
         verdict + "\n";
}

// Returns the measures that are not equal as a table, and the number of the others.
std::string measures_text(const std::vector<ValueComparison>& measures) {
  const int width = width_of(measures, "measure");
  std::string rows;
  std::size_t equal = 0;
  for (const ValueComparison& measure : measures)
    if (measure.judgement == Judgement::equal)
      ++equal;
    else
      rows += line_of(measure, width);
  if (!rows.empty())
    rows.insert(0, formatted("  %-*s %-5s %12s %12s %10s  %s\n", width, "measure", "units", "baseline",
                             "candidate", "difference", "verdict"));
  return rows + formatted("  %zu of %zu measures are equal\n", equal, measures.size());
}

// Adds the measures of two traces that differ.
void add_measures(const ResultComparison& comparison, DraftReport& report) {
  const std::vector<ValueComparison>& measures = comparison.measures;
  for (const ValueComparison& measure : measures) {
    report.json["measures"].push_back(measure_json(measure));
    report.cases.push_back(
        case_of(measure, measure.judgement, comparison.outcome,
                shortest_text(measure.baseline) + " against " + shortest_text(measure.candidate)));
  }
  report.json["no_measures"] = comparison.no_measures, report.json["not_judged"] = comparison.not_judged;
  if (measures.empty()) return;
  report.text += measures_text(measures);
  if (!comparison.not_judged.empty()) report.text += "  " + comparison.not_judged + "\n";
  std::vector<std::string> left_out;
  for (const Measure& measure : remote_touch::measures())
    if (needs_true_contact(measure)) left_out.push_back(measure.name);
  report.text +=
      "  not compared, since traces do not store what they need (compare sweeps): " + joined(left_out, ", ") +
      "\n";
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

void add_measures(const ResultComparison& comparison, Json& json, DraftReport& report) {
  const SweepComparison& sweep = *comparison.sweep;
  const bool is_compared = sweep.problems.empty();
  const int width = width_of(sweep.measures, "measure");
  if (is_compared)
    report.text += formatted("  %-*s %-5s %7s %10s %10s %7s  %-9s %s\n", width, "measure", "units", "runs",
                             "max", "rms", "outside", "tolerance", "verdict");
  for (std::size_t i = 0; i < sweep.measures.size(); ++i) {
    const MeasureComparison& measure = sweep.measures[i];
    const Judgement judgement = judgement_of(sweep, i, comparison.paired);
    json["measures"].push_back(measure_json(measure, judgement));
    if (!is_compared) continue;
    const auto runs = static_cast<std::size_t>(measure.compared),
               outside = static_cast<std::size_t>(measure.outside);
    report.text +=
        formatted("  %-*s %-5s %7zu %10.4g %10.4g %7zu  %-9s %s\n", width, measure.name.c_str(),
                  measure.units.c_str(), runs, measure.max_deviation, measure.rms_deviation, outside,
                  tolerance_text(measure.tolerance).c_str(), verdict_text(measure, judgement).c_str());
    report.cases.push_back(case_of(measure, judgement, comparison.outcome,
                                   outside_text(outside, runs, "runs", measure.max_deviation)));
  }
}

Json region_json(const SweepComparison& sweep, const RegionComparison& region) {
  return {{"region", sweep.regions[region.region].label},
          {"measure", sweep.measures[region.measure].name},
          {"runs", region.runs},
          {"pairs", region.pairs},
          {"clusters", region.tested},
          {"outside", region.outside},
          {"up", region.up},
          {"down", region.down},
          {"got_better", region.got_better},
          {"got_worse", region.got_worse},
          {"difference", interval(region.difference)},
          {"baseline_events", region.baseline_events},
          {"candidate_events", region.candidate_events},
          {"baseline_fraction", interval(region.baseline_fraction)},
          {"candidate_fraction", interval(region.candidate_fraction)},
          {"unpaired", region.unpaired},
          {"mean_difference", region.mean.value},
          {"mean_interval", interval(region.mean)},
          {"baseline_spread", region.baseline_spread},
          {"mean_p", region.mean.p},
          {"p", region.difference.p},
          {"adjusted_p", region.adjusted_p},
          {"judgement", name_of(region.judgement)}};
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
  std::string all = clusters == runs ? formatted("%6lld runs", runs)
                                     : formatted("%6lld clusters of %lld runs", clusters, runs);
  if (region.pairs < region.runs)
    all += formatted(", %lld unknown", static_cast<long long>(region.runs - region.pairs));
  return all;
}

// Returns shares with their intervals, the flips both ways, and the result of the paired test.
std::string line_of(const SweepComparison& sweep, const RegionComparison& region) {
  const bool event = sweep.measures[region.measure].event;
  const std::string values = event ? with_interval("%.3f", region.baseline_fraction) + "  " +
                                         with_interval("%.3f", region.candidate_fraction)
                                   : with_interval("%.4g", region.mean);
  const Estimate& d = region.difference;
  const std::string interval =
      std::isnan(d.low + d.high) ? "no interval" : formatted("%+.4f to %+.4f", d.low, d.high);
  return "    " + runs_text(region) + "  " + values + "  " + std::to_string(region.up) + " / " +
         std::to_string(region.down) + "  " + interval + "  " + p_text(region, event) + "  " +
         word_for(region.judgement) + "  " + sweep.regions[region.region].label + "\n";
}

std::string regions_text(const SweepComparison& sweep) {
  std::string all;
  const std::string tests = std::to_string(sweep.tests);
  for (std::size_t m = 0; m < sweep.measures.size(); ++m) {
    if (sweep.measures[m].outside == 0) continue;
    all += "  " + sweep.measures[m].name +
           " by region: " + (sweep.measures[m].event ? "share of runs before and now" : "mean difference") +
           ", more / less in the candidate, interval of the difference of shares, p, and adjusted for all " +
           tests + " tests (Holm), with the test; a cluster has the runs that share random numbers\n";
    for (std::size_t r = 0; r < sweep.regions.size(); ++r)
      if (is_reported(sweep, r, m)) all += line_of(sweep, sweep.at(r, m));
  }
  if (sweep.needed_clusters > 0)
    all += "  " + tests + " tests show no direction in a region of fewer than " +
           std::to_string(sweep.needed_clusters) + " independent runs\n";
  return all;
}

std::string headline_of(const FirstDifference& first) {
  std::string cell;
  for (const std::size_t index : first.axis_indices)
    cell.append(cell.empty() ? "" : ",").append(std::to_string(index));
  const std::string replicate = std::to_string(first.replicate);
  std::string text = "first run that differs: cell " + cell + ", replicate " + replicate;
  if (!first.measure.empty())
    text +=
        ", " + first.measure + " " + value_text(first.baseline) + " against " + value_text(first.candidate);
  return text + "\nsee it: remote-touch replay FILE --cell " + cell + " --replicate " + replicate +
         " -o trace.h5, of both, then compare\n";
}

void add_sweep(const ResultComparison& comparison, DraftReport& report) {
  const SweepComparison& sweep = *comparison.sweep;
  for (const auto* const lines : {&sweep.problems, &sweep.notes})
    for (const std::string& line : *lines) report.text += "  " + line + "\n";
  Json json = {{"problems", sweep.problems},
               {"notes", sweep.notes},
               {"runs", sweep.done_in_both},
               {"done_in_baseline_only", sweep.baseline_only.size()},
               {"done_in_candidate_only", sweep.candidate_only.size()},
               {"newly_failed", sweep.newly_failed},
               {"tests", sweep.tests}};
  add_measures(comparison, json, report);
  if (sweep.first)
    json["first_difference"] = {{"cell", sweep.first->axis_indices},
                                {"replicate", sweep.first->replicate},
                                {"measure", sweep.first->measure},
                                {"baseline", sweep.first->baseline},
                                {"candidate", sweep.first->candidate}};
  for (const RegionComparison& region : sweep.by_region)
    json["regions"].push_back(region_json(sweep, region));
  report.json["sweep"] = json;
  if (sweep.first && sweep.problems.empty()) report.text += regions_text(sweep);
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
      if (!act.empty()) return act + "\n";
    }
  // Proxies of one tick are compared, which is of interest only if its time is the same in both runs.
  const ColumnComparison *time = nullptr, *proxy = nullptr;
  for (const ColumnComparison& column : comparison.columns->columns)
    if (column.name == "time")
      time = &column;
    else if (column.name == "proxy_position" && column.problem.empty() && column.not_numbers == 0)
      proxy = &column;
  if (!time || !time->is_same() || !proxy || proxy->is_same()) return {};
  return formatted("the proxies are at most %.4g mm apart\n", 1e3 * proxy->max);
}

// The verdict, the first difference, and what happens in only one of two runs.
std::string headline_of(const ResultComparison& comparison) {
  constexpr const char* kWords[] = {"same", "REGRESSED", "COULD NOT COMPARE", "", "CHANGED"};
  std::string text =
      kWords[static_cast<std::size_t>(comparison.outcome)] + std::string(": ") + comparison.verdict + "\n";
  if (comparison.columns && comparison.columns->divergence)
    text += headline_of(*comparison.columns->divergence) + story_of(comparison);
  if (comparison.sweep && comparison.sweep->first && comparison.sweep->problems.empty())
    text += headline_of(*comparison.sweep->first);
  return text;
}

}  // namespace

ComparisonReport report_of(const ResultComparison& comparison) {
  constexpr CaseState kStates[] = {
      CaseState::passed, CaseState::failed, CaseState::error, {}, CaseState::skipped};
  const auto outcome = static_cast<std::size_t>(comparison.outcome);
  // The lines below state the baseline first, too: "seed 1 against 7".
  DraftReport report{comparison.kind + ": baseline " + comparison.baseline + " against candidate " +
                         comparison.candidate + "\n",
                     {{"baseline", comparison.baseline},
                      {"candidate", comparison.candidate},
                      {"kind", comparison.kind},
                      {"outcome", name_of(comparison.outcome)},
                      {"verdict", comparison.verdict},
                      {"configuration", comparison.configuration},
                      {"provenance", comparison.provenance}}};
  for (const std::string& line : comparison.configuration) report.text += "  configuration: " + line + "\n";
  for (const std::string& line : comparison.provenance) report.text += "  provenance: " + line + "\n";
  if (comparison.columns) {
    add_columns(*comparison.columns, report);
    const auto& divergence = comparison.columns->divergence;
    report.json["divergence"] = divergence ? divergence_json(*divergence) : Json();
    if (divergence) report.text += divergence_text(*divergence);
  }
  add_measures(comparison, report);
  if (comparison.sweep) add_sweep(comparison, report);
  if (comparison.hashes)
    report.json["hashes"] = {{"compared", comparison.hashes->compared},
                             {"same_up_to_tick", optional_json(comparison.hashes->same)},
                             {"different_at_tick", optional_json(comparison.hashes->different)}};
  report.cases.push_back({comparison.kind, kStates[outcome], comparison.verdict});
  return {headline_of(comparison) + report.text,
          report.json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", report.cases};
}

}  // namespace remote_touch
