#include "runners/evaluation/scorecard/scorecard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "runners/evaluation/scorecard/card_summaries.h"
#include "tests/runners/evaluation/scorecard/example_cards.h"

namespace remote_touch::scorecard_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Two levels of noise, five replicates each.
SweepResult sweep_of(const std::vector<double>& depth, const std::vector<double>& time) {
  SweepResult result;
  result.axes = {{"noise", "m", "", std::vector<double>{0, 0.001}}};
  result.replicates = 5;
  result.measures = {{"depth", "m", "", {}}, {"time", "s", "", {}}};
  result.start(false);
  for (RunState& state : result.state) state = RunState::done;
  result.measures[0].values = depth;
  result.measures[1].values = time;
  return result;
}

const std::vector<Bound> kBounds = {{"depth", -1}, {"time", 2, 3}};

TEST(SuccessRule, EveryBoundMustHoldIncludingItsEnds) {
  const SweepResult sweep =
      sweep_of({-1, -1.01, 5, kNan, 0, 0, 0, 0, 0, 0}, {2, 2, 3, 2, kNan, 3.01, 1.99, 2.5, 2, 3});
  EXPECT_EQ(successes(sweep, kBounds),
            (std::vector<bool>{true, false, true, false, false, false, false, true, true, true}));
  EXPECT_THROW(successes(sweep, {{"height"}}), std::out_of_range);
}

TEST(SuccessRule, ARunThatFailedIsNoSuccessWhateverTheBounds) {
  SweepResult sweep = sweep_of(std::vector<double>(10, 0), std::vector<double>(10, 2.5));
  sweep.state[4] = RunState::failed;
  for (const std::vector<Bound>& bounds : {kBounds, {}}) {
    const std::vector<bool> won = successes(sweep, bounds);
    EXPECT_EQ(std::count(won.begin(), won.end(), true), 9);
    EXPECT_FALSE(won[4]);
  }
}

TEST(SuccessRule, TheTypicalFailureIsTheOneInTheMiddle) {
  const SweepResult sweep = sweep_of({0, 0, 0, 0, 0, -4, -2, 0, -3, kNan}, std::vector<double>(10, 2.5));
  EXPECT_EQ(typical_failure(sweep, kBounds, 0), -1);
  EXPECT_EQ(typical_failure(sweep, kBounds, 1), 8);  // the second of -4, -3, -2 and NaN
}

TEST(SuccessRule, ErrorsAreFailuresBehindAllOthers) {
  SweepResult sweep = sweep_of({0, 0, 0, 0, 0, -4, -2, 0, 0, 0}, std::vector<double>(10, 2.5));
  sweep.state[2] = RunState::failed;
  EXPECT_EQ(typical_failure(sweep, kBounds, 0), 2);
  sweep.state[7] = RunState::failed;
  EXPECT_EQ(typical_failure(sweep, kBounds, 1), 6);  // the second of -4, -2 and an error
}

}  // namespace
}  // namespace remote_touch::scorecard_test

namespace remote_touch::scorecard_figure_test {
namespace {

// The tables of a scorecard's figure: their content and units.

using namespace made_cards;
using Texts = std::vector<std::string>;
using Counts = std::vector<std::int32_t>;
using Numbers = std::vector<double>;

const Table& table_of(const Figure& figure, const std::string& name) {
  for (const Table& table : figure.tables)
    if (table.name == name) return table;
  throw std::out_of_range(name);
}

// Scene 0: the methods differ in success. Scene 1: all succeed, and each needs more steps than the one
// before.
Scorecard two_orders() {
  return card_of({{sweep_of(true, 20, 1), sweep_of(true, 10, 1), sweep_of(true, 0, 1)},
                  {sweep_of(true, 20, 1), sweep_of(true, 20, 2), sweep_of(true, 20, 3)}},
                 {{"steps", Better::smaller}, {"held", Better::neither}});
}

TEST(ScorecardFigure, StandingsHaveSuccessAndEveryJudgedMeasure) {
  const Figure figure = scorecard_figure(two_orders());
  const Table& standings = table_of(figure, "standings");
  const auto& scene = values_of<Texts>(standings, "scene");
  EXPECT_EQ(scene, (Texts{"scene 0", "scene 0", "scene 0", "scene 0", "scene 0", "scene 0",  //
                          "scene 1", "scene 1", "scene 1", "scene 1", "scene 1", "scene 1"}));
  EXPECT_EQ(values_of<Texts>(standings, "measure"),
            (Texts{"success", "success", "success", "steps", "steps", "steps",  //
                   "success", "success", "success", "steps", "steps", "steps"}));
  ASSERT_EQ(values_of<Counts>(standings, "place"), (Counts{1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3}));
  const auto& method = values_of<Texts>(standings, "method");
  const auto &mark = values_of<Counts>(standings, "mark"), &top = values_of<Counts>(standings, "top_group");
  for (const std::size_t first : {0, 9}) {  // success of scene 0, steps of scene 1
    EXPECT_EQ(Texts(method.begin() + first, method.begin() + first + 3),
              (Texts{kOwnMethod, "proxy", "penalty"}));
    EXPECT_EQ(Counts(mark.begin() + first, mark.begin() + first + 3), (Counts{1, 0, -1}));
    EXPECT_EQ(Counts(top.begin() + first, top.begin() + first + 3), (Counts{1, 0, 0}));
  }
  // A method that succeeds as often as all others is neither best nor worst. It is in the top group.
  EXPECT_EQ(Counts(mark.begin() + 6, mark.begin() + 9), (Counts{0, 0, 0}));
  EXPECT_EQ(Counts(top.begin() + 6, top.begin() + 9), (Counts{1, 1, 1}));
}

TEST(ScorecardFigure, PanelsShowTheShareOfSuccessesOverNoise) {
  const Figure figure = scorecard_figure(two_orders());
  const Table& panel = table_of(figure, "panel_0");
  EXPECT_EQ(values_of<Numbers>(panel, "noise"), (Numbers{0, 5}));
  EXPECT_EQ(values_of<Numbers>(panel, "proxy"), (Numbers{1, 0.5}));
  EXPECT_EQ(values_of<Numbers>(panel, "penalty"), (Numbers{1, 0}));
  for (const Column& column : panel.columns) {
    EXPECT_EQ(column.units, column.name == "noise" ? "mm" : "1") << column.name;
    EXPECT_GT(column.long_name.size(), 10u) << column.name;
  }
  EXPECT_EQ(panel.columns.size(), 1u + 3 * 3);
}

// Counts, fractions and names have the unit "1", and every column has a description.
TEST(ScorecardFigure, ColumnsOfTheOverviewAreExplained) {
  const Scorecard card = card_of({{sweep_of(true, 0, 1), sweep_of(true, 14, 1), sweep_of(true, 20, 1)}});
  for (const Table& table : {overview_table(card), behind_table(card)})
    for (const Column& column : table.columns) {
      EXPECT_EQ(column.units, "1") << column.name;
      EXPECT_NE(column.long_name, "1") << column.name;
    }
  const Table behind = behind_table(card);
  EXPECT_EQ(values_of<Texts>(behind, "what"), Texts{"success"});
  EXPECT_EQ(values_of<Texts>(behind, "other"), Texts{"penalty"});
  EXPECT_EQ(values_of<Counts>(behind, "ahead"), Counts{2});
  EXPECT_EQ(values_of<Counts>(behind, "significant"), Counts{1});
  EXPECT_EQ(values_of<Numbers>(behind, "own_mean"), Numbers{0});
  EXPECT_EQ(values_of<Numbers>(behind, "other_mean"), Numbers{1});
}

}  // namespace
}  // namespace remote_touch::scorecard_figure_test
