// The scores of scenes, and the report of a scorecard as JSON.
#include "runners/evaluation/scorecard/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "scenarios/files/input_files.h"
#include "tests/runners/evaluation/scorecard/example_cards.h"
#include "tests/support/test_files.h"

namespace remote_touch::scorecard_report_test {
namespace {

// A finished sweep over these noise levels with the measure end_distance, whose values are `depth`.
SweepResult sweep_of(const std::vector<double>& depth, const std::vector<double>& noise_m) {
  return made_cards::finished_sweep(noise_m, {{"end_distance", depth, "m"}});
}

const SceneRules kRules = {
    "flat <&>", "a \"plane\"", "held", {{"end_distance", 0}}, {{"end_distance", Better::larger}}};

Scorecard two_scenes() {
  const std::vector<double> noise = {0, 0.005};
  std::vector<double> good(40, 0.005), bad(40, -0.01);
  good[39] = -0.001;
  Scorecard card{{"one", "two"}, {"the first", "the second"}, {}};
  SceneRules rules = kRules;
  rules.old_success = {{"end_distance", -0.005}};
  card.scenes.push_back(score(rules, {sweep_of(good, noise), sweep_of(bad, noise)}, false));
  SceneRules other = kRules;
  other.name = "own-noise";
  card.scenes.push_back(score(other, {sweep_of(good, {1}), sweep_of(good, {1})}, true));
  correct(card);
  return card;
}

ScorecardReport report_of(const Scorecard& card) {
  ScorecardReport report{card, 10, "remote-touch 1", {{"absent", "no <recording>"}}, {}, {}, {}};
  report.failures.assign(2, std::vector<std::optional<FailureTrace>>(2));
  report.failures[0][1] = FailureTrace{1, 3, "traces/x.h5", "remote-touch replay runs/x.h5 --cell 1"};
  report.costs = {{"own-noise", "one", 1e-5, 1e-4}, {"own-noise", "two", 3e-5, std::nan("")}};
  return report;
}

Json json_of(const ScorecardReport& report) {
  return parse_json(to_json(report), "scorecard.json");
}

TEST(Score, CountsSuccessesAndNamesBestAndWorst) {
  const Scorecard card = two_scenes();
  const SceneScore& scene = card.scenes[0];
  EXPECT_EQ(scene.success[0].at_level[0].events, 1);  // twenty equal runs without noise count once
  EXPECT_EQ(scene.success[0].at_level[0].runs, 1);
  EXPECT_EQ(scene.success[0].noise_free->runs, 1);
  EXPECT_EQ(scene.success[0].at_level[1].events, 19);
  EXPECT_EQ(scene.success[0].noisy.events, 19);  // the run without noise is not included
  EXPECT_EQ(scene.success[0].noisy.runs, 20);
  EXPECT_EQ(scene.success[1].noisy.events, 0);
  EXPECT_EQ(scene.old_success[0].noisy.events, 20);
  EXPECT_FALSE(card.scenes[1].success[0].noise_free);
  EXPECT_TRUE(card.scenes[1].old_success.empty());
  EXPECT_EQ(verdict(card, scene), "Best: one. Worst: two.");
  EXPECT_EQ(verdict(card, card.scenes[1]), "No difference between any.");
  EXPECT_TRUE(std::isnan(card.scenes[1].noise_m.at(0)));
}

// A sweep over three noise levels with a second measure, `time`, which is last_s in all runs.
SweepResult timed(const std::vector<double>& depth, double last_s) {
  SweepResult result = sweep_of(depth, {0, 0.001, 0.005});
  result.measures.push_back({"time", "s", "", std::vector<double>(depth.size(), last_s), 1, {}});
  return result;
}

TEST(Score, MeasuresAreJudgedWhereBothSucceeded) {
  // The second method loses the surface in two of three runs, in which it is quiet: 0.1 against 2. It has 2.5
  // in the runs in which both methods hold.
  std::vector<double> upper, at_times;
  for (int i = 0; i < 54; ++i)
    upper.push_back(1 + 0.01 * i), at_times.push_back(i % 3 == 0 ? 1 : -1 - 0.01 * i);
  SweepResult held = timed(upper, 2), lost = timed(at_times, 0.1);
  auto& time = std::get<std::vector<double>>(lost.measures[1].values);
  for (std::size_t i = 0; i < 54; i += 3) time[i] = 2.5;
  SceneRules rules = kRules;
  rules.measures = {{"time", Better::smaller}, {"time", Better::neither}};
  const SceneScore scene = score(rules, {held, lost}, false);
  const Ranking& judged = scene.measures[0].ranking;
  EXPECT_EQ(judged.mean[1].clusters, 12);  // two levels with noise
  EXPECT_EQ(judged.mean[1].value, 2.5);
  EXPECT_EQ(judged.order.front(), 0u);
  EXPECT_TRUE(judged.has_best);
  EXPECT_EQ(scene.measures[0].at_level[1][0].clusters, 6);
  EXPECT_EQ(scene.measures[0].at_level[1][1].clusters, 6);
  EXPECT_EQ(scene.measures[1].ranking.mean[1].clusters, 36);
  time[18] = 0.1, std::get<std::vector<double>>(lost.measures[0].values)[18] = -1;
  EXPECT_FALSE(score(rules, {held, lost}, false).measures[0].ranking.has_best);  // eleven pairs are left
}

// Nine equal runs at three levels: the noise changes nothing, so they are one. If it changes one of them, the
// equal ones are draws of the noise, too.
TEST(Score, EqualRunsAreOneWithoutNoiseOrIfNoiseHasNoEffect) {
  const SweepResult same = sweep_of(std::vector<double>(9, 1), {0, 0.001, 0.005});
  SweepResult one_lost = same;
  std::get<std::vector<double>>(one_lost.measures[0].values)[8] = -1;
  const SceneScore scene = score(kRules, {same, one_lost}, false);
  for (const Proportion& level : scene.success[0].at_level) EXPECT_EQ(level.runs, 1);
  EXPECT_EQ(scene.success[0].noisy.runs, 1);
  EXPECT_EQ(scene.success[1].at_level[0].runs, 1);
  EXPECT_EQ(scene.success[1].at_level[1].runs, 3);
  EXPECT_EQ(scene.success[1].noisy.runs, 6);
  EXPECT_EQ(scene.measures[0].at_level[0][0].clusters, 1);
  const SweepResult own = sweep_of(std::vector<double>(9, 1), {1});
  EXPECT_EQ(score(kRules, {own}, true).success[0].noisy.runs, 1);
  SweepResult differ = same;
  std::get<std::vector<double>>(differ.measures[0].values)[2] = 1 + 1e-15;
  EXPECT_EQ(score(kRules, {differ}, false).success[0].at_level[0].runs, 3);
}

TEST(ScorecardFigure, HasARowForEverySceneMethodAndLevel) {
  const Figure figure = scorecard_figure(two_scenes());
  ASSERT_EQ(figure.tables.size(), 8u);
  EXPECT_EQ(figure.tables[0].columns[0].length(), 2u * 2 + 2u * 1);
  for (const Table& table : figure.tables)
    for (const Column& column : table.columns)
      EXPECT_EQ(column.length(), table.columns[0].length()) << column.name;
  EXPECT_EQ(numbers(figure.tables[0], "fraction")[1], 0.95);
  EXPECT_EQ(figure.panels.size(), 2u);
}

using Facts = std::vector<std::pair<const char*, Json>>;

void expect_facts(const Json& json, const Facts& facts) {
  for (const auto& [pointer, value] : facts)
    EXPECT_EQ(json.at(Json::json_pointer(pointer)), value) << pointer;
}

// Names and titles are stored as they are; the page escapes what it has to. Equal runs have no interval, nor
// has one run; a method that never succeeds has no mean.
TEST(ScorecardReport, HoldsTheFactsOfTheCard) {
  const Scorecard card = two_scenes();
  const std::string text = to_json(report_of(card));
  const Json json = parse_json(text, "scorecard.json");
  const Proportion& noisy = card.scenes[0].success[0].at_level[1];
  const Json noisy_level = {
      {"successes", 19}, {"runs", 20}, {"fraction", 0.95}, {"low", noisy.low}, {"high", noisy.high}};
  const JudgedMeasure& measure = card.scenes[0].measures[0];
  expect_facts(json, {{"/schema", kScorecardSchema},
                      {"/origin", "remote-touch 1"},
                      {"/replicates", 10},
                      {"/seed", 431},
                      {"/last_tuned_seed", 40},
                      {"/min_pairs", 12},
                      {"/least_pairs", 12},
                      {"/significance", 0.05},
                      {"/held_fraction", 0.9},
                      {"/contact_radius_m", 0.005},
                      {"/skipped/0", {{"name", "absent"}, {"why", "no <recording>"}}},
                      {"/behind", nullptr},  // the project's own method is not in it
                      {"/methods/0/name", "one"},
                      {"/methods/0/title", "the first"},
                      {"/methods/0/scenes_held", 2},
                      {"/methods/0/scenes_best", 1},
                      {"/methods/0/scenes_worst", 0},
                      {"/methods/0/success/runs", 2},
                      {"/methods/0/noise_free/mean", 1},
                      {"/methods/0/old_success/mean", 1},
                      {"/methods/1/scenes_worst", 1},
                      {"/scenes/0/name", "flat <&>"},
                      {"/scenes/0/title", "a \"plane\""},
                      {"/scenes/0/success_meaning", "held"},
                      {"/scenes/0/verdict", "Best: one. Worst: two."},
                      {"/scenes/0/noise_sigma_m", {0.0, 0.005}},
                      {"/scenes/0/success/0/levels/0/successes", 1},
                      {"/scenes/0/success/0/levels/0/runs", 1},
                      {"/scenes/0/success/0/levels/1", noisy_level},
                      {"/scenes/0/success/0/overall", noisy_level},
                      {"/scenes/0/success/0/old/overall/successes", 20},
                      {"/scenes/0/success/0/mark", "best"},
                      {"/scenes/0/success/0/failure", nullptr},
                      {"/scenes/0/success/1/levels/1/successes", 0},
                      {"/scenes/0/success/1/mark", "worst"},
                      {"/scenes/0/success/1/failure",
                       {{"level", 1},
                        {"replicate", 3},
                        {"file", "traces/x.h5"},
                        {"command", "remote-touch replay runs/x.h5 --cell 1"}}},
                      {"/scenes/0/measures/0/name", "end_distance"},
                      {"/scenes/0/measures/0/units", "m"},
                      {"/scenes/0/measures/0/better", "larger"},
                      {"/scenes/0/measures/0/methods/0/overall/mean", measure.ranking.mean[0].value},
                      {"/scenes/0/measures/0/methods/0/overall/runs", 19},
                      {"/scenes/0/measures/0/methods/0/levels/1/mean", measure.at_level[0][1].value},
                      {"/scenes/0/measures/0/methods/0/levels/1/low", nullptr},
                      {"/scenes/0/measures/0/methods/0/levels/0/low", nullptr},
                      {"/scenes/0/measures/0/methods/1/levels/1/mean", nullptr},
                      {"/scenes/0/measures/0/methods/1/overall/runs", 0},
                      {"/scenes/1/name", "own-noise"},
                      {"/scenes/1/verdict", "No difference between any."},
                      {"/scenes/1/noise_sigma_m", Json::array({nullptr})},
                      {"/scenes/1/success/0/old", nullptr},
                      {"/scenes/1/success/0/noise_free", nullptr},
                      {"/scenes/1/success/0/mark", "none"}});
  EXPECT_GE(json["tests"], 1);
  EXPECT_NEAR(json["methods"][0]["success"]["mean"].get<double>(), (19. / 20 + 39. / 40) / 2, 1e-15);
  EXPECT_EQ(json["scenes"][0]["success"][0]["noise_free"], json["scenes"][0]["success"][0]["levels"][0]);
  for (const char* part : {"nan", "inf", "NaN", "Infinity"}) EXPECT_FALSE(contains(text, part)) << part;
}

// The list "behind" of the project's own method comes from weaknesses(). A measure that is not judged has no
// mark.
TEST(ScorecardReport, SaysWhereTheOwnMethodIsBehind) {
  Scorecard card = two_scenes();
  card.methods[1] = "tracked-sheet";
  const Json json = json_of(report_of(card));
  EXPECT_EQ(json["behind"]["list"].size(), 2u);
  expect_facts(json, {{"/behind/method", "tracked-sheet"},
                      {"/behind/list/0/scene", "flat <&>"},
                      {"/behind/list/0/what", "success"},
                      {"/behind/list/0/other", "one"},
                      {"/behind/list/0/ahead", 1},
                      {"/behind/list/0/own_mean", 0},
                      {"/behind/list/0/other_mean", 0.95},
                      {"/behind/list/0/significant", true},
                      {"/behind/list/1/what", "success without noise"},
                      {"/behind/list/1/p", nullptr}});
  EXPECT_LT(json["behind"]["list"][0]["p"], 0.05);
  const char* const mark = "/scenes/0/measures/0/methods/0/mark";
  JudgedMeasure& measure = card.scenes[0].measures[0];
  measure.ranking.order = {0, 1}, measure.ranking.ranked = 2, measure.ranking.has_best = true;
  expect_facts(json_of(report_of(card)), {{mark, "best"}});
  measure.better = Better::neither;
  expect_facts(json_of(report_of(card)), {{mark, "none"}});
}

// Method one has a jump below the threshold in 19 of its 20 runs with noise, and method two in none.
TEST(ScorecardReport, HasTheRunsBelowEachThreshold) {
  const std::vector<double> depth(40, 0.005);
  SweepResult quiet = sweep_of(depth, {0, 0.005}), loud = quiet;
  std::vector<double> jump(40, 0.01);
  jump[39] = 0.5;
  quiet.measures.push_back({"max_relative_jump", "1", "", jump, 1, {}});
  loud.measures.push_back({"max_relative_jump", "1", "", std::vector<double>(40, 0.5), 1, {}});
  SceneRules rules = kRules;
  rules.measures = {{"max_relative_jump", Better::neither}};
  ScorecardReport report = report_of(two_scenes());
  EXPECT_EQ(json_of(report)["thresholds"], Json::array());
  report.card.scenes[0] = score(rules, {quiet, loud}, false);
  const Json list = json_of(report)["thresholds"];
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0]["measure"], "max_relative_jump");
  EXPECT_EQ(list[0]["units"], "1");
  EXPECT_EQ(list[0]["threshold"], 0.07);
  EXPECT_HAS(list[0]["source"].get<std::string>(), "1991");
  EXPECT_FALSE(list[0]["meaning"].get<std::string>().empty());
  EXPECT_EQ(
      list[0]["methods"],
      Json::array(
          {{{"scenes", 1}, {"below", 19}, {"runs", 20}, {"noise_free_below", 1}, {"noise_free_runs", 1}},
           {{"scenes", 1}, {"below", 0}, {"runs", 1}, {"noise_free_below", 0}, {"noise_free_runs", 1}}}));
}

TEST(ScorecardReport, AnErrorIsShownAsTheFailureThatItIs) {
  ScorecardReport report = report_of(two_scenes());
  report.failures[0][1] = FailureTrace{1, 3, {}, {}, "cannot <be> run"};
  EXPECT_EQ(json_of(report)["scenes"][0]["success"][1]["failure"],
            Json({{"level", 1}, {"replicate", 3}, {"error", "cannot <be> run"}}));
  report.skipped = {{"absent", "no file a\xff.png"}};
  EXPECT_EQ(json_of(report)["skipped"][0]["why"], "no file a\xEF\xBF\xBD.png");
}

// The energies of three runs at each of two levels: certainly above zero at the first, and on both sides of
// zero at the second.
TEST(ScorecardReport, TheAuditSaysWhereEnergyIsGivenForCertain) {
  SweepResult sweep = sweep_of({1, 1, 1, 1, 1, 1}, {0.001, 0.005});
  sweep.measures.push_back({"energy_injected", "J", "", std::vector<double>{3, 3.3, 3.6, -3, 0, 3}, 1, {}});
  sweep.measures.push_back({"mean_energy_per_update", "J", "", std::vector<double>(6, 0.5), 1, {}});
  SceneRules rules = kRules;
  rules.measures = {{"energy_injected", Better::neither}, {"mean_energy_per_update", Better::neither}};
  ScorecardReport report = report_of(two_scenes());
  EXPECT_EQ(json_of(report)["audit"], nullptr);
  report.audit = Scorecard{{"law"}, {"a law"}, {score(rules, {sweep}, false)}};
  const Json audit = json_of(report)["audit"][0], &law = audit["laws"][0], &levels = law["levels"];
  EXPECT_EQ(audit["noise_sigma_m"], Json({0.001, 0.005}));
  EXPECT_EQ(law["name"], "law");
  EXPECT_EQ(law["title"], "a law");
  EXPECT_EQ(law["overall"]["runs"], 6);
  EXPECT_NEAR(levels[0]["energy_per_cycle_J"]["mean"].get<double>(), 1.1, 1e-12);  // three cycles a run
  EXPECT_EQ(levels[0]["energy_per_update_J"], 0.5);
  EXPECT_EQ(levels[0]["mark"], "given");
  EXPECT_EQ(levels[1]["mark"], "none");
  report.audit->scenes[0].measures.clear();
  EXPECT_EQ(json_of(report)["audit"], nullptr);  // a scene of that name that measures no energy
}

TEST(Costs, UnmeasuredCostsAreNotSorted) {
  ScorecardReport report = report_of(two_scenes());
  const double none = std::nan("");
  report.costs = {{"own-noise", "one", none, none},
                  {"own-noise", "two", 3e-5, 1e-4},
                  {"flat <&>", "one", 1e-5, 1e-4},
                  {"flat <&>", "two", 2e-5, none}};
  report.cpu = "a processor";
  const Json costs = json_of(report)["costs"];
  EXPECT_EQ(costs["methods"][1],
            Json({{"tick_ratio", 2.0}, {"frame_ratio", nullptr}, {"tick_s", 2e-5}, {"frame_s", nullptr}}));
  EXPECT_EQ(costs["reference"], "one");
  EXPECT_EQ(costs["cpu"], "a processor");
  EXPECT_EQ(costs["noise_sigma_m"], 0.003);
  report.costs.clear();
  EXPECT_EQ(json_of(report)["costs"], nullptr);
}

// The error of a run may be one of the machine, such as too little memory, so its cost is measured again.
TEST(Costs, AreReadWhereTheyWereMeasuredByThisBuildAndMachine) {
  const TestFolder folder("costs");
  const TextAttributes here = {{"source_digest", "s"}, {"isa", "i"}, {"cpu", "c"}},
                       other = {{"source_digest", "s"}, {"isa", "i"}, {"cpu", "d"}};
  const double none = std::nan("");
  write_costs(folder / "costs.json", {{"a", "failed", none, none}, {"a", "b", 1e-5, none}}, here);
  const std::vector<Cost> costs = read_costs(folder / "costs.json", here);
  ASSERT_EQ(costs.size(), 1u);
  EXPECT_EQ(costs[0].method, "b");
  EXPECT_EQ(costs[0].tick_s, 1e-5);
  EXPECT_TRUE(std::isnan(costs[0].frame_s));
  EXPECT_TRUE(read_costs(folder / "costs.json", other).empty());
  EXPECT_TRUE(read_costs(folder / "none.json", here).empty());
}

}  // namespace
}  // namespace remote_touch::scorecard_report_test
