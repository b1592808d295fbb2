#include "analysis/standing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/noise.h"

namespace remote_touch {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Two levels of 20 pairs around a middle; the first half of the spread is common to all contenders.
PairedValues values_around(double middle, std::uint32_t contender) {
  PairedValues values(2);
  for (std::uint32_t i = 0; i < 2; ++i)
    for (std::uint32_t k = 0; k < 20; ++k) {
      const double common = uniforms({{1, 1}, {i, 0, 0}}, k)[0];
      const double own = uniforms({{1, 1}, {i, 1 + contender, 0}}, k)[0];
      values[i].push_back(middle + common + 0.1 * own);
    }
  return values;
}

TEST(Standings, TheEndsAreMarkedWhereThePairsTellThemApart) {
  // 0.2 apart where the spread is 1: only the pairs show it.
  const std::vector<PairedValues> three = {values_around(0.2, 0), values_around(0, 1), values_around(0.4, 2)};
  const Standing smaller = standing(three, Better::smaller, false, 1);
  EXPECT_EQ(smaller.order, (std::vector<std::size_t>{1, 0, 2}));
  EXPECT_TRUE(smaller.has_best && smaller.has_worst);
  EXPECT_EQ(smaller.at_the_top, (std::vector<std::size_t>{1}));
  EXPECT_EQ(standing(three, Better::larger, false, 1).order, (std::vector<std::size_t>{2, 0, 1}));
  const Standing reported = standing(three, Better::reported, false, 1);
  EXPECT_FALSE(reported.has_best || reported.has_worst);
}

TEST(Standings, NoDifferenceIsSaidAsSuch) {
  const PairedValues one = values_around(0, 0);
  const Standing same = standing({one, one, values_around(0, 0)}, Better::smaller, false, 1);
  EXPECT_FALSE(same.has_best || same.has_worst);
  EXPECT_EQ(same.at_the_top.size(), 3u);
  const Standing two_best = standing({one, values_around(3, 1), one}, Better::smaller, false, 1);
  EXPECT_FALSE(two_best.has_best);
  EXPECT_TRUE(two_best.has_worst);
  EXPECT_EQ(two_best.at_the_top, (std::vector<std::size_t>{0, 2}));
}

TEST(Standings, OfEventsFewFlipsAreNoDifference) {
  const PairedValues all(2, std::vector<double>(20, 1)), none(2, std::vector<double>(20, 0));
  PairedValues one_less = all;
  one_less[1][3] = 0;
  const Standing success = standing({none, one_less, all}, Better::larger, true, 1);
  EXPECT_EQ(success.order, (std::vector<std::size_t>{2, 1, 0}));
  EXPECT_FALSE(success.has_best);
  EXPECT_TRUE(success.has_worst);
  EXPECT_EQ(success.at_the_top, (std::vector<std::size_t>{2, 1}));
}

TEST(Standings, NearZeroIsAboutMagnitudes) {
  const PairedValues low(1, {-5, -4, -6, -5}), high(1, {1, 2, 1, 2});
  EXPECT_EQ(standing({low, high}, Better::near_zero, false, 1).order.front(), 1u);
  EXPECT_EQ(standing({low, high}, Better::smaller, false, 1).order.front(), 0u);
}

TEST(Standings, WhoHasNoNumberHasNoPlace) {
  const PairedValues none(1, {kNan, kNan, kNan}), good(1, {1, 2, 1.5}), bad(1, {9, 10, 9.5});
  const Standing result = standing({none, bad, good}, Better::smaller, false, 1);
  EXPECT_EQ(result.order, (std::vector<std::size_t>{2, 1, 0}));
  EXPECT_EQ(result.placed, 2u);
  EXPECT_TRUE(result.has_best && result.has_worst);
  EXPECT_EQ(standing({none, none}, Better::smaller, false, 1).placed, 0u);
}

}  // namespace
}  // namespace remote_touch
