#include "runners/scorecard/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runners/scorecard/page_tables.h"
#include "tests/support/test_files.h"

namespace remote_touch::scorecard_page_test {
namespace {

// Replicates of two noise levels that are successes, and a measure.
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
  std::vector<double> good(20, 0.005), bad(20, -0.01);
  good[19] = -0.001;
  Scorecard card{{"one", "two"}, {"the first", "the second"}, {}};
  card.scenes.push_back(score(kRules, {sweep_of(good, noise), sweep_of(bad, noise)}, false, 1));
  SceneRules other = kRules;
  other.name = "own-noise";
  card.scenes.push_back(score(other, {sweep_of(good, {1}), sweep_of(good, {1})}, true, 1));
  return card;
}

ScorecardPage page_of(const Scorecard& card) {
  ScorecardPage page{card, 10, "remote-touch 1", {{"absent", "no <recording>"}}, {}, {}, {}};
  page.failures.assign(2, std::vector<std::optional<FailureTrace>>(2));
  page.failures[0][1] = FailureTrace{1, 3, "traces/x.h5", "remote-touch replay runs/x.h5 --cell 1"};
  page.costs = {{"own-noise", "one", 1e-5, 1e-4}, {"own-noise", "two", 3e-5, std::nan("")}};
  return page;
}

TEST(Score, CountsSuccessesAndTellsWhoStandsOut) {
  const Scorecard card = two_scenes();
  const SceneScore& scene = card.scenes[0];
  EXPECT_EQ(scene.success[0][0].events, 1);  // without noise, ten times the same run
  EXPECT_EQ(scene.success[0][0].runs, 1);
  EXPECT_EQ(scene.success[0][1].events, 9);
  EXPECT_EQ(scene.success_overall[0].events, 10);
  EXPECT_EQ(scene.success_overall[0].runs, 11);
  EXPECT_EQ(scene.success_overall[1].events, 0);
  EXPECT_EQ(verdict(card, scene), "Best: one. Worst: two.");
  EXPECT_EQ(verdict(card, card.scenes[1]), "No difference between any.");
  EXPECT_TRUE(std::isnan(card.scenes[1].noise_m.at(0)));
}

// Three noise levels of three runs: end_distance, and last_force_time where it is the same in all.
SweepResult timed(const std::vector<double>& depth, double last_s) {
  SweepResult result = sweep_of(depth, {0, 0.001, 0.005});
  result.measures.push_back({"time", "s", "", std::vector<double>(depth.size(), last_s), 1, {}});
  return result;
}

TEST(Score, MeasuresAreJudgedWhereBothSucceeded) {
  // Who loses the surface in two of three runs is quiet there: 0.1 against 2, and 2.5 where both hold.
  std::vector<double> upper, at_times;
  for (int i = 0; i < 18; ++i)
    upper.push_back(1 + 0.01 * i), at_times.push_back(i % 3 == 0 ? 1 : -1 - 0.01 * i);
  SweepResult held = timed(upper, 2), lost = timed(at_times, 0.1);
  auto& time = std::get<std::vector<double>>(lost.measures[1].values);
  for (std::size_t i = 0; i < 18; i += 3) time[i] = 2.5;
  SceneRules rules = kRules;
  rules.measures = {{"time", Better::smaller}, {"time", Better::reported}};
  const SceneScore scene = score(rules, {held, lost}, false, 1);
  const Ranking& judged = scene.measures[0].ranking;
  EXPECT_EQ(judged.mean[1].pairs, 6);
  EXPECT_EQ(judged.mean[1].mean, 2.5);
  EXPECT_EQ(judged.order.front(), 0u);
  EXPECT_TRUE(judged.has_best);
  EXPECT_EQ(scene.measures[0].at_level[1][1].pairs, 2);
  EXPECT_EQ(scene.measures[1].ranking.mean[1].pairs, 18);
  time[6] = 0.1, std::get<std::vector<double>>(lost.measures[0].values)[6] = -1;
  EXPECT_FALSE(score(rules, {held, lost}, false, 1).measures[0].ranking.has_best);  // five pairs are left
}

TEST(Score, EqualRunsAreOneOnlyWithoutNoise) {
  const SweepResult same = sweep_of(std::vector<double>(9, 1), {0, 0.001, 0.005});
  const SceneScore scene = score(kRules, {same, same}, false, 1);
  EXPECT_EQ(scene.success[0][0].runs, 1);
  EXPECT_EQ(scene.success[0][1].runs, 3);
  EXPECT_EQ(scene.success_overall[0].runs, 7);
  EXPECT_EQ(scene.measures[0].at_level[0][0].pairs, 1);
  const SweepResult own = sweep_of(std::vector<double>(9, 1), {1});
  EXPECT_EQ(score(kRules, {own}, true, 1).success[0][0].runs, 1);
  SweepResult differ = same;
  std::get<std::vector<double>>(differ.measures[0].values)[2] = 1 + 1e-15;
  EXPECT_EQ(score(kRules, {differ}, false, 1).success[0][0].runs, 3);
}

TEST(ScorecardFigure, HasARowForEverySceneContenderAndLevel) {
  const Figure figure = scorecard_figure(two_scenes());
  ASSERT_EQ(figure.tables.size(), 5u);
  EXPECT_EQ(figure.tables[0].columns[0].length(), 2u * 2 + 2u * 1);
  for (const Table& table : figure.tables)
    for (const Column& column : table.columns)
      EXPECT_EQ(column.length(), table.columns[0].length()) << column.name;
  EXPECT_EQ(numbers(figure.tables[0], "fraction")[1], 0.9);
  EXPECT_EQ(figure.panels.size(), 2u);
}

TEST(ScorecardPage, HasEverySceneAndNeedsNothingElse) {
  const std::string text = html(page_of(two_scenes()));
  for (const char* part :
       {"<h2 id=\"flat &lt;&amp;&gt;\">", "a &quot;plane&quot;", "<h2 id=\"own-noise\">", "Skipped: absent",
        "no &lt;recording&gt;", "1/1", "9/10", "0/10", "seed 301", "seeds 1 to 40", "href=\"traces/x.h5\"",
        "remote-touch replay runs/x.h5 --cell 1", "Best: one. Worst: two.", "No difference between any."})
    EXPECT_HAS(text, part);
  for (const char* part : {"<script", "http", "src=", "nan", "inf"})
    EXPECT_FALSE(contains(text, part)) << part;
  EXPECT_EQ(text, html(page_of(two_scenes())));
}

TEST(ScorecardPage, AnErrorIsShownAsTheFailureThatItIs) {
  ScorecardPage page = page_of(two_scenes());
  page.failures[0][1] = FailureTrace{1, 3, {}, {}, "cannot <be> run"};
  EXPECT_HAS(html(page), "error at 1, run 3: cannot &lt;be&gt; run");
}

TEST(Costs, WhatWasNotMeasuredIsNotSorted) {
  ScorecardPage page = page_of(two_scenes());
  const double none = std::nan("");
  page.costs = {{"own-noise", "one", none, none},
                {"own-noise", "two", 3e-5, 1e-4},
                {"flat <&>", "one", 1e-5, 1e-4},
                {"flat <&>", "two", 2e-5, none}};
  const std::string table = cost_table(page);
  EXPECT_HAS(table, "two</th><td>2</td><td>-</td><td>20</td><td>-</td>");
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

}  // namespace
}  // namespace remote_touch::scorecard_page_test
