#include "runners/evaluation/scorecard/report_json.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runners/evaluation/scorecard/card_summaries.h"
#include "runners/evaluation/scorecard/evaluation.h"

namespace remote_touch {

namespace {

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

}  // namespace

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
