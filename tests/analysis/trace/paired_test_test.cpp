// Tests and intervals for pairs: closed forms, published examples, enumeration and simulation.
#include "analysis/trace/paired_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace remote_touch::paired_test_test {
namespace {

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
