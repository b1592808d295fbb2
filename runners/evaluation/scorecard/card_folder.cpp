#include "runners/evaluation/scorecard/evaluation.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/columns.h"
#include "core/parameters/parameter.h"
#include "runners/experiment/settings/json_parameters.h"
#include "runners/experiment/settings/provenance.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {

void make_scorecard_folder(const std::string& folder) {
  for (const char* part : {"runs", "traces"}) make_folder(std::filesystem::path(folder) / part);
  for (const char* file : {kScorecardFile, "scorecard.json", "costs.json"})
    require_writable(std::filesystem::path(folder) / file);
}

void require_all_of(const std::filesystem::path& file, const BenchmarkPlan& plan) {
  std::error_code unreachable;
  if (!std::filesystem::exists(file, unreachable)) return;
  const TextAttributes attributes = Hdf5Reader(file).attributes();
  const Json stored = Json::parse(attribute(attributes, "config"), nullptr,
                                  false);  // a broken text gives no object
  const Json wanted = Json::parse(configuration_of(plan));
  for (const char* kind : {"methods", "scenes"}) {
    if (!stored.is_object() || !stored.contains(kind) || !stored[kind].is_object())
      throw InputError(file.string(), "is not a scorecard and would be overwritten: expected another folder");
    for (const auto& item : stored[kind].items())
      if (!wanted.contains(kind) || !wanted[kind].contains(item.key()))
        throw InputError(file.string(), std::string("has more ") + kind + ", first " + item.key() +
                                            ", and would be replaced: expected those and others too, or "
                                            "another folder");
  }
}

std::string scorecard_command(const std::vector<std::string>& methods, const std::vector<std::string>& scenes,
                              int seeds) {
  std::string command = program_text() + " scorecard";
  for (const std::string& name : methods) command += " " + name;
  if (!scenes.empty()) command += " --scene";
  for (const std::string& name : scenes) command += " " + name;
  return command + " --seeds " + std::to_string(seeds);
}

std::string write_scorecard(const std::filesystem::path& folder, const BenchmarkPlan& plan,
                            const ScorecardReport& report, const std::string& command) {
  std::string digest = write_figure(folder / kScorecardFile, scorecard_figure(report.card),
                                    provenance(configuration_of(plan), command, ""));
  write_file_atomically(folder / "scorecard.json", to_json(report));
  return digest;
}

namespace {

constexpr const char* kMadeBy = "a card that `remote-touch scorecard store` wrote";

// Returns one table of the file with all its columns.
Table table_in(const Hdf5Reader& file, const std::string& name) {
  Table table{name, {}};
  const std::string folder = "/tables/" + name + "/";
  for (const std::string& path : file.datasets()) {
    if (!path.starts_with(folder)) continue;
    table.columns.push_back(file.column(path));
    table.columns.back().name = path.substr(folder.size());
  }
  if (table.columns.empty()) file.damaged("has no table " + name);
  return table;
}

Hdf5Reader stored_card_file(const std::filesystem::path& file) {
  Hdf5Reader hdf5(file);
  hdf5.require_kind("figure", kMadeBy);
  if (attribute(hdf5.attributes(), "figure") != kStoredCardFigure)
    throw InputError(file.string(), std::string("not a stored card: expected ") + kMadeBy);
  return hdf5;
}

// Returns a number with three digits; a dash for NaN.
std::string digits(double value) {
  if (std::isnan(value)) return "-";
  return formatted("%.3g", value);
}

std::string with_unit(double value, const std::string& units) {
  const bool is_length = units == "m";
  return digits(is_length ? 1e3 * value : value) + (units == "1" ? "" : is_length ? " mm" : " " + units);
}

std::string behind_text(const Table& behind, const std::string& own, bool is_significant) {
  std::string rows;
  for (const TableRow& row : rows_by(behind, "scene")) {
    if ((row.count("significant") != 0) != is_significant) continue;
    rows += "| " + row.text("scene") + " | " + row.text("what") + " | " +
            with_unit(row.number("own_mean"), row.text("units")) + " | " +
            with_unit(row.number("other_mean"), row.text("units")) + " (" + row.text("other") + ") | " +
            digits(row.number("p")) + " |\n";
  }
  if (rows.empty()) return "None.\n";
  return "| scene | what | " + own + " | better | p, corrected |\n|---|---|---|---|---|\n" + rows;
}

// A threshold of perception, and the counts of each method as the text of two cells.
struct ThresholdColumns {
  std::string measure, value, meaning, source;
  std::map<std::string, std::string> cells = {};  // the key is the method
};

// Returns the thresholds of a table "thresholds" in its order.
std::vector<ThresholdColumns> threshold_columns(const Table& thresholds) {
  std::vector<ThresholdColumns> list;
  for (const TableRow& row : rows_by(thresholds, "measure")) {
    const auto share = [&](const char* below, const char* runs) {
      const std::int32_t all = row.count(runs);
      return all == 0 ? "-" : std::to_string(row.count(below)) + " of " + std::to_string(all);
    };
    if (list.empty() || list.back().measure != row.text("measure"))
      list.push_back({row.text("measure"), with_unit(row.number("threshold"), row.text("units")),
                      row.text("meaning"), row.text("source")});
    list.back().cells[row.text("method")] =
        share("below", "runs") + " | " + share("noise_free_below", "noise_free_runs") + " |";
  }
  return list;
}

std::string sources_text(const std::vector<ThresholdColumns>& thresholds) {
  std::string text;
  for (const ThresholdColumns& one : thresholds)
    text += "- `" + one.measure + "`: " + one.value + " is " + one.meaning + " (" + one.source + ").\n";
  return text.empty() ? text : "\nThresholds of perception:\n\n" + text;
}

std::string overview_text(const Table& overview, const std::vector<ThresholdColumns>& thresholds) {
  std::string text =
      "| method | successes with noise (95 %) | without noise | by the rule before "
      "| best alone | worst alone |";
  std::string line = "\n|---|---|---|---|---|---|";
  for (const ThresholdColumns& one : thresholds) {
    text += " " + one.measure + " below " + one.value + ", with noise | without |";
    line += "---|---|";
  }
  text += line + "\n";
  std::vector<TableRow> rows = rows_by(overview, "method");
  const auto succeeds_more = [](const TableRow& a, const TableRow& b) {
    return a.number("success") > b.number("success");
  };
  std::stable_sort(rows.begin(), rows.end(), succeeds_more);
  for (const TableRow& row : rows) {
    const auto number = [&](const char* name) { return digits(row.number(name)); };
    text += "| " + row.text("method") + " | " + number("success") + " (" + number("low") + " to " +
            number("high") + ") | " + number("noise_free") + " | " + number("old_success") + " | " +
            std::to_string(row.count("best")) + " | " + std::to_string(row.count("worst")) + " |";
    for (const ThresholdColumns& one : thresholds) {
      const auto found = one.cells.find(row.text("method"));
      text += " " + (found == one.cells.end() ? std::string("- | - |") : found->second);
    }
    text += "\n";
  }
  return text;
}

std::vector<std::string> names_in(const Json& configuration, const char* kind) {
  std::vector<std::string> names;
  for (const auto& item : configuration.at(kind).items()) names.push_back(item.key());
  return names;
}

// Adds a sentence for each method or scene of `now` that the stored card lacks or has in another form.
void compare_definitions(const Json& stored, const Json& now, const char* kind, const char* one,
                         std::vector<std::string>& list) {
  for (const auto& item : now.at(kind).items()) {
    const auto found = stored.at(kind).find(item.key());
    if (found == stored.at(kind).end())
      list.push_back(std::string(one) + " " + item.key() + ": not in the stored card");
    else if (*found != item.value())
      list.push_back(std::string(one) + " " + item.key() + ": defined in another way in the stored card");
  }
}

Json proportion_json(const Proportion& share) {
  return {{"successes", share.events},
          {"runs", share.runs},
          {"fraction", share.fraction},
          {"low", share.low},
          {"high", share.high}};
}

Json mean_json(const Estimate& mean) {
  return {{"runs", mean.clusters}, {"mean", mean.value}, {"low", mean.low}, {"high", mean.high}};
}

const char* mark_word(Mark mark) {
  return mark == Mark::best ? "best" : mark == Mark::worst ? "worst" : "none";
}

const char* better_word(Better better) {
  constexpr const char* kWords[] = {"reported", "smaller", "larger", "near_zero", "not_negative"};
  return kWords[static_cast<int>(better)];
}

Json failure_json(const std::optional<FailureTrace>& failure) {
  if (!failure) return {};
  Json json = {{"level", failure->level}, {"replicate", failure->replicate}};
  if (failure->file.empty())
    json["error"] = failure->error;
  else
    json["file"] = failure->file, json["command"] = failure->command;
  if (!failure->page.empty()) json["page"] = failure->page;
  return json;
}

// Counts of successes by one rule: at each level, over the levels with noise, and without noise.
Json counts_json(const Successes& success) {
  Json levels = Json::array();
  for (const Proportion& level : success.at_level) levels.push_back(proportion_json(level));
  return {{"levels", levels},
          {"overall", proportion_json(success.noisy)},
          {"noise_free", success.noise_free ? proportion_json(*success.noise_free) : Json()}};
}

// Returns for each method its successes by the rule and by the rule before, its mark, and a typical failure.
Json successes_json(const ScorecardReport& report, std::size_t number) {
  const SceneScore& scene = report.card.scenes[number];
  Json methods = Json::array();
  for (std::size_t c = 0; c < report.card.methods.size(); ++c) {
    Json method = counts_json(scene.success[c]);
    method["old"] = scene.old_success.empty() ? Json() : counts_json(scene.old_success[c]);
    method["mark"] = mark_word(mark_of(scene.ranking, c));
    method["failure"] = failure_json(report.failures[number][c]);
    methods.push_back(method);
  }
  return methods;
}

Json measure_json(const JudgedMeasure& measure) {
  const bool is_judged = measure.better != Better::neither;
  Json methods = Json::array();
  for (std::size_t c = 0; c < measure.at_level.size(); ++c) {
    Json levels = Json::array();
    for (const Estimate& level : measure.at_level[c]) levels.push_back(mean_json(level));
    methods.push_back({{"overall", mean_json(measure.ranking.mean[c])},
                       {"mark", mark_word(is_judged ? mark_of(measure.ranking, c) : Mark::none)},
                       {"levels", levels}});
  }
  return {{"name", measure.name},
          {"units", measure.units},
          {"better", better_word(measure.better)},
          {"methods", methods}};
}

Json scene_json(const ScorecardReport& report, std::size_t number) {
  const SceneScore& scene = report.card.scenes[number];
  Json measures = Json::array();
  for (const JudgedMeasure& measure : scene.measures) measures.push_back(measure_json(measure));
  return {{"name", scene.name},
          {"title", scene.title},
          {"success_meaning", scene.meaning},
          {"truth", scene.truth.empty() ? Json() : Json(scene.truth)},
          {"verdict", verdict(report.card, scene)},
          {"noise_sigma_m", scene.noise_m},
          {"success", successes_json(report, number)},
          {"measures", measures}};
}

Json methods_json(const Scorecard& card) {
  const std::vector<MethodSummary> summaries = overview(card);
  Json methods = Json::array();
  for (std::size_t c = 0; c < card.methods.size(); ++c)
    methods.push_back({{"name", card.methods[c]},
                       {"title", card.method_titles[c]},
                       {"scenes_held", summaries[c].held},
                       {"scenes_best", summaries[c].best},
                       {"scenes_worst", summaries[c].worst},
                       {"success", mean_json(summaries[c].success)},
                       {"noise_free", mean_json(summaries[c].noise_free)},
                       {"old_success", mean_json(summaries[c].old_success)}});
  return methods;
}

// Returns the weaknesses of the project's own method; null if the card does not have that method.
Json behind_json(const Scorecard& card) {
  const std::string own = own_method(card.methods);
  if (std::find(card.methods.begin(), card.methods.end(), own) == card.methods.end()) return {};
  Json list = Json::array();
  for (const Weakness& one : weaknesses(card, own))
    list.push_back({{"scene", one.scene},
                    {"what", one.what},
                    {"units", one.units},
                    {"other", one.other},
                    {"ahead", one.ahead},
                    {"own_mean", one.own_mean},
                    {"other_mean", one.other_mean},
                    {"p", one.p},
                    {"significant", one.is_significant}});
  return {{"method", own}, {"list", list}};
}

Json thresholds_json(const Scorecard& card) {
  Json list = Json::array();
  for (const ThresholdSummary& summary : threshold_summary(card)) {
    Json methods = Json::array();
    for (const ThresholdCounts& counts : summary.methods)
      methods.push_back({{"scenes", counts.scenes},
                         {"below", counts.below},
                         {"runs", counts.runs},
                         {"noise_free_below", counts.noise_free_below},
                         {"noise_free_runs", counts.noise_free_runs}});
    const PerceptionThreshold& threshold = summary.threshold;
    list.push_back({{"measure", threshold.measure},
                    {"units", threshold.unit},
                    {"threshold", threshold.value},
                    {"meaning", threshold.meaning},
                    {"source", threshold.source},
                    {"methods", methods}});
  }
  return list;
}

// Returns "given" or "taken" if the interval of the energy excludes zero, else "none".
const char* energy_word(const Estimate& energy) {
  return energy.low > 0 ? "given" : energy.high < 0 ? "taken" : "none";
}

Json audited_scene_json(const Scorecard& audit, const SceneScore& scene,
                        const std::vector<std::vector<EnergySummary>>& all) {
  Json laws = Json::array();
  for (std::size_t c = 0; c < audit.methods.size(); ++c) {
    Json levels = Json::array();
    for (const EnergySummary& energy : all[c])
      levels.push_back({{"energy_per_cycle_J", mean_json(energy.per_cycle_J)},
                        {"energy_per_update_J", energy.per_update_J},
                        {"mark", energy_word(energy.per_cycle_J)}});
    laws.push_back({{"name", audit.methods[c]},
                    {"title", audit.method_titles[c]},
                    {"levels", levels},
                    {"overall", proportion_json(scene.success[c].noisy)},
                    {"noise_free",
                     scene.success[c].noise_free ? proportion_json(*scene.success[c].noise_free) : Json()}});
  }
  return {{"name", scene.name}, {"title", scene.title}, {"noise_sigma_m", scene.noise_m}, {"laws", laws}};
}

Json audit_json(const std::optional<Scorecard>& audit) {
  Json scenes = Json::array();
  if (audit)
    for (const SceneScore& scene : audit->scenes)
      if (const auto all = energies(scene)) scenes.push_back(audited_scene_json(*audit, scene, *all));
  return scenes.empty() ? Json() : scenes;
}

Json costs_json(const ScorecardReport& report) {
  if (report.costs.empty() || report.card.scenes.empty()) return {};
  Json methods = Json::array();
  for (const CostSummary& cost : cost_summary(report.card, report.costs))
    methods.push_back({{"tick_ratio", cost.tick_ratio},
                       {"frame_ratio", cost.frame_ratio},
                       {"tick_s", cost.tick_s},
                       {"frame_s", cost.frame_s}});
  return {{"cpu", report.cpu},
          {"noise_sigma_m", scorecard_noise_m()[kCostLevel]},
          {"reference", cost_reference(report.card)},
          {"methods", methods}};
}

Json skipped_json(const ScorecardReport& report) {
  Json skipped = Json::array();
  for (const auto& [name, why] : report.skipped) skipped.push_back({{"name", name}, {"why", why}});
  return skipped;
}

// Returns the rows of a table as objects, whose keys are the columns.
Json rows_json(const Table& table) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < table.columns.front().length(); ++i) {
    Json& row = rows.emplace_back();
    for (const Column& column : table.columns)
      std::visit([&](const auto& values) { row[column.name] = values.at(i); }, column.values);
  }
  return rows;
}

}  // namespace

std::string configuration_of(const BenchmarkPlan& plan) {
  std::vector<BenchmarkScene> scenes;
  for (const ScenePlan& planned : plan.scenes) scenes.push_back(planned.scene);
  return configuration(plan.benchmark.methods, scenes, plan.benchmark.replicates);
}

std::string write_stored_card(const std::filesystem::path& file, const Scorecard& card,
                              const TextAttributes& provenance) {
  const CardNumbers numbers = numbers_of(card, KeptMeasures::judged);
  return write_figure(file,
                      {kStoredCardFigure,
                       "Stored scorecard",
                       "Successes and means with their intervals, for remote-touch scorecard check.",
                       {overview_table(card), behind_table(card), thresholds_table(card),
                        counts_table(numbers), means_table(numbers)}},
                      provenance);
}

StoredCard read_stored_card(const std::filesystem::path& file) {
  const Hdf5Reader hdf5 = stored_card_file(file);
  StoredCard stored{attribute(hdf5.attributes(), "config"), 0, {}, {}, {}};
  try {
    const Json all = Json::parse(stored.configuration);
    stored.replicates = all.at("replicates").get<int>();
    stored.methods = names_in(all, "methods"), stored.scenes = names_in(all, "scenes");
    stored.numbers = numbers_in(table_in(hdf5, "success"), table_in(hdf5, "measures"));
  } catch (const nlohmann::json::exception&) {
    hdf5.damaged("has no configuration of a scorecard");
  } catch (const std::out_of_range& missing) {
    hdf5.damaged(missing.what());
  }
  return stored;
}

std::string stored_summary(const std::filesystem::path& file) {
  const Hdf5Reader hdf5 = stored_card_file(file);
  try {
    const Table overview = table_in(hdf5, "overview"), behind = table_in(hdf5, "behind");
    std::vector<ThresholdColumns> thresholds;  // cards that earlier versions stored have none
    if (hdf5.has("/tables/thresholds/measure")) thresholds = threshold_columns(table_in(hdf5, "thresholds"));
    const std::string own = own_method(values_of<std::vector<std::string>>(overview, "method"));
    return "Where " + own + " is not the best, by more than chance:\n\n" + behind_text(behind, own, true) +
           "\nWhere others succeed more often, but not by more than chance, or without noise:\n\n" +
           behind_text(behind, own, false) + "\nAll methods, means over " +
           std::to_string(rows_by(overview, "method").at(0).count("scenes")) + " scenes:\n\n" +
           overview_text(overview, thresholds) + sources_text(thresholds);
  } catch (const std::out_of_range& missing) {
    hdf5.damaged(missing.what());
  }
}

std::string stored_json(const std::filesystem::path& file) {
  const StoredCard stored = read_stored_card(file);
  const Hdf5Reader hdf5 = stored_card_file(file);
  Json all = {{"schema", kStoredCardSchema},
              {"replicates", stored.replicates},
              {"seed", kScorecardSeed},
              {"last_tuned_seed", kLastTunedSeed},
              {"min_pairs", kMinPairs},
              {"held_fraction", kHeldFraction},
              {"contact_radius_m", kScorecardRadius_m},
              {"significance", kSignificance},
              {"own_method", own_method(stored.methods)}};
  for (const char* name : {"overview", "behind", "success", "measures"})
    all[name] = rows_json(table_in(hdf5, name));
  // Cards that earlier versions stored have no thresholds.
  const bool has_thresholds = hdf5.has("/tables/thresholds/measure");
  all["thresholds"] = has_thresholds ? rows_json(table_in(hdf5, "thresholds")) : Json::array();
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<std::string> differences(const StoredCard& stored, const BenchmarkPlan& plan,
                                     const Scorecard& now) {
  std::vector<std::string> list;
  const Json then = Json::parse(stored.configuration), here = Json::parse(configuration_of(plan));
  compare_definitions(then, here, "methods", "method", list);
  compare_definitions(then, here, "scenes", "scene", list);
  const std::vector<std::string> numbers = differences(stored.numbers, numbers_of(now, KeptMeasures::judged));
  list.insert(list.end(), numbers.begin(), numbers.end());
  return list;
}

std::string to_json(const ScorecardReport& report) {
  Json scenes = Json::array();
  for (std::size_t i = 0; i < report.card.scenes.size(); ++i) scenes.push_back(scene_json(report, i));
  const Json all = {{"schema", kScorecardSchema},
                    {"origin", report.origin},
                    {"replicates", report.replicates},
                    {"seed", kScorecardSeed},
                    {"last_tuned_seed", kLastTunedSeed},
                    {"min_pairs", kMinPairs},
                    {"tests", report.card.tests},
                    {"least_pairs", report.card.least_pairs},
                    {"held_fraction", kHeldFraction},
                    {"contact_radius_m", kScorecardRadius_m},
                    {"significance", kSignificance},
                    {"methods", methods_json(report.card)},
                    {"thresholds", thresholds_json(report.card)},
                    {"behind", behind_json(report.card)},
                    {"skipped", skipped_json(report)},
                    {"scenes", scenes},
                    {"audit", audit_json(report.audit)},
                    {"costs", costs_json(report)}};
  // NaN is written as null. Messages contain names of files, which can be any bytes. Bytes that are not UTF-8
  // are replaced.
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace remote_touch
