#include "runners/evaluation/regression/comparison_report.h"

#include <nlohmann/json.hpp>

#include "analysis/storage/atomic_file.h"
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

}  // namespace remote_touch
