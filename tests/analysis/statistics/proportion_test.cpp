// Confidence intervals of counted proportions.
#include "analysis/statistics/proportion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace remote_touch::proportion_test {
namespace {

double binomial(int events, int runs, double p) {
  return std::exp(std::lgamma(runs + 1.0) - std::lgamma(events + 1.0) - std::lgamma(runs - events + 1.0) +
                  events * std::log(p) + (runs - events) * std::log1p(-p));
}

// The intervals are those of R. G. Newcombe, Statistics in Medicine 17 (1998), table I, method 3, and of any
// table of the method.
TEST(WilsonInterval, IsThatOfPublishedTables) {
  const struct {
    int events, runs;
    double low, high;
  } known[] = {{81, 263, 0.2553, 0.3662}, {15, 148, 0.0624, 0.1605}, {0, 20, 0.0, 0.1611},
               {1, 29, 0.0061, 0.1718},   {0, 10, 0.0, 0.2775},      {5, 10, 0.2366, 0.7634},
               {10, 10, 0.7225, 1.0},     {0, 1, 0.0, 0.7935},       {4, 4, 0.5101, 1.0}};
  for (const auto& k : known) {
    const auto [low, high] = wilson_interval(k.events, k.runs);
    EXPECT_NEAR(low, k.low, 5e-5) << k.events << "/" << k.runs;
    EXPECT_NEAR(high, k.high, 5e-5) << k.events << "/" << k.runs;
  }
}

// Its definition: the ends are the probabilities from which the count is z standard deviations away.
TEST(WilsonInterval, EndsAreZDeviationsAway) {
  for (const double z : {1.0, kTwoSided95, 3.0})
    for (int runs = 1; runs <= 60; runs += 7)
      for (int events = 0; events <= runs; ++events) {
        const auto [low, high] = wilson_interval(events, runs, z);
        const double fraction = static_cast<double>(events) / runs;
        EXPECT_LE(low, fraction);
        EXPECT_GE(high, fraction);
        EXPECT_NEAR(fraction - low, z * std::sqrt(low * (1 - low) / runs), 1e-9);
        EXPECT_NEAR(high - fraction, z * std::sqrt(high * (1 - high) / runs), 1e-9);
      }
}

TEST(WilsonInterval, IsSymmetric) {
  for (int runs = 1; runs <= 40; ++runs)
    for (int events = 0; events <= runs; ++events) {
      const auto [low, high] = wilson_interval(events, runs);
      const auto [mirrored_low, mirrored_high] = wilson_interval(runs - events, runs);
      EXPECT_NEAR(low, 1 - mirrored_high, 1e-12);
      EXPECT_NEAR(high, 1 - mirrored_low, 1e-12);
    }
}

TEST(WilsonInterval, NarrowsWithMoreRuns) {
  EXPECT_EQ(wilson_interval(0, 0), std::make_pair(0.0, 1.0));
  double before = 1;
  for (const int runs : {4, 8, 20, 100, 10000, 1000000}) {
    const auto [low, high] = wilson_interval(runs / 4, runs);
    EXPECT_LT(high - low, before) << runs;
    before = high - low;
  }
  EXPECT_LT(before, 0.002);
}

// The interval contains the true probability in 95 % of the experiments, averaged over all probabilities,
// whatever the number of runs.
TEST(WilsonInterval, CoversAsOftenAsItSays) {
  constexpr int kSteps = 2000;
  for (const int runs : {4, 10, 20, 100}) {
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double p = (i + 0.5) / kSteps;
      for (int events = 0; events <= runs; ++events) {
        const auto [low, high] = wilson_interval(events, runs);
        if (low <= p && p <= high) sum += binomial(events, runs, p);
      }
    }
    EXPECT_NEAR(sum / kSteps, 0.95, 0.01) << runs;
  }
}

}  // namespace
}  // namespace remote_touch::proportion_test
