#include "runners/evaluation/regression/comparison_report.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cinttypes>
#include <cmath>
#include <nlohmann/json.hpp>

#include "analysis/storage/atomic_file.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/catalog/catalog.h"
#include "runners/experiment/settings/json_parameters.h"

namespace remote_touch {
namespace {

template <class Number>
Json optional_json(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

Json interval(const Estimate& of) {
  return {of.low, of.high};
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

Json sweep_json(const SweepComparison& sweep, bool paired) {
  Json json = {{"problems", sweep.problems}, {"notes", sweep.notes}, {"runs", sweep.done_in_both}};
  json["done_in_baseline_only"] = sweep.baseline_only.size();
  json["done_in_candidate_only"] = sweep.candidate_only.size();
  json["newly_failed"] = sweep.newly_failed, json["tests"] = sweep.tests;
  for (std::size_t i = 0; i < sweep.measures.size(); ++i)
    json["measures"].push_back(measure_json(sweep.measures[i], judgement_of(sweep, i, paired)));
  if (sweep.first)
    json["first_difference"] = {{"cell", sweep.first->axis_indices},
                                {"replicate", sweep.first->replicate},
                                {"measure", sweep.first->measure},
                                {"baseline", sweep.first->baseline},
                                {"candidate", sweep.first->candidate}};
  for (const RegionComparison& region : sweep.by_region)
    json["regions"].push_back(region_json(sweep, region));
  return json;
}

Json json_of(const ResultComparison& comparison) {
  Json json = {{"baseline", comparison.baseline},
               {"candidate", comparison.candidate},
               {"kind", comparison.kind},
               {"outcome", name_of(comparison.outcome)},
               {"verdict", comparison.verdict},
               {"configuration", comparison.configuration},
               {"provenance", comparison.provenance}};
  if (comparison.columns) {
    for (const ColumnComparison& column : comparison.columns->columns)
      json["columns"].push_back(column_json(column));
    json["columns_only_in_candidate"] = comparison.columns->added;
    const auto& divergence = comparison.columns->divergence;
    json["divergence"] = divergence ? divergence_json(*divergence) : Json();
  }
  for (const ValueComparison& measure : comparison.measures)
    json["measures"].push_back(measure_json(measure));
  json["no_measures"] = comparison.no_measures, json["not_judged"] = comparison.not_judged;
  if (comparison.sweep) json["sweep"] = sweep_json(*comparison.sweep, comparison.paired);
  if (comparison.hashes)
    json["hashes"] = {{"compared", comparison.hashes->compared},
                      {"same_up_to_tick", optional_json(comparison.hashes->same)},
                      {"different_at_tick", optional_json(comparison.hashes->different)}};
  return json;
}

}  // namespace

std::string comparison_json(const ResultComparison& comparison) {
  return json_of(comparison).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string comparison_json(const std::vector<ResultComparison>& comparisons) {
  Json list = Json::array();
  for (const ResultComparison& comparison : comparisons) list.push_back(json_of(comparison));
  return list.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_report(const std::filesystem::path& file, const std::string& text) {
  write_file_atomically(file, text.data(), text.size());
}

namespace {

template <class... Values>
std::string text(const char* format, Values... values) {
  char line[256];
  std::snprintf(line, sizeof line, format, values...);
  return line;
}

void print_columns(const TraceComparison& comparison, std::FILE* out) {
  std::fprintf(out, "  %-28s %-6s %9s %12s %12s %9s  %s\n", "column", "units", "rows", "max", "rms",
               "outside", "tolerance");
  for (const ColumnComparison& column : comparison.columns) {
    std::fprintf(out, "  %-28s %-6s %9zu %12.4g %12.4g %8.3g%%  %s", column.name.c_str(),
                 column.units.c_str(), column.rows, column.max, column.rms,
                 column.rows == 0
                     ? 0.0
                     : 100.0 * static_cast<double>(column.outside) / static_cast<double>(column.rows),
                 tolerance_text(column.tolerance).c_str());
    if (column.not_numbers > 0) std::fprintf(out, "; %zu rows: NaN against a number", column.not_numbers);
    if (!column.problem.empty()) std::fprintf(out, "; %s", column.problem.c_str());
    std::fputs(column.is_same() ? "\n" : "  DIFFERS\n", out);
  }
  for (const std::string& name : comparison.added)
    std::fprintf(out, "  %-28s only in the candidate: not compared\n", name.c_str());
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
      all += text("%016" PRIx64, (*hashes)[i]);
    else if (const auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values)) {
      const auto value = static_cast<std::size_t>((*integers)[i]);
      all += value < column.value_names.size() ? column.value_names[value] : std::to_string((*integers)[i]);
    }
  }
  return all;
}

void print_divergence(const Divergence& found, std::FILE* out) {
  const std::string time = std::isnan(found.time_s) ? "" : text(" (%.6g s)", found.time_s);
  std::fprintf(out, "first divergent tick %zu%s: %s, by %.4g\n", found.tick, time.c_str(),
               found.quantity.c_str(), found.deviation);
  if (found.first_difference != found.tick)
    std::fprintf(
        out,
        "  the runs first differ at tick %zu, within the tolerances; the lines below describe that tick\n",
        found.first_difference);
  std::fprintf(out, "  cause   %s: %s\n", name_of(found.cause), found.explanation.c_str());
  if (found.cause != found.situation)
    std::fprintf(out, "  there   %s: %s\n", name_of(found.situation), found.observation.c_str());
  std::fprintf(out, "  frames  %s\n", found.frame.c_str());
  const std::size_t here = found.first_difference - found.first_row;
  for (std::size_t i = 0; i < found.baseline.size(); ++i) {
    const Column &ours = found.baseline[i], &theirs = found.candidate[i];
    const std::string was = row_text(ours, here), is = row_text(theirs, here);
    const std::string name = ours.name + (ours.units == "1" ? "" : " / " + ours.units);
    const std::string before = row_text(ours, 0);
    const bool is_shown = here > 0 && (before != was || was != is);  // a value at rest is printed once
    if (is_shown) std::fprintf(out, "  %-26s tick %-9zu %s\n", name.c_str(), found.first_row, before.c_str());
    const char* label = is_shown ? "" : name.c_str();
    if (was == is) {
      std::fprintf(out, "  %-26s tick %-9zu %s\n", label, found.first_difference, was.c_str());
    } else {
      std::fprintf(out, "  %-26s   baseline     %s\n", label, was.c_str());
      std::fprintf(out, "  %-26s   candidate    %s\n", "", is.c_str());
    }
  }
}

const char* word_for(Judgement judgement) {
  switch (judgement) {
    case Judgement::equal:
      return "equal";
    case Judgement::within_margin:
      return "within the margin";
    case Judgement::better:
      return "better";
    case Judgement::worse:
      return "WORSE";
    case Judgement::changed:
      return "changed";
    case Judgement::undecided:
      break;
  }
  return "undecided";
}

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

void print_measures(const SweepComparison& sweep, bool paired, std::FILE* out) {
  std::fprintf(out, "  %-22s %-6s %9s %12s %12s %9s  %-15s %s\n", "measure", "units", "runs", "max", "rms",
               "outside", "tolerance", "verdict");
  for (std::size_t i = 0; i < sweep.measures.size(); ++i) {
    const MeasureComparison& measure = sweep.measures[i];
    std::fprintf(out, "  %-22s %-6s %9lld %12.4g %12.4g %9lld  %-15s %s\n", measure.name.c_str(),
                 measure.units.c_str(), static_cast<long long>(measure.compared), measure.max_deviation,
                 measure.rms_deviation, static_cast<long long>(measure.outside),
                 tolerance_text(measure.tolerance).c_str(),
                 verdict_text(measure, judgement_of(sweep, i, paired)).c_str());
  }
}

// Prints the measures of two traces that are not equal.
void print_measures(const std::vector<ValueComparison>& measures, const std::string& not_judged,
                    std::FILE* out) {
  if (measures.empty()) return;
  std::size_t equal = 0;
  std::fprintf(out, "  %-23s %-6s %13s %13s %11s  %s\n", "measure", "units", "baseline", "candidate",
               "difference", "verdict");
  for (const ValueComparison& measure : measures)
    if (measure.judgement == Judgement::equal)
      ++equal;
    else
      std::fprintf(out, "  %-23s %-6s %13.7g %13.7g %+11.3g  %s (%s)\n", measure.name.c_str(),
                   measure.units.c_str(), measure.baseline, measure.candidate,
                   measure.candidate - measure.baseline, word_for(measure.judgement),
                   text_of(measure.better));
  std::fprintf(out, "  %zu of %zu measures are equal\n", equal, measures.size());
  if (!not_judged.empty()) std::fprintf(out, "  %s\n", not_judged.c_str());
  std::vector<std::string> left_out;
  for (const Measure& measure : remote_touch::measures())
    if (needs_true_contact(measure)) left_out.push_back(measure.name);
  std::fprintf(out, "  not compared, since traces do not store what they need (compare sweeps): %s\n",
               joined(left_out, ", ").c_str());
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
  return text("p %.3g, adjusted %.3g (%s%s)", least->p, region.adjusted_p, name.c_str(), of);
}

// "0.500 (0.400 to 0.600)", "0.500 (exact)"
std::string with_interval(const char* format, const Estimate& e) {
  if (std::isnan(e.value)) return "-";
  const std::string value = text(format, e.value);
  if (e.method == kExactMethod) return value + " (exact)";
  if (std::isnan(e.low + e.high)) return value;
  return value + " (" + text(format, e.low) + " to " + text(format, e.high) + ")";
}

std::string runs_text(const RegionComparison& region) {
  const auto runs = static_cast<long long>(region.runs), clusters = static_cast<long long>(region.clusters);
  std::string all =
      clusters == runs ? text("%6lld runs", runs) : text("%6lld clusters of %lld runs", clusters, runs);
  if (region.pairs < region.runs)
    all += text(", %lld unknown", static_cast<long long>(region.runs - region.pairs));
  return all;
}

// Prints shares with their intervals, the flips both ways, and the result of the paired test.
void print_regions(const SweepComparison& sweep, std::FILE* out) {
  for (std::size_t m = 0; m < sweep.measures.size(); ++m) {
    if (sweep.measures[m].outside == 0) continue;
    const bool event = sweep.measures[m].event;
    std::fprintf(out,
                 "  %s by region: %s, more / less in the candidate, interval of the difference of shares, p, "
                 "and adjusted for all %lld tests (Holm), with the test; a cluster has the runs that share "
                 "random numbers\n",
                 sweep.measures[m].name.c_str(), event ? "share of runs before and now" : "mean difference",
                 static_cast<long long>(sweep.tests));
    for (std::size_t r = 0; r < sweep.regions.size(); ++r) {
      if (!is_reported(sweep, r, m)) continue;
      const RegionComparison& region = sweep.at(r, m);
      const std::string values = event ? with_interval("%.3f", region.baseline_fraction) + "  " +
                                             with_interval("%.3f", region.candidate_fraction)
                                       : with_interval("%.4g", region.mean);
      const Estimate& d = region.difference;
      const std::string interval =
          std::isnan(d.low + d.high) ? "no interval" : text("%+.4f to %+.4f", d.low, d.high);
      std::fprintf(out, "    %s  %s  %lld / %lld  %s  %s  %s  %s\n", runs_text(region).c_str(),
                   values.c_str(), static_cast<long long>(region.up), static_cast<long long>(region.down),
                   interval.c_str(), p_text(region, event).c_str(), word_for(region.judgement),
                   sweep.regions[r].label.c_str());
    }
  }
  if (sweep.needed_clusters > 0)
    std::fprintf(out, "  %lld tests show no direction in a region of fewer than %lld independent runs\n",
                 static_cast<long long>(sweep.tests), static_cast<long long>(sweep.needed_clusters));
}

void print_sweep(const SweepComparison& sweep, bool paired, std::FILE* out) {
  for (const std::string& problem : sweep.problems) std::fprintf(out, "  %s\n", problem.c_str());
  for (const std::string& note : sweep.notes) std::fprintf(out, "  %s\n", note.c_str());
  if (!sweep.problems.empty()) return;
  print_measures(sweep, paired, out);
  if (!sweep.first) return;
  print_regions(sweep, out);
  std::string cell;
  for (const std::size_t index : sweep.first->axis_indices)
    cell.append(cell.empty() ? "" : ",").append(std::to_string(index));
  std::fprintf(out, "  first run that differs: cell %s, replicate %d", cell.c_str(), sweep.first->replicate);
  if (!sweep.first->measure.empty())
    std::fprintf(out, ", %s %s against %s", sweep.first->measure.c_str(),
                 shortest_text(sweep.first->baseline).c_str(), shortest_text(sweep.first->candidate).c_str());
  std::fprintf(
      out,
      "\n  see it: remote-touch replay FILE --cell %s --replicate %d -o trace.h5, of both, then compare\n",
      cell.c_str(), sweep.first->replicate);
}

}  // namespace

std::string shortest_text(double number) {
  std::array<char, 40> digits{};
  char* const begin = digits.data();
  return {begin, std::to_chars(begin, begin + digits.size(), number, std::chars_format::general).ptr};
}

std::string tolerance_text(const Tolerance& tolerance) {
  if (tolerance.absolute == 0 && tolerance.relative == 0) return "exact";
  std::string all = text("%.3g", tolerance.absolute);
  if (tolerance.relative > 0) all += text(" + %.3g relative", tolerance.relative);
  return all;
}

const char* word_for(Outcome outcome) {
  switch (outcome) {
    case Outcome::same:
      return "same";
    case Outcome::regressed:
      return "REGRESSED";
    case Outcome::changed:
      return "CHANGED";
    case Outcome::not_comparable:
      break;
  }
  return "COULD NOT COMPARE";
}

void print_comparison(const ResultComparison& comparison, std::FILE* out) {
  // The lines below state the baseline first, too: "seed 1 against 7".
  std::fprintf(out, "%s: baseline %s against candidate %s\n", comparison.kind.c_str(),
               comparison.baseline.c_str(), comparison.candidate.c_str());
  for (const std::string& difference : comparison.configuration)
    std::fprintf(out, "  configuration: %s\n", difference.c_str());
  for (const std::string& difference : comparison.provenance)
    std::fprintf(out, "  provenance: %s\n", difference.c_str());
  if (comparison.columns) {
    print_columns(*comparison.columns, out);
    if (comparison.columns->divergence) print_divergence(*comparison.columns->divergence, out);
  }
  print_measures(comparison.measures, comparison.not_judged, out);
  if (comparison.sweep) print_sweep(*comparison.sweep, comparison.paired, out);
  std::fprintf(out, "%s: %s\n", word_for(comparison.outcome), comparison.verdict.c_str());
}

}  // namespace remote_touch
