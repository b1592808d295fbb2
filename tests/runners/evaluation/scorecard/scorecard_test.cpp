// Standings of methods, the rule of success, and the tables of a scorecard's figure.
#include "runners/evaluation/scorecard/scorecard.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/points/noise.h"
#include "runners/evaluation/scorecard/evaluation.h"
#include "tests/runners/evaluation/scorecard/example_cards.h"

namespace remote_touch::scorecard_test {
namespace {

using namespace made_cards;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Two levels of 20 values around a middle. Ten elevenths of the spread are common to all methods.
PairedValues values_around(double middle, std::uint32_t method) {
  PairedValues values(2);
  for (std::uint32_t i = 0; i < 2; ++i)
    for (std::uint32_t k = 0; k < 20; ++k) {
      const double common = uniforms({{1, 1}, {i, 0, 0}}, k)[0];
      const double own = uniforms({{1, 1}, {i, 1 + method, 0}}, k)[0];
      values[i].push_back(middle + common + 0.1 * own);
    }
  return values;
}

// Returns the values twice, so that there are as many pairs as a verdict needs.
std::vector<double> twice(std::vector<double> values) {
  const std::vector<double> again = values;
  values.insert(values.end(), again.begin(), again.end());
  return values;
}

using Places = std::vector<std::size_t>;

struct RankedMethods {
  const char* what;
  std::vector<PairedValues> methods;
  Better better;
  bool is_event;
  Places order;
  bool has_best, has_worst;
  Places top_group;
};

TEST(Standings, HaveABestAndAWorstIfThePairsShowIt) {
  const auto level = [](std::vector<double> values) { return PairedValues(1, std::move(values)); };
  // The methods are 0.2 apart and the spread is 1, so only the comparison of pairs shows the difference.
  const std::vector<PairedValues> three = {values_around(0.2, 0), values_around(0, 1), values_around(0.4, 2)};
  const PairedValues one = values_around(0, 0);
  const PairedValues all(2, std::vector<double>(20, 1)), none(2, std::vector<double>(20, 0));
  PairedValues one_less = all;
  one_less[1][3] = 0;
  const PairedValues early = {twice({1, 1.1, 0.9, 1, 1.1, 0.9}), std::vector<double>(12, kNan)};
  const PairedValues both = {twice({0.5, 0.6, 0.4, 0.5, 0.6, 0.4}), twice({3, 3.1, 2.9, 3, 3.1, 2.9})};
  const PairedValues low = level(twice({-5, -4, -6, -5, -4, -6})), high = level(twice({1, 2, 1, 2, 1, 2}));
  PairedValues first(1, std::vector<double>(24, 1)), second(1, std::vector<double>(24, 2)),
      third = level(twice({1, 0.9, 9, 1, 0.9, 1}));
  third[0].resize(24, kNan);
  second[0][1] = second[0][8] = 2.1;
  const RankedMethods cases[] = {
      {"three apart", three, Better::smaller, false, {1, 0, 2}, true, true, {1}},
      {"larger is better", three, Better::larger, false, {2, 0, 1}, true, true, {2}},
      {"equal ones", {one, one, one}, Better::smaller, false, {0, 1, 2}, false, false, {0, 1, 2}},
      {"two that are best",
       {one, values_around(3, 1), one},
       Better::smaller,
       false,
       {0, 2, 1},
       false,
       true,
       {0, 2}},
      {"one flipped event", {none, one_less, all}, Better::larger, true, {2, 1, 0}, false, true, {2, 1}},
      // The first has values only at the easy level, so its own mean is the best, but it is worse in every
      // pair.
      {"pairs against the order", {early, both}, Better::smaller, false, {0, 1}, false, false, {0, 1}},
      // The third has a worse mean than the second, but has values for only half of the runs and is mostly as
      // good as the first.
      {"one like the best", {first, second, third}, Better::smaller, false, {0, 1, 2}, false, false, {0, 2}},
      {"below zero", {low, high}, Better::smaller, false, {0, 1}, true, true, {0}},
      {"near zero", {low, high}, Better::near_zero, false, {1, 0}, true, true, {1}}};
  for (const RankedMethods& each : cases) {
    SCOPED_TRACE(each.what);
    const Ranking found = ranking(each.methods, each.better, each.is_event);
    EXPECT_EQ(found.order, each.order);
    EXPECT_EQ(found.has_best, each.has_best);
    EXPECT_EQ(found.has_worst, each.has_worst);
    EXPECT_EQ(found.top_group, each.top_group);
  }
  const Ranking reported = ranking(three, Better::neither, false);
  EXPECT_FALSE(reported.has_best || reported.has_worst);
  EXPECT_FALSE(ranking({first, second, third}, Better::larger, false).has_worst);
  const PairedValues unknown(1, std::vector<double>(12, kNan));
  const Ranking partly = ranking({unknown, high, low}, Better::smaller, false);
  EXPECT_EQ(partly.order, (Places{2, 1, 0})) << "a method without numbers is not ranked";
  EXPECT_TRUE(partly.has_best && partly.has_worst);
  EXPECT_EQ(partly.ranked, 2u);
  EXPECT_EQ(ranking({unknown, unknown}, Better::smaller, false).ranked, 0u);
}

TEST(Standings, TooFewCommonPairsGiveNoVerdict) {
  PairedValues one(1, std::vector<double>(20, 1)), other(1, std::vector<double>(20, 2)),
      rest(1, std::vector<double>(20, 3));
  std::fill_n(other[0].begin(), 8, kNan);
  std::fill_n(rest[0].rbegin(), 4, kNan);  // eight pairs of both
  EXPECT_TRUE(ranking({one, other}, Better::smaller, false).has_best);
  const Ranking apart = ranking({other, rest}, Better::smaller, false);
  EXPECT_EQ(apart.ranked, 2u);
  EXPECT_TRUE(std::isnan(apart.against[0][1].p));
  EXPECT_FALSE(apart.has_best || apart.has_worst);
  PairedValues lucky(1, std::vector<double>(20, kNan));
  std::fill_n(lucky[0].begin(), 11, 0);
  EXPECT_EQ(ranking({one, lucky, other}, Better::smaller, false).ranked, 2u);
  const PairedValues won(1, std::vector<double>(11, 1)), lost(1, std::vector<double>(11, 0));
  EXPECT_FALSE(ranking({won, lost}, Better::larger, true).has_best);  // events need as many pairs
  // A value that is alone in its level is not thereby certain.
  PairedValues nought(14, {0}), scattered(14, {0});
  for (std::size_t i = 0; i < 14; ++i) scattered[i][0] = i % 2 == 0 ? 1.0 + 0.5 * static_cast<double>(i) : -3;
  const Ranking alone = ranking({nought, scattered}, Better::smaller, false);
  EXPECT_FALSE(alone.has_best);
  EXPECT_LT(alone.mean[1].low, alone.mean[1].high);
}

// About ten of 200 comparisons of equal methods show a difference if they are not corrected. Corrected
// together, hardly ever one does.
TEST(Standings, IsCorrectedForAllComparisons) {
  std::vector<Ranking> rankings;
  int found = 0;
  for (std::uint32_t k = 0; k < 200; ++k) {
    PairedValues a(1), b(1);
    for (std::uint32_t i = 0; i < 20; ++i) {
      const auto u = uniforms({{7, 1}, {k, 0, 0}}, i);
      a[0].push_back(u[0]), b[0].push_back(u[1]);
    }
    rankings.push_back(ranking({a, b}, Better::smaller, false));
    found += rankings.back().has_best;
  }
  EXPECT_GE(found, 3);
  EXPECT_LE(found, 20);
  PairedValues low(1), high(1);  // one true difference among them
  for (std::uint32_t i = 0; i < 30; ++i) {
    const auto u = uniforms({{7, 2}, {i, 0, 0}}, 0);
    low[0].push_back(u[0]), high[0].push_back(u[1] + 2);
  }
  rankings.push_back(ranking({high, low}, Better::smaller, false));
  const double p = rankings.back().against[1][0].p;
  std::vector<Ranking*> all;
  for (Ranking& one : rankings) all.push_back(&one);
  EXPECT_EQ(correct_together(all), 201);
  for (std::size_t k = 0; k < 200; ++k) EXPECT_FALSE(rankings[k].has_best) << k;
  EXPECT_TRUE(rankings.back().has_best);
  EXPECT_EQ(rankings.back().order.front(), 1u);
  EXPECT_NEAR(rankings.back().against[1][0].p, 201 * p, 1e-12 * p);  // the smallest of 201
  EXPECT_EQ(rankings.back().against[0][1].p, rankings.back().against[1][0].p);
}

TEST(Standings, ARepeatedRunCountsOnce) {
  // Level 0 repeats one run 20 times. The other level shows no difference.
  PairedValues up(2, std::vector<double>(20, 1)), down = up;
  down[0].assign(20, 0);
  const std::vector<SharedRuns> both(2, {{true, false}}), one = {{{true, false}}, {{false, false}}};
  EXPECT_TRUE(ranking({up, down}, Better::larger, true).has_best);
  const Ranking events = ranking({up, down}, Better::larger, true, both);
  EXPECT_FALSE(events.has_best);
  EXPECT_EQ(events.mean[0].clusters, 21);
  EXPECT_TRUE(ranking({up, down}, Better::larger, true, one).has_best);  // the other's runs differ
  const PairedValues low(1, std::vector<double>(20, 1)), high(1, std::vector<double>(20, 2));
  EXPECT_TRUE(ranking({low, high}, Better::smaller, false).has_best);
  EXPECT_EQ(ranking({low, high}, Better::smaller, false, {{{true}}, {{true}}}).ranked, 0u);
}

// Four levels of 5 replicates are 20 pairs, but only 5 clusters if the levels share the random numbers of a
// replicate.
TEST(Standings, RunsOfAReplicateThatShareRandomNumbersAreOneCluster) {
  const PairedValues low(4, std::vector<double>(5, 1)), high(4, std::vector<double>(5, 2));
  for (const bool event : {false, true}) {
    const PairedValues better = event ? PairedValues(4, std::vector<double>(5, 0)) : low;
    const PairedValues worse = event ? low : high;
    EXPECT_TRUE(ranking({better, worse}, Better::smaller, event).has_best);
    const Ranking shared = ranking({better, worse}, Better::smaller, event, {{{}, true}, {}});
    EXPECT_FALSE(shared.has_best);
    EXPECT_TRUE(std::isnan(shared.against[0][1].p));
    EXPECT_EQ(shared.mean[0].clusters, 5);
    EXPECT_EQ(shared.mean[1].clusters, 20);
  }
}

// Eleven runs are better by about 0.45 and one is worse by 0.5: the sign flips give p = 0.0063.
TEST(Standings, ASkewedDifferenceEarnsNoVerdict) {
  const PairedValues differences = {
      {-.4233, -.4994, -.4994, -.4994, -.4233, -.4994, -.4614, .504, -.4625, -.4994, -.4245, -.4614}};
  const PairedValues zero(1, std::vector<double>(12, 0));
  const Ranking skewed = ranking({differences, zero}, Better::smaller, false);
  EXPECT_NEAR(skewed.against[0][1].p, 0.00635, 5e-6);
  EXPECT_TRUE(skewed.against[0][1].is_skewed && skewed.against[1][0].is_skewed);
  EXPECT_FALSE(skewed.has_best || skewed.has_worst);
}

// Two levels of noise, five replicates each.
SweepResult depths_and_times(const std::vector<double>& depth, const std::vector<double>& time) {
  return finished_sweep({0, 0.001}, {{"depth", depth, "m"}, {"time", time, "s"}});
}

const std::vector<Bound> kBounds = {{"depth", -1}, {"time", 2, 3}};

TEST(SuccessRule, EveryBoundMustHoldIncludingItsEnds) {
  const SweepResult sweep =
      depths_and_times({-1, -1.01, 5, kNan, 0, 0, 0, 0, 0, 0}, {2, 2, 3, 2, kNan, 3.01, 1.99, 2.5, 2, 3});
  EXPECT_EQ(successes(sweep, kBounds),
            (std::vector<bool>{true, false, true, false, false, false, false, true, true, true}));
  EXPECT_THROW(successes(sweep, {{"height"}}), std::out_of_range);
}

TEST(SuccessRule, ARunThatFailedIsNoSuccessWhateverTheBounds) {
  SweepResult sweep = depths_and_times(std::vector<double>(10, 0), std::vector<double>(10, 2.5));
  sweep.state[4] = RunState::failed;
  for (const std::vector<Bound>& bounds : {kBounds, {}}) {
    const std::vector<bool> won = successes(sweep, bounds);
    EXPECT_EQ(std::count(won.begin(), won.end(), true), 9);
    EXPECT_FALSE(won[4]);
  }
}

TEST(SuccessRule, TheTypicalFailureIsTheOneInTheMiddle) {
  const SweepResult sweep =
      depths_and_times({0, 0, 0, 0, 0, -4, -2, 0, -3, kNan}, std::vector<double>(10, 2.5));
  EXPECT_EQ(typical_failure(sweep, kBounds, 0), -1);
  EXPECT_EQ(typical_failure(sweep, kBounds, 1), 8);  // the second of -4, -3, -2 and NaN
}

TEST(SuccessRule, ErrorsAreFailuresBehindAllOthers) {
  SweepResult sweep = depths_and_times({0, 0, 0, 0, 0, -4, -2, 0, 0, 0}, std::vector<double>(10, 2.5));
  sweep.state[2] = RunState::failed;
  EXPECT_EQ(typical_failure(sweep, kBounds, 0), 2);
  sweep.state[7] = RunState::failed;
  EXPECT_EQ(typical_failure(sweep, kBounds, 1), 6);  // the second of -4, -2 and an error
}

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
}  // namespace remote_touch::scorecard_test
