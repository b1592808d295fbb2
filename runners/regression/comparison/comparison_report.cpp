#include "runners/regression/comparison/comparison_report.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "analysis/storage/atomic_file.h"
#include "runners/regression/comparison/comparison_text.h"
#include "runners/settings/json_parameters.h"

namespace remote_touch {

namespace {

template <class Number>
Json optional_json(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

Json interval(const std::pair<double, double>& ends) {
  return {ends.first, ends.second};
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

// Row after row, as lists; names of an enumeration in place of those numbers that have one.
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

const char* name_of(Judgement judgement) {
  constexpr const char* kNames[] = {"equal", "within_margin", "changed", "undecided"};
  return kNames[static_cast<int>(judgement)];
}

Json region_json(const SweepComparison& sweep, const RegionComparison& region) {
  return {{"region", sweep.regions[region.region].label},
          {"measure", sweep.measures[region.measure].name},
          {"runs", region.runs},
          {"pairs", region.pairs},
          {"outside", region.outside},
          {"up", region.up},
          {"down", region.down},
          {"difference", interval(region.difference)},
          {"baseline_events", region.baseline_events},
          {"candidate_events", region.candidate_events},
          {"baseline_fraction", interval(region.baseline_fraction)},
          {"candidate_fraction", interval(region.candidate_fraction)},
          {"unpaired", region.unpaired},
          {"mean_difference", region.mean.mean},
          {"mean_interval", interval({region.mean.low, region.mean.high})},
          {"baseline_spread", region.baseline_spread},
          {"symmetry_p", region.symmetry_p},
          {"p", region.sign_p},
          {"adjusted_p", region.adjusted_p},
          {"judgement", name_of(region.judgement)}};
}

Json sweep_json(const SweepComparison& sweep) {
  Json json = {{"problems", sweep.problems}, {"notes", sweep.notes}, {"runs", sweep.done_in_both}};
  json["done_in_baseline_only"] = sweep.baseline_only.size();
  json["done_in_candidate_only"] = sweep.candidate_only.size();
  for (const MeasureComparison& measure : sweep.measures)
    json["measures"].push_back({{"name", measure.name},
                                {"units", measure.units},
                                {"event", measure.event},
                                {"runs", measure.compared},
                                {"outside", measure.outside},
                                {"max", measure.max_deviation},
                                {"rms", measure.rms_deviation}});
  if (sweep.first)
    json["first_difference"] = {{"cell", sweep.first->place},
                                {"replicate", sweep.first->replicate},
                                {"measure", sweep.first->measure},
                                {"baseline", sweep.first->baseline},
                                {"candidate", sweep.first->candidate}};
  for (const RegionComparison& region : sweep.by_region)
    json["regions"].push_back(region_json(sweep, region));
  return json;
}

Json json_of(const ResultComparison& comparison) {
  constexpr const char* kOutcomes[] = {"same", "regressed", "not_comparable"};
  Json json = {{"baseline", comparison.baseline},
               {"candidate", comparison.candidate},
               {"kind", comparison.kind},
               {"outcome", kOutcomes[static_cast<int>(comparison.outcome)]},
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
  if (comparison.sweep) json["sweep"] = sweep_json(*comparison.sweep);
  if (comparison.hashes)
    json["hashes"] = {{"compared", comparison.hashes->compared},
                      {"same_up_to_tick", optional_json(comparison.hashes->same)},
                      {"different_at_tick", optional_json(comparison.hashes->different)}};
  return json;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        // Control characters XML does not have; what is not ASCII may not be UTF-8.
        safe += static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e ? '?' : c;
    }
  }
  return safe;
}

std::string case_xml(const ReportSuite& suite, const ReportCase& one) {
  std::string xml =
      "    <testcase classname=\"" + escaped(suite.name) + "\" name=\"" + escaped(one.name) + "\"";
  if (one.state == ReportCase::State::passed) return xml + "/>\n";
  const char* element = one.state == ReportCase::State::failed  ? "failure"
                        : one.state == ReportCase::State::error ? "error"
                                                                : "skipped";
  return xml + "><" + element + " message=\"" + escaped(one.text) + "\"/></testcase>\n";
}

// "2 of 867 rows outside, the largest deviation 0.25"; empty for none.
std::string outside_text(std::int64_t outside, std::int64_t of, const char* things, double max) {
  if (outside == 0) return {};
  char text[160];
  std::snprintf(text, sizeof text, "%lld of %lld %s outside, the largest deviation %.6g",
                static_cast<long long>(outside), static_cast<long long>(of), things, max);
  return text;
}

// By the rule that judged the whole.
ReportCase::State state_of(const SweepComparison& sweep, std::size_t measure, bool paired) {
  using State = ReportCase::State;
  if (!paired) return sweep.measures[measure].outside == 0 ? State::passed : State::failed;
  for (std::size_t region = 0; region < sweep.regions.size(); ++region)
    if (sweep.at(region, measure).judgement == Judgement::changed) return State::failed;
  return sweep.at(0, measure).judgement == Judgement::undecided ? State::error : State::passed;
}

std::string count(const ReportSuite& suite, ReportCase::State state) {
  return std::to_string(std::count_if(suite.cases.begin(), suite.cases.end(),
                                      [&](const ReportCase& one) { return one.state == state; }));
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

ReportSuite suite_of(const ResultComparison& comparison, const std::string& name) {
  ReportSuite suite{name};
  using State = ReportCase::State;
  if (comparison.columns)
    for (const ColumnComparison& column : comparison.columns->columns) {
      std::string why = column.problem;
      if (!why.empty() && column.outside > 0) why += "; ";
      why += outside_text(static_cast<std::int64_t>(column.outside), static_cast<std::int64_t>(column.rows),
                          "rows", column.max);
      suite.cases.push_back({column.name, column.is_same() ? State::passed : State::failed, why});
    }
  if (comparison.sweep && comparison.sweep->problems.empty())
    for (std::size_t i = 0; i < comparison.sweep->measures.size(); ++i) {
      const MeasureComparison& measure = comparison.sweep->measures[i];
      suite.cases.push_back({measure.name, state_of(*comparison.sweep, i, comparison.paired),
                             outside_text(measure.outside, measure.compared, "runs", measure.max_deviation)});
    }
  const State whole = comparison.outcome == Outcome::same        ? State::passed
                      : comparison.outcome == Outcome::regressed ? State::failed
                                                                 : State::error;
  suite.cases.push_back({comparison.kind, whole, comparison.verdict});
  return suite;
}

std::string junit(const std::vector<ReportSuite>& suites) {
  using State = ReportCase::State;
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n";
  for (const ReportSuite& suite : suites) {
    xml += "  <testsuite name=\"" + escaped(suite.name) + "\" tests=\"" + std::to_string(suite.cases.size()) +
           "\" failures=\"" + count(suite, State::failed) + "\" errors=\"" + count(suite, State::error) +
           "\" skipped=\"" + count(suite, State::skipped) + "\">\n";
    for (const ReportCase& one : suite.cases) xml += case_xml(suite, one);
    xml += "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

void write_report(const std::filesystem::path& file, const std::string& text) {
  write_file_atomically(file, text.data(), text.size());
}

}  // namespace remote_touch
