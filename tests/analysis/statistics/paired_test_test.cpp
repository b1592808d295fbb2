// Tests and intervals for pairs: closed forms, published examples, enumeration and simulation.
#include "analysis/statistics/paired_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace remote_touch::paired_test_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(RootMeanSquare, NeitherOverflowsNorVanishes) {
  EXPECT_EQ(root_mean_square({}), 0);
  EXPECT_EQ(root_mean_square({0, 0}), 0);
  EXPECT_NEAR(root_mean_square({3, -4}), std::sqrt(12.5), 1e-15);
  EXPECT_NEAR(root_mean_square({3e300, 4e300}) / 1e300, std::sqrt(12.5), 1e-15);
  EXPECT_NEAR(root_mean_square({3e-300, 4e-300}) / 1e-300, std::sqrt(12.5), 1e-15);
  EXPECT_EQ(root_mean_square({1, kInfinity}), kInfinity);
}

// If all n pairs differ the same way, p is 2 / 2^n.
TEST(SignTest, IsThatOfAFairCoin) {
  EXPECT_EQ(sign_test(0, 0), 1);
  EXPECT_EQ(sign_test(0, 5), 0.0625);
  for (int n = 1; n <= 900; ++n)
    EXPECT_NEAR(sign_test(0, n) / std::min(1.0, std::ldexp(2.0, -n)), 1, 1e-12) << n;
  for (int n = 1; n <= 900; ++n) EXPECT_EQ(sign_test(n, n), 1);
  for (int n = 1; n <= 900; ++n) EXPECT_EQ(sign_test(n, n - 1), 1);
}

TEST(SignTest, IsTheSumOfTheTails) {
  for (int n = 1; n <= 50; ++n) {
    double choose = 1, tail = 0;  // integers below 2^53
    for (int k = 0; 2 * k < n; ++k) {
      tail += choose;
      const double p = std::min(1.0, std::ldexp(tail, 1 - n));
      EXPECT_NEAR(sign_test(k, n - k) / p, 1, 1e-13) << k << " " << n;
      EXPECT_EQ(sign_test(k, n - k), sign_test(n - k, k));
      choose = choose * (n - k) / (k + 1);
    }
  }
}

// Bentur et al. (2009) and Cavo et al. (2012), as in M. W. Fagerland et al., BMC Med. Res. Methodology 13:91
// (2013); the example of R's exact2x2; approval in two surveys, A. Agresti, Categorical Data Analysis, whose
// z = -4.17 is p = 3.1e-5 when approximated.
TEST(SignTest, IsMcNemarsExactTest) {
  EXPECT_NEAR(sign_test(1, 7), 0.0703, 5e-5);
  EXPECT_NEAR(sign_test(6, 16), 0.0525, 5e-5);
  EXPECT_NEAR(sign_test(2, 9), 0.06543, 5e-6);
  EXPECT_NEAR(sign_test(86, 150), 3.716e-5, 5e-9);
}

// The expected values are sums of integers of arbitrary length.
TEST(SignTest, IsPreciseFarOut) {
  EXPECT_NEAR(sign_test(86, 150) / 3.715936139571442342e-5, 1, 1e-12);
  EXPECT_NEAR(sign_test(400, 600) / 2.728464156066018426e-10, 1, 1e-12);
  EXPECT_NEAR(sign_test(1000, 1500) / 1.332587164837625313e-23, 1, 1e-12);
  EXPECT_NEAR(sign_test(10000, 10500) / 4.915393992266734560e-4, 1, 1e-12);
  EXPECT_NEAR(sign_test(24600, 25400) / 3.525014588014972983e-4, 1, 1e-12);
  EXPECT_NEAR(sign_test(3, 1000) / 3.923720417925806834e-294, 1, 1e-12);
}

// The expected values are those of the normal distribution with a continuity correction.
TEST(SignTest, IsNormalForLargeCounts) {
  for (const std::int64_t n : {10000, 1000000, 20000000})
    for (const double z : {0.1, 1.0, 2.0, 3.0, 4.0}) {
      const auto apart = static_cast<std::int64_t>(z * std::sqrt(static_cast<double>(n)) / 2);
      const double corrected = static_cast<double>(2 * apart - 1) / std::sqrt(static_cast<double>(n));
      const double normal = std::erfc(corrected / std::sqrt(2.0));
      EXPECT_NEAR(sign_test(n / 2 - apart, n / 2 + apart) / normal, 1, 3e-7 + 40.0 / static_cast<double>(n))
          << n << " " << z;
    }
}

TEST(SignTest, UnderflowsToZero) {
  EXPECT_EQ(sign_test(0, 10000000), 0);
  EXPECT_EQ(sign_test(4000000, 10000000), 0);
  EXPECT_EQ(sign_test(10000000, 10000000), 1);
  double before = 1;
  for (int fewer = 500; fewer >= 0; fewer -= 20) {
    const double p = sign_test(fewer, 1000 - fewer);
    EXPECT_LE(p, before);
    EXPECT_GT(p, 0) << fewer;
    before = p;
  }
}

// The bound is never below the exact p: the fraction of all choices of signs that give at least as large a
// sum.
TEST(SymmetryTest, BoundsThePOfAllSigns) {
  std::mt19937_64 random(7);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<double> d(12);
    for (double& x : d) x = static_cast<double>(random() % 1000) / 1000 - (trial < 20 ? 0.05 : 0.5);
    const auto sum_of = [&](unsigned signs) {
      double sum = 0;
      for (std::size_t i = 0; i < d.size(); ++i) sum += (signs >> i & 1u) != 0 ? -d[i] : d[i];
      return std::abs(sum);
    };
    int as_large = 0;
    for (unsigned signs = 0; signs < 4096; ++signs) as_large += sum_of(signs) >= sum_of(0) - 1e-12 ? 1 : 0;
    EXPECT_GE(symmetry_test(d), as_large / 4096.0);
  }
}

TEST(SymmetryTest, DetectsFewLargeDifferencesAmongManySmallOnes) {
  std::vector<double> d(5000, 1e-12);
  for (std::size_t i = 0; i < d.size(); i += 2) d[i] = -1e-12;
  EXPECT_EQ(symmetry_test(d), 1);
  d.insert(d.end(), 40, 0.5);
  EXPECT_NEAR(symmetry_test(d), 2 * std::exp(-20), 1e-13);
  EXPECT_GT(sign_test(2540, 2500), 0.5);
  std::vector<double> tiny = d, huge = d;
  for (double& x : tiny) x *= 1e-290;
  for (double& x : huge) x *= 1e300;
  EXPECT_NEAR(symmetry_test(tiny), symmetry_test(d), 1e-14);
  EXPECT_NEAR(symmetry_test(huge), symmetry_test(d), 1e-14);
  EXPECT_EQ(symmetry_test({}), 1);
  EXPECT_EQ(symmetry_test({0, 0}), 1);
}

// R, PropCIs 0.3: diffpropci.mp(b = 40, c = 20, n = 160, conf.level = 0.95).
TEST(PairedDifferenceInterval, IsThePublishedOne) {
  const auto [low, high] = paired_difference_interval(20, 40, 160);
  EXPECT_NEAR(low, -0.21601726, 5e-9);
  EXPECT_NEAR(high, -0.03089632, 5e-9);
}

TEST(PairedDifferenceInterval, IsSymmetricAndBounded) {
  EXPECT_EQ(paired_difference_interval(0, 0, 0), std::make_pair(-1.0, 1.0));
  EXPECT_EQ(paired_difference_interval(1, 0, 1).second, 1);
  EXPECT_EQ(paired_difference_interval(0, 1, 1).first, -1);
  for (int pairs = 1; pairs <= 30; ++pairs)
    for (int plus = 0; plus <= pairs; ++plus)
      for (int minus = 0; plus + minus <= pairs; ++minus) {
        const auto [low, high] = paired_difference_interval(plus, minus, pairs);
        const auto [mirrored_low, mirrored_high] = paired_difference_interval(minus, plus, pairs);
        EXPECT_DOUBLE_EQ(low, -mirrored_high);
        EXPECT_DOUBLE_EQ(high, -mirrored_low);
        EXPECT_LT(low, high);
        EXPECT_TRUE(low >= -1 && high <= 1);
      }
}

// The pairs are drawn with known probabilities, with integers only. Enumeration gives a coverage of 93.7 %
// for 20 pairs of which most differ. In the other cases it is 94.6 % or more, up to 100 % if few pairs
// differ.
TEST(PairedDifferenceInterval, CoversAsOftenAsItSays) {
  constexpr int kExperiments = 10000;
  const struct {
    int plus, minus;  // probabilities in 1/1000
  } truths[] = {{50, 50}, {200, 100}, {10, 10}, {300, 20}, {400, 400}, {3, 0}};
  std::mt19937_64 random(2005);
  for (const int pairs : {20, 100, 300})
    for (const auto& truth : truths) {
      int covered = 0;
      for (int i = 0; i < kExperiments; ++i) {
        int plus = 0, minus = 0;
        for (int pair = 0; pair < pairs; ++pair) {
          const auto drawn = static_cast<int>(random() % 1000);
          plus += drawn < truth.plus ? 1 : 0, minus += drawn >= 1000 - truth.minus ? 1 : 0;
        }
        const auto [low, high] = paired_difference_interval(plus, minus, pairs);
        const double difference = (truth.plus - truth.minus) / 1000.0;
        covered += low <= difference && difference <= high ? 1 : 0;
      }
      const double min = pairs == 20 && truth.plus == 400 ? 0.932 : 0.941;
      EXPECT_GT(covered, min * kExperiments) << pairs << " " << truth.plus << " " << truth.minus;
      if (pairs == 300 && truth.plus >= 50) {
        EXPECT_NEAR(covered, 0.95 * kExperiments, 0.01 * kExperiments) << truth.plus << " " << truth.minus;
      }
    }
}

// The numbers 1, 2, 3 and 6 have the mean 3 and the variance 14/3; the variance of the mean is 14/12.
TEST(MeanDifference, IsMeanAndStandardErrorByHand) {
  const MeanDifference m = mean_difference({1, kNaN, 2, 3, 6, kNaN});
  EXPECT_EQ(m.pairs, 4);
  EXPECT_EQ(m.mean, 3);
  EXPECT_NEAR(m.low, 3 - kTwoSided95 * std::sqrt(14.0 / 12), 1e-14);
  EXPECT_NEAR(m.high, 3 + kTwoSided95 * std::sqrt(14.0 / 12), 1e-14);
}

TEST(MeanDifference, IsNanWithTooFewPairs) {
  const MeanDifference none = mean_difference({kNaN}), one = mean_difference({4});
  EXPECT_EQ(none.pairs, 0);
  EXPECT_TRUE(std::isnan(none.mean) && std::isnan(none.low) && std::isnan(none.high));
  EXPECT_EQ(one.mean, 4);
  EXPECT_TRUE(std::isnan(one.low) && std::isnan(one.high));
  const MeanDifference equal = mean_difference({0, 0, 0});
  EXPECT_TRUE(equal.mean == 0 && equal.low == 0 && equal.high == 0);
}

// The adjusted values are 0.005 * 4, 0.01 * 3, 0.03 * 2, and 0.04 * 1, which is raised to the value before
// it.
TEST(HolmAdjusted, EqualsAnExampleComputedByHand) {
  const std::vector<double> adjusted = holm_adjusted({0.01, 0.04, 0.03, 0.005});
  const double expected[] = {0.03, 0.06, 0.06, 0.02};
  ASSERT_EQ(adjusted.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-15) << i;
}

TEST(HolmAdjusted, IsNeverAboveOne) {
  EXPECT_TRUE(holm_adjusted({}).empty());
  EXPECT_EQ(holm_adjusted({0.02}), std::vector<double>{0.02});
  EXPECT_EQ(holm_adjusted({1, 0.4, 1, 0.9}), (std::vector<double>{1, 1, 1, 1}));
  EXPECT_EQ(holm_adjusted({0.25, 0.25}), (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(holm_adjusted({0, 0, 1}), (std::vector<double>{0, 0, 1}));
}

}  // namespace
}  // namespace remote_touch::paired_test_test
