#include "analysis/statistics/paired_bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace remote_touch::paired_bootstrap_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// Returns the sorted means of all n^n possible draws of one group, which are equally likely.
std::vector<double> all_means(const std::vector<double>& group) {
  const std::size_t n = group.size();
  std::size_t draws = 1;
  for (std::size_t i = 0; i < n; ++i) draws *= n;
  std::vector<double> means;
  for (std::size_t draw = 0; draw < draws; ++draw) {
    double sum = 0;
    for (std::size_t i = 0, rest = draw; i < n; ++i, rest /= n) sum += group[rest % n];
    means.push_back(sum / static_cast<double>(n));
  }
  std::sort(means.begin(), means.end());
  return means;
}

TEST(PairedBootstrap, QuantilesAreThoseOfAllDraws) {
  const std::vector<double> group = {-3, -1, 0.5, 2, 4, 11};
  const std::vector<double> exact = all_means(group);
  const MeanDifference drawn = bootstrap_mean({group}, 7, 40000);
  // 40000 draws estimate a fraction of 0.025 with a standard deviation of about 0.0008.
  const auto at = [&](double fraction) { return exact[static_cast<std::size_t>(fraction * exact.size())]; };
  EXPECT_GE(drawn.low, at(0.025 - 0.004));
  EXPECT_LE(drawn.low, at(0.025 + 0.004));
  EXPECT_GE(drawn.high, at(0.975 - 0.004));
  EXPECT_LE(drawn.high, at(0.975 + 0.004));
  EXPECT_NEAR(drawn.mean, 13.5 / 6, 1e-15);
  EXPECT_EQ(drawn.pairs, 6);
}

TEST(PairedBootstrap, DrawsEachGroupSeparately) {
  // All numbers of a group are equal and the groups lie far apart, so every draw has the same mean.
  const MeanDifference mean = bootstrap_mean({{1, 1, 1}, {100, 100}}, 1);
  EXPECT_EQ(mean.low, mean.mean);
  EXPECT_EQ(mean.high, mean.mean);
  EXPECT_NEAR(mean.mean, 203.0 / 5, 1e-14);
}

TEST(PairedBootstrap, OnlyTheSameKeyGivesTheSameBits) {
  const std::vector<double> group = {0.1, 3, -2, 7, 0.4, 1.5, -0.2, 2};
  const MeanDifference once = bootstrap_mean({group}, 3), again = bootstrap_mean({group}, 3);
  EXPECT_EQ(once.low, again.low);
  EXPECT_EQ(once.high, again.high);
  EXPECT_NE(once.low, bootstrap_mean({group}, 4).low);
}

TEST(PairedBootstrap, SkipsNan) {
  const MeanDifference with = bootstrap_mean({{1, kNan, 4}, {kNan}, {2, 6}}, 3);
  const MeanDifference without = bootstrap_mean({{1, 4}, {}, {2, 6}}, 3);
  EXPECT_EQ(with.pairs, 4);
  EXPECT_EQ(with.low, without.low);
  EXPECT_EQ(with.high, without.high);
  EXPECT_TRUE(std::isnan(bootstrap_mean({{kNan}}, 1).mean));
  EXPECT_EQ(bootstrap_mean({{5}}, 1).mean, 5);
  EXPECT_TRUE(std::isnan(bootstrap_mean({{5}}, 1).low));
}

TEST(PairedBootstrap, HasNoIntervalWithoutDraws) {
  for (const int draws : {0, -1}) {
    const MeanDifference mean = bootstrap_mean({{1, 3}}, 1, draws);
    EXPECT_EQ(mean.mean, 2);
    EXPECT_TRUE(std::isnan(mean.low) && std::isnan(mean.high));
  }
}

}  // namespace
}  // namespace remote_touch::paired_bootstrap_test
