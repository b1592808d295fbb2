#include "runners/scorecard/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runners/scorecard/page_tables.h"
#include "tests/test_files.h"

namespace remote_touch {
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
  EXPECT_EQ(scene.success[0][0].events, 10);
  EXPECT_EQ(scene.success[0][1].events, 9);
  EXPECT_EQ(scene.success_overall[0].events, 19);
  EXPECT_EQ(scene.success_overall[0].runs, 20);
  EXPECT_EQ(scene.success_overall[1].events, 0);
  EXPECT_EQ(verdict(card, scene), "Best: one. Worst: two.");
  EXPECT_EQ(verdict(card, card.scenes[1]), "No difference between any.");
  EXPECT_TRUE(std::isnan(card.scenes[1].noise_m.at(0)));
}

TEST(ScorecardFigure, HasARowForEverySceneContenderAndLevel) {
  const Figure figure = scorecard_figure(two_scenes());
  ASSERT_EQ(figure.tables.size(), 5u);
  EXPECT_EQ(figure.tables[0].columns[0].length(), 2u * 2 + 2u * 1);
  for (const Table& table : figure.tables)
    for (const Column& column : table.columns)
      EXPECT_EQ(column.length(), table.columns[0].length()) << column.name;
  EXPECT_EQ(numbers(figure.tables[0], "share")[1], 0.9);
  EXPECT_EQ(figure.panels.size(), 2u);
}

TEST(ScorecardPage, HasEverySceneAndNeedsNothingElse) {
  const std::string text = html(page_of(two_scenes()));
  for (const char* part :
       {"<h2 id=\"flat &lt;&amp;&gt;\">", "a &quot;plane&quot;", "<h2 id=\"own-noise\">", "Skipped: absent",
        "no &lt;recording&gt;", "10/10", "9/10", "0/10", "href=\"traces/x.h5\"",
        "remote-touch replay runs/x.h5 --cell 1", "Best: one. Worst: two.", "No difference between any."})
    EXPECT_HAS(text, part);
  for (const char* part : {"<script", "http", "src=", "nan", "inf"})
    EXPECT_FALSE(contains(text, part)) << part;
  EXPECT_EQ(text, html(page_of(two_scenes())));
}

}  // namespace
}  // namespace remote_touch
