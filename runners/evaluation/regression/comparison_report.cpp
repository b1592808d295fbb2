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

// A report whose JSON is not yet text.
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

// "2 of 867 rows outside, the largest deviation 0.25"; empty for none.
std::string outside_text(std::size_t outside, std::size_t of, const char* things, double max) {
  if (outside == 0) return {};
  return formatted("%zu of %zu %s outside, the largest deviation %.6g", outside, of, things, max);
}

// --- columns ---

std::string line_of(const ColumnComparison& column) {
  const double percent =
      column.rows == 0 ? 0 : 100.0 * static_cast<double>(column.outside) / static_cast<double>(column.rows);
  std::string line =
      formatted("  %-28s %-6s %9zu %12.4g %12.4g %8.3g%%  %s", column.name.c_str(), column.units.c_str(),
                column.rows, column.max, column.rms, percent, tolerance_text(column.tolerance).c_str());
  if (column.not_numbers > 0) line += formatted("; %zu rows: NaN against a number", column.not_numbers);
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

void add_columns(const TraceComparison& comparison, DraftReport& report) {
  report.text += formatted("  %-28s %-6s %9s %12s %12s %9s  %s\n", "column", "units", "rows", "max", "rms",
                           "outside", "tolerance");
  for (const ColumnComparison& column : comparison.columns) {
    report.text += line_of(column);
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
      all += shortest_text((*numbers)[i]);
    else if (const auto* hashes = std::get_if<std::vector<std::uint64_t>>(&column.values))
      all += formatted("%016" PRIx64, (*hashes)[i]);
    else if (const auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values)) {
      const auto value = static_cast<std::size_t>((*integers)[i]);
      all += value < column.value_names.size() ? column.value_names[value] : std::to_string((*integers)[i]);
    }
  }
  return all;
}

std::string divergence_text(const Divergence& found) {
  const std::string time = std::isnan(found.time_s) ? "" : formatted(" (%.6g s)", found.time_s);
  std::string all = formatted("first divergent tick %zu%s: %s, by %.4g\n", found.tick, time.c_str(),
                              found.quantity.c_str(), found.deviation);
  if (found.first_difference != found.tick)
    all += "  the runs first differ at tick " + std::to_string(found.first_difference) +
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

// Adds the measures of two traces that differ; the text has those that are not equal.
void add_measures(const ResultComparison& comparison, DraftReport& report) {
  const std::vector<ValueComparison>& measures = comparison.measures;
  std::size_t equal = 0;
  if (!measures.empty())
    report.text += formatted("  %-23s %-6s %13s %13s %11s  %s\n", "measure", "units", "baseline", "candidate",
                             "difference", "verdict");
  for (const ValueComparison& measure : measures) {
    report.json["measures"].push_back(measure_json(measure));
    report.cases.push_back(
        case_of(measure, measure.judgement, comparison.outcome,
                shortest_text(measure.baseline) + " against " + shortest_text(measure.candidate)));
    if (measure.judgement == Judgement::equal)
      ++equal;
    else
      report.text += formatted("  %-23s %-6s %13.7g %13.7g %+11.3g  %s (%s)\n", measure.name.c_str(),
                               measure.units.c_str(), measure.baseline, measure.candidate,
                               measure.candidate - measure.baseline, word_for(measure.judgement),
                               text_of(measure.better));
  }
  report.json["no_measures"] = comparison.no_measures, report.json["not_judged"] = comparison.not_judged;
  if (measures.empty()) return;
  report.text += formatted("  %zu of %zu measures are equal\n", equal, measures.size());
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
  if (is_compared)
    report.text += formatted("  %-22s %-6s %9s %12s %12s %9s  %-15s %s\n", "measure", "units", "runs", "max",
                             "rms", "outside", "tolerance", "verdict");
  for (std::size_t i = 0; i < sweep.measures.size(); ++i) {
    const MeasureComparison& measure = sweep.measures[i];
    const Judgement judgement = judgement_of(sweep, i, comparison.paired);
    json["measures"].push_back(measure_json(measure, judgement));
    if (!is_compared) continue;
    const auto runs = static_cast<std::size_t>(measure.compared),
               outside = static_cast<std::size_t>(measure.outside);
    report.text +=
        formatted("  %-22s %-6s %9zu %12.4g %12.4g %9zu  %-15s %s\n", measure.name.c_str(),
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

std::string text_of(const FirstDifference& first) {
  std::string cell;
  for (const std::size_t index : first.axis_indices)
    cell.append(cell.empty() ? "" : ",").append(std::to_string(index));
  const std::string replicate = std::to_string(first.replicate);
  std::string text = "  first run that differs: cell " + cell + ", replicate " + replicate;
  if (!first.measure.empty())
    text += ", " + first.measure + " " + shortest_text(first.baseline) + " against " +
            shortest_text(first.candidate);
  return text + "\n  see it: remote-touch replay FILE --cell " + cell + " --replicate " + replicate +
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
  if (sweep.first && sweep.problems.empty()) report.text += regions_text(sweep) + text_of(*sweep.first);
}

}  // namespace

ComparisonReport report_of(const ResultComparison& comparison) {
  constexpr const char* kWords[] = {"same", "REGRESSED", "COULD NOT COMPARE", "", "CHANGED"};
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
  report.text += std::string(kWords[outcome]) + ": " + comparison.verdict + "\n";
  report.cases.push_back({comparison.kind, kStates[outcome], comparison.verdict});
  return {report.text, report.json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n", report.cases};
}

}  // namespace remote_touch
