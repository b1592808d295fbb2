#include "analysis/scorecard/ranking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/random/noise.h"

namespace remote_touch::ranking_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Two levels of 20 pairs around a middle; the first half of the spread is common to all methods.
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

TEST(Standings, TheEndsAreMarkedWhereThePairsTellThemApart) {
  // 0.2 apart where the spread is 1: only the pairs show it.
  const std::vector<PairedValues> three = {values_around(0.2, 0), values_around(0, 1), values_around(0.4, 2)};
  const Ranking smaller = ranking(three, Better::smaller, false, 1);
  EXPECT_EQ(smaller.order, (std::vector<std::size_t>{1, 0, 2}));
  EXPECT_TRUE(smaller.has_best && smaller.has_worst);
  EXPECT_EQ(smaller.top_group, (std::vector<std::size_t>{1}));
  EXPECT_EQ(ranking(three, Better::larger, false, 1).order, (std::vector<std::size_t>{2, 0, 1}));
  const Ranking reported = ranking(three, Better::reported, false, 1);
  EXPECT_FALSE(reported.has_best || reported.has_worst);
}

TEST(Standings, NoDifferenceIsSaidAsSuch) {
  const PairedValues one = values_around(0, 0);
  const Ranking same = ranking({one, one, values_around(0, 0)}, Better::smaller, false, 1);
  EXPECT_FALSE(same.has_best || same.has_worst);
  EXPECT_EQ(same.top_group.size(), 3u);
  const Ranking two_best = ranking({one, values_around(3, 1), one}, Better::smaller, false, 1);
  EXPECT_FALSE(two_best.has_best);
  EXPECT_TRUE(two_best.has_worst);
  EXPECT_EQ(two_best.top_group, (std::vector<std::size_t>{0, 2}));
}

TEST(Standings, OfEventsFewFlipsAreNoDifference) {
  const PairedValues all(2, std::vector<double>(20, 1)), none(2, std::vector<double>(20, 0));
  PairedValues one_less = all;
  one_less[1][3] = 0;
  const Ranking success = ranking({none, one_less, all}, Better::larger, true, 1);
  EXPECT_EQ(success.order, (std::vector<std::size_t>{2, 1, 0}));
  EXPECT_FALSE(success.has_best);
  EXPECT_TRUE(success.has_worst);
  EXPECT_EQ(success.top_group, (std::vector<std::size_t>{2, 1}));
}

TEST(Standings, TheCommonPairsHaveToSayWhatTheOrderSays) {
  // The first has numbers only where it is easy, so its own mean is the best, and every pair says otherwise.
  const PairedValues early = {{1, 1.1, 0.9, 1, 1.1, 0.9}, std::vector<double>(6, kNan)};
  const PairedValues all = {{0.5, 0.6, 0.4, 0.5, 0.6, 0.4}, {3, 3.1, 2.9, 3, 3.1, 2.9}};
  const Ranking result = ranking({early, all}, Better::smaller, false, 1);
  EXPECT_EQ(result.order.front(), 0u);
  EXPECT_FALSE(result.has_best || result.has_worst);
  EXPECT_EQ(result.top_group.size(), 2u);
}

TEST(Standings, TheBestIsApartFromAllOthers) {
  // The third is behind the second, but was seen in six runs, and in four of them as good as the first.
  PairedValues first(1, std::vector<double>(12, 1)), second(1, std::vector<double>(12, 2)),
      third(1, {1, 0.9, 9, 1, 0.9, 9});
  third[0].resize(12, kNan);
  second[0][1] = second[0][8] = 2.1;
  const Ranking result = ranking({first, second, third}, Better::smaller, false, 1);
  EXPECT_EQ(result.order, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_FALSE(result.has_best);
  EXPECT_EQ(result.top_group, (std::vector<std::size_t>{0, 2}));
  const Ranking reverse = ranking({first, second, third}, Better::larger, false, 1);
  EXPECT_EQ(reverse.order, (std::vector<std::size_t>{2, 1, 0}));
  EXPECT_FALSE(reverse.has_worst);
}

TEST(Standings, TooFewCommonPairsAreNoVerdict) {
  const PairedValues one(1, std::vector<double>(10, 1)), other(1, {kNan, kNan, kNan, kNan, 2, 2, 2, 2, 2, 2}),
      rest(1, {3, 3, 3, 3, 3, 3, 3, 3, kNan, kNan});
  EXPECT_TRUE(ranking({one, other}, Better::smaller, false, 1).has_best);
  const Ranking apart = ranking({other, rest}, Better::smaller, false, 1);
  EXPECT_FALSE(apart.has_best || apart.has_worst);
  const PairedValues lucky(1, {0, 0, 0, 0, 0, kNan, kNan, kNan, kNan, kNan});
  EXPECT_EQ(ranking({one, lucky, other}, Better::smaller, false, 1).ranked, 2u);
  // A pair alone in its level is not certain because it is alone.
  const PairedValues nought(7, {0, 0}),
      scattered = {{kNan, 1}, {5, kNan}, {-3, kNan}, {2, kNan}, {-1, kNan}, {-2, kNan}, {4, kNan}};
  const Ranking alone = ranking({nought, scattered}, Better::smaller, false, 1);
  EXPECT_FALSE(alone.has_best);
  EXPECT_LT(alone.mean[1].low, alone.mean[1].high);
}

TEST(Standings, ARunDoneAgainAndAgainCountsOnce) {
  // Level 0 is one run 20 times; of the rest, nothing shows a difference.
  PairedValues up(2, std::vector<double>(20, 1)), down = up;
  down[0].assign(20, 0);
  const std::vector<Repeats> both(2, {true, false}), one = {{true, false}, {false, false}};
  EXPECT_TRUE(ranking({up, down}, Better::larger, true, 1).has_best);
  const Ranking events = ranking({up, down}, Better::larger, true, 1, both);
  EXPECT_FALSE(events.has_best);
  EXPECT_EQ(events.mean[0].pairs, 21);
  EXPECT_TRUE(ranking({up, down}, Better::larger, true, 1, one).has_best);  // the other's runs differ
  const PairedValues low(1, std::vector<double>(20, 1)), high(1, std::vector<double>(20, 2));
  EXPECT_TRUE(ranking({low, high}, Better::smaller, false, 1).has_best);
  EXPECT_EQ(ranking({low, high}, Better::smaller, false, 1, {{true}, {true}}).ranked, 0u);
}

TEST(Standings, NearZeroIsAboutMagnitudes) {
  const PairedValues low(1, {-5, -4, -6, -5, -4, -6}), high(1, {1, 2, 1, 2, 1, 2});
  EXPECT_EQ(ranking({low, high}, Better::near_zero, false, 1).order.front(), 1u);
  EXPECT_EQ(ranking({low, high}, Better::smaller, false, 1).order.front(), 0u);
}

TEST(Standings, WhoHasNoNumberHasNoPlace) {
  const PairedValues none(1, std::vector<double>(6, kNan)), good(1, {1, 2, 1.5, 1, 2, 1.5}),
      bad(1, {9, 10, 9.5, 9, 10, 9.5});
  const Ranking result = ranking({none, bad, good}, Better::smaller, false, 1);
  EXPECT_EQ(result.order, (std::vector<std::size_t>{2, 1, 0}));
  EXPECT_EQ(result.ranked, 2u);
  EXPECT_TRUE(result.has_best && result.has_worst);
  EXPECT_EQ(ranking({none, none}, Better::smaller, false, 1).ranked, 0u);
}

}  // namespace
}  // namespace remote_touch::ranking_test
