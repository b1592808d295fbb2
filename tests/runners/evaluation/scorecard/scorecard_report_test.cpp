#include "runners/evaluation/scorecard/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "scenarios/files/input_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::scorecard_report_test {
namespace {

// A finished sweep over these noise levels with the measure end_distance, whose values are `depth`.
SweepResult sweep_of(const std::vector<double>& depth, const std::vector<double>& noise_m) {
  SweepResult result;
  result.axes = {{"noise_sigma_m", "m", "", noise_m, 1, {}}};
  result.replicates = static_cast<int>(depth.size() / noise_m.size());
  result.measures = {{"end_distance", "m", "", {}, 1, {}}};
  result.start(false);
  for (RunState& state : result.state) state = RunState::done;
  result.measures[0].values = depth;
  return result;
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

TEST(ScorecardReport, DescribesItsOrigin) {
  const Json json = json_of(report_of(two_scenes()));
  EXPECT_EQ(json["schema"], kScorecardSchema);
  EXPECT_EQ(json["origin"], "remote-touch 1");
  EXPECT_EQ(json["replicates"], 10);
  EXPECT_EQ(json["seed"], 431);
  EXPECT_EQ(json["last_tuned_seed"], 40);
  EXPECT_EQ(json["min_pairs"], 12);
  EXPECT_EQ(json["least_pairs"], 12);
  EXPECT_GE(json["tests"], 1);
  EXPECT_EQ(json["significance"], 0.05);
  EXPECT_EQ(json["held_fraction"], 0.9);
  EXPECT_EQ(json["contact_radius_m"], 0.005);
  EXPECT_EQ(json["skipped"], Json({{{"name", "absent"}, {"why", "no <recording>"}}}));
  const Json& first = json["methods"][0];
  EXPECT_EQ(first["name"], "one");
  EXPECT_EQ(first["title"], "the first");
  EXPECT_EQ(first["scenes_held"], 2);
  EXPECT_EQ(first["scenes_best"], 1);
  EXPECT_EQ(first["scenes_worst"], 0);
  EXPECT_NEAR(first["success"]["mean"].get<double>(), (19. / 20 + 39. / 40) / 2, 1e-15);
  EXPECT_EQ(first["success"]["runs"], 2);
  EXPECT_EQ(first["noise_free"]["mean"], 1);
  EXPECT_EQ(first["old_success"]["mean"], 1);
  EXPECT_EQ(json["behind"], nullptr);  // the project's own method is not in it
  EXPECT_EQ(json["methods"][1]["scenes_worst"], 1);
}

// Names and titles are stored as they are. The page escapes what it has to.
TEST(ScorecardReport, HasEverySceneWithItsVerdict) {
  const std::string text = to_json(report_of(two_scenes()));
  const Json json = parse_json(text, "scorecard.json"), &first = json["scenes"][0], &own = json["scenes"][1];
  EXPECT_EQ(first["name"], "flat <&>");
  EXPECT_EQ(first["title"], "a \"plane\"");
  EXPECT_EQ(first["success_meaning"], "held");
  EXPECT_EQ(first["verdict"], "Best: one. Worst: two.");
  EXPECT_EQ(first["noise_sigma_m"], Json({0.0, 0.005}));
  EXPECT_EQ(own["name"], "own-noise");
  EXPECT_EQ(own["verdict"], "No difference between any.");
  EXPECT_EQ(own["noise_sigma_m"], Json::array({nullptr}));
  for (const char* part : {"nan", "inf", "NaN", "Infinity"}) EXPECT_FALSE(contains(text, part)) << part;
  EXPECT_EQ(text, to_json(report_of(two_scenes())));
}

TEST(ScorecardReport, HasSuccessesWithIntervalsMarksAndFailures) {
  const Scorecard card = two_scenes();
  const Json json = json_of(report_of(card)), &one = json["scenes"][0]["success"][0],
             &two = json["scenes"][0]["success"][1];
  const Proportion& noisy = card.scenes[0].success[0].at_level[1];
  EXPECT_EQ(one["levels"][0]["successes"], 1);
  EXPECT_EQ(one["levels"][0]["runs"], 1);
  EXPECT_EQ(
      one["levels"][1],
      Json({{"successes", 19}, {"runs", 20}, {"fraction", 0.95}, {"low", noisy.low}, {"high", noisy.high}}));
  EXPECT_EQ(one["overall"], one["levels"][1]);
  EXPECT_EQ(one["noise_free"], one["levels"][0]);
  EXPECT_EQ(one["old"]["overall"]["successes"], 20);
  EXPECT_EQ(json["scenes"][1]["success"][0]["old"], nullptr);
  EXPECT_EQ(json["scenes"][1]["success"][0]["noise_free"], nullptr);
  EXPECT_EQ(one["mark"], "best");
  EXPECT_EQ(one["failure"], nullptr);
  EXPECT_EQ(two["levels"][1]["successes"], 0);
  EXPECT_EQ(two["mark"], "worst");
  EXPECT_EQ(two["failure"], Json({{"level", 1},
                                  {"replicate", 3},
                                  {"file", "traces/x.h5"},
                                  {"command", "remote-touch replay runs/x.h5 --cell 1"}}));
  EXPECT_EQ(json["scenes"][1]["success"][0]["mark"], "none");
}

TEST(ScorecardReport, HasMeasuresWithUnitsAndIntervals) {
  const Scorecard card = two_scenes();
  const Json json = json_of(report_of(card)), &measure = json["scenes"][0]["measures"][0];
  EXPECT_EQ(measure["name"], "end_distance");
  EXPECT_EQ(measure["units"], "m");
  EXPECT_EQ(measure["better"], "larger");
  const Json& one = measure["methods"][0];
  EXPECT_EQ(one["overall"]["mean"], card.scenes[0].measures[0].ranking.mean[0].value);
  EXPECT_EQ(one["overall"]["runs"], 19);
  EXPECT_EQ(one["levels"][1]["mean"], card.scenes[0].measures[0].at_level[0][1].value);
  EXPECT_EQ(one["levels"][1]["low"], nullptr);                     // equal runs have no interval
  EXPECT_EQ(one["levels"][0]["low"], nullptr);                     // nor has one run
  EXPECT_EQ(measure["methods"][1]["levels"][1]["mean"], nullptr);  // a method that never succeeds has no mean
  EXPECT_EQ(measure["methods"][1]["overall"]["runs"], 0);
}

// The list "behind" of the project's own method comes from weaknesses().
TEST(ScorecardReport, SaysWhereTheOwnMethodIsBehind) {
  Scorecard card = two_scenes();
  card.methods[1] = "tracked-sheet";
  const Json behind = json_of(report_of(card))["behind"];
  EXPECT_EQ(behind["method"], "tracked-sheet");
  ASSERT_EQ(behind["list"].size(), 2u);
  const Json& first = behind["list"][0];
  EXPECT_EQ(first["scene"], "flat <&>");
  EXPECT_EQ(first["what"], "success");
  EXPECT_EQ(first["other"], "one");
  EXPECT_EQ(first["ahead"], 1);
  EXPECT_EQ(first["own_mean"], 0);
  EXPECT_EQ(first["other_mean"], 0.95);
  EXPECT_EQ(first["significant"], true);
  EXPECT_LT(first["p"], 0.05);
  EXPECT_EQ(behind["list"][1]["what"], "success without noise");
  EXPECT_EQ(behind["list"][1]["p"], nullptr);
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

TEST(ScorecardReport, AMeasureThatIsNotJudgedHasNoMark) {
  Scorecard card = two_scenes();
  JudgedMeasure& measure = card.scenes[0].measures[0];
  measure.ranking.order = {0, 1}, measure.ranking.ranked = 2, measure.ranking.has_best = true;
  const auto mark = [&] {
    return json_of(report_of(card))["scenes"][0]["measures"][0]["methods"][0]["mark"];
  };
  EXPECT_EQ(mark(), "best");
  measure.better = Better::neither;
  EXPECT_EQ(mark(), "none");
}

TEST(ScorecardReport, AnErrorIsShownAsTheFailureThatItIs) {
  ScorecardReport report = report_of(two_scenes());
  report.failures[0][1] = FailureTrace{1, 3, {}, {}, "cannot <be> run"};
  EXPECT_EQ(json_of(report)["scenes"][0]["success"][1]["failure"],
            Json({{"level", 1}, {"replicate", 3}, {"error", "cannot <be> run"}}));
}

TEST(ScorecardReport, AMessageMayHoldAnyBytes) {
  ScorecardReport report = report_of(two_scenes());
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

TEST(Costs, AreReadWhereTheyAreOfThisBuildAndMachine) {
  const TestFolder folder("costs");
  const TextAttributes here = {{"source_digest", "s"}, {"isa", "i"}, {"cpu", "c"}},
                       other = {{"source_digest", "s"}, {"isa", "i"}, {"cpu", "d"}};
  write_costs(folder / "costs.json", {{"a", "b", 1e-5, std::nan("")}}, here);
  const std::vector<Cost> costs = read_costs(folder / "costs.json", here);
  ASSERT_EQ(costs.size(), 1u);
  EXPECT_EQ(costs[0].tick_s, 1e-5);
  EXPECT_TRUE(std::isnan(costs[0].frame_s));
  EXPECT_TRUE(read_costs(folder / "costs.json", other).empty());
  EXPECT_TRUE(read_costs(folder / "none.json", here).empty());
}

// The error may be one of the machine, such as too little memory, so the cost is measured again.
TEST(Costs, OfARunThatEndedWithAnErrorAreNotRead) {
  const TestFolder folder("costs");
  const TextAttributes here = {{"source_digest", "s"}, {"isa", "i"}, {"cpu", "c"}};
  write_costs(folder / "costs.json", {{"a", "b", std::nan(""), std::nan("")}, {"a", "c", 1e-5, 1e-4}}, here);
  const std::vector<Cost> costs = read_costs(folder / "costs.json", here);
  ASSERT_EQ(costs.size(), 1u);
  EXPECT_EQ(costs[0].method, "c");
}

}  // namespace
}  // namespace remote_touch::scorecard_report_test
