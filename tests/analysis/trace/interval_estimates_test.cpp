#include "analysis/trace/interval_estimates.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace remote_touch::means_and_extremes_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Extremes, AreTheLargestAndTheSmallestValue) {
  EXPECT_EQ(max_of(std::vector<double>{-3, 2, -7}), 2);
  EXPECT_EQ(min_of(std::vector<double>{-3, 2, -7}), -7);
  EXPECT_EQ(max_or_nan(-3, -7), -3);
  EXPECT_EQ(min_or_nan(-3, -7), -7);
}

TEST(Extremes, AreNanIfAValueIsNanOrMissing) {
  EXPECT_TRUE(std::isnan(max_of({})) && std::isnan(min_of({})));
  for (const std::vector<double>& values :
       {std::vector<double>{kNan, 1}, {1, kNan}, {1, kNan, 2}, {2, kNan, 1}})
    EXPECT_TRUE(std::isnan(max_of(values)) && std::isnan(min_of(values)));
  EXPECT_TRUE(std::isnan(max_or_nan(1, kNan)) && std::isnan(max_or_nan(kNan, 1)));
  EXPECT_TRUE(std::isnan(min_or_nan(1, kNan)) && std::isnan(min_or_nan(kNan, 1)));
}

TEST(Extremes, AreOverTheValuesThatQualify) {
  const std::vector<double> values = {4, kNan, -3, 2};
  const auto value = [&](std::size_t i) { return values[i]; };
  const auto is_even = [](std::size_t i) { return i % 2 == 0; };
  EXPECT_EQ(max_where(values.size(), is_even, value), 4);
  EXPECT_EQ(min_where(values.size(), is_even, value), -3);
}

TEST(Extremes, AreNanIfNoValueQualifiesOrOneThatDoesIsNan) {
  const std::vector<double> values = {4, kNan};
  const auto value = [&](std::size_t i) { return values[i]; };
  for (const bool all : {false, true}) {
    const auto qualifies = [&](std::size_t) { return all; };
    EXPECT_TRUE(std::isnan(max_where(values.size(), qualifies, value)));
    EXPECT_TRUE(std::isnan(min_where(values.size(), qualifies, value)));
  }
}

}  // namespace
}  // namespace remote_touch::means_and_extremes_test

namespace remote_touch::mean_of_numbers_test {
namespace {

TEST(Mean, IsTheSumInItsOrderOverTheCount) {
  EXPECT_EQ(mean({1, 2, 4.5}), 2.5);
  EXPECT_EQ(mean({1e16, 1, -1e16}), 0) << "1 is lost beside 1e16";
  EXPECT_EQ(mean({1e16, -1e16, 1}), 1.0 / 3);
}

TEST(Mean, IsAPositiveNanForAnEmptyList) {
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_FALSE(std::signbit(mean({}))) << "the bits that kNoValue has";
}

}  // namespace
}  // namespace remote_touch::mean_of_numbers_test

namespace remote_touch::interval_estimates_test {
namespace {

// The distribution of 1 degree of freedom is Cauchy's, and that of 2 is t / sqrt(2 + t^2). Quantiles are
// those of printed tables.
TEST(Student, TheDistributionIsThatOfTheTables) {
  for (const double t : {0.0, 0.3, 1.0, 7.0, 500.0}) {
    EXPECT_NEAR(student_two_sided(t, 1), 1 - 2 / M_PI * std::atan(t), 1e-14) << t;
    EXPECT_NEAR(student_two_sided(t, 2), 1 - t / std::sqrt(2 + t * t), 1e-14) << t;
    EXPECT_EQ(student_two_sided(-t, 5), student_two_sided(t, 5));
  }
  EXPECT_NEAR(student_quantile(0.05, 1), 12.7062, 5e-5);
  EXPECT_NEAR(student_quantile(0.05, 4), 2.7764, 5e-5);
  EXPECT_NEAR(student_quantile(0.05, 5), 2.5706, 5e-5);
  EXPECT_NEAR(student_quantile(0.05, 11), 2.2010, 5e-5);
  EXPECT_NEAR(student_quantile(0.01, 30), 2.7500, 5e-5);
  EXPECT_NEAR(student_quantile(0.05, 100000), 1.95999, 5e-5);
}

// Exact intervals of fractions, and quantiles.

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The exact interval covers the probability in at least 95 % of the experiments at every probability.
TEST(ExactInterval, CoversAtEveryProbability) {
  double least = 1;
  for (const int runs : {5, 12, 20, 40, 200}) {
    std::vector<std::pair<double, double>> intervals;
    for (int events = 0; events <= runs; ++events) intervals.push_back(exact_interval(events, runs));
    for (double p = 0.0005; p < 1; p += 0.001) {
      double covered = 0;
      for (int events = 0; events <= runs; ++events)
        if (intervals[events].first <= p && p <= intervals[events].second)
          covered += probability_of_at_most(events, runs, p) -
                     (events > 0 ? probability_of_at_most(events - 1, runs, p) : 0);
      least = std::min(least, covered);
    }
  }
  EXPECT_GE(least, 0.95);
}

// Runs that draw nothing: nothing is uncertain but the unknown outcomes.
TEST(ExactFraction, HasAnIntervalOnlyIfOutcomesAreUnknown) {
  const Estimate known = exact_fraction({3, 1, 0});
  EXPECT_EQ(known.value, 0.75);
  EXPECT_TRUE(std::isnan(known.low) && std::isnan(known.high));
  EXPECT_EQ(known.method, kExactMethod);
  const Estimate unknown = exact_fraction({3, 1, 4});
  EXPECT_EQ(unknown.value, 0.75);
  EXPECT_EQ(unknown.low, 3.0 / 8);
  EXPECT_EQ(unknown.high, 7.0 / 8);
}

TEST(EstimatedQuantile, CoversAsOftenAsItSays) {
  std::mt19937 random(2);
  for (const double q : {0.5, 0.95}) {
    int covered = 0;
    for (int trial = 0; trial < 2000; ++trial) {
      std::vector<double> values(90);
      for (double& v : values) v = std::generate_canonical<double, 53>(random);
      const Estimate e = estimated_quantile(values, q);
      covered += !(e.low > q) && !(e.high < q) ? 1 : 0;
    }
    EXPECT_GE(covered, 0.94 * 2000) << q;
  }
  const Estimate few = estimated_quantile({3, 1, kNan, 2, 5, 4}, 0.5);
  EXPECT_EQ(few.value, 3);
  EXPECT_TRUE(std::isnan(few.low) && std::isnan(few.high));
  EXPECT_EQ(few.unknown, 1);
  const Estimate six = estimated_quantile({3, 1, 2, 5, 4, 6}, 0.5);
  EXPECT_EQ(six.low, 1);
  EXPECT_EQ(six.high, 6);
  std::vector<double> hundred;
  for (int i = 1; i <= 100; ++i) hundred.push_back(i);
  EXPECT_EQ(estimated_quantile(hundred, 0.07).value, 7) << "0.07 times 100 is above 7 by a rounding";
}

}  // namespace
}  // namespace remote_touch::interval_estimates_test
