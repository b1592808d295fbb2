// Statistics of plain numbers: means and extremes, distributions, the sign test, and fits of curves, against
// closed forms, published examples, enumeration and simulation.
#include "analysis/trace/interval_estimates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "analysis/trace/curve_fits.h"

namespace remote_touch::interval_estimates_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// They are NaN if a value is NaN, or if there is none.
TEST(Extremes, AreTheLargestAndTheSmallestValue) {
  EXPECT_EQ(max_of(std::vector<double>{-3, 2, -7}), 2);
  EXPECT_EQ(min_of(std::vector<double>{-3, 2, -7}), -7);
  EXPECT_EQ(max_or_nan(-3, -7), -3);
  EXPECT_EQ(min_or_nan(-3, -7), -7);
  for (const std::vector<double>& values :
       {std::vector<double>{}, {kNan, 1}, {1, kNan}, {1, kNan, 2}, {2, kNan, 1}})
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
  for (const bool all : {false, true}) {
    const auto qualifies = [&](std::size_t) { return all; };
    EXPECT_TRUE(std::isnan(max_where(values.size(), qualifies, value)));
    EXPECT_TRUE(std::isnan(min_where(values.size(), qualifies, value)));
  }
}

TEST(Mean, IsTheSumInItsOrderOverTheCount) {
  EXPECT_EQ(mean({1, 2, 4.5}), 2.5);
  EXPECT_EQ(mean({1e16, 1, -1e16}), 0) << "1 is lost beside 1e16";
  EXPECT_EQ(mean({1e16, -1e16, 1}), 1.0 / 3);
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_FALSE(std::signbit(mean({}))) << "the bits that kNoValue has";
}

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

TEST(RootMeanSquare, NeitherOverflowsNorVanishes) {
  EXPECT_EQ(root_mean_square({}), 0);
  EXPECT_EQ(root_mean_square({0, 0}), 0);
  EXPECT_NEAR(root_mean_square({3, -4}), std::sqrt(12.5), 1e-15);
  EXPECT_NEAR(root_mean_square({3e300, 4e300}) / 1e300, std::sqrt(12.5), 1e-15);
  EXPECT_NEAR(root_mean_square({3e-300, 4e-300}) / 1e-300, std::sqrt(12.5), 1e-15);
  EXPECT_EQ(root_mean_square({1, kInfinity}), kInfinity);
}

TEST(SignTest, IsTheSumOfTheTails) {
  EXPECT_EQ(sign_test(0, 0), 1);
  for (int n = 1; n <= 50; ++n) {
    EXPECT_EQ(sign_test(n, n), 1);
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

// The expected values are sums of integers of arbitrary length. The first examples of McNemar's test are from
// Bentur et al. (2009) and Cavo et al. (2012), as in M. W. Fagerland et al., BMC Med. Res. Methodology 13:91
// (2013), and from R's exact2x2; 86 and 150 are approvals in two surveys, A. Agresti, Categorical Data
// Analysis.
TEST(SignTest, IsMcNemarsExactTestAndPreciseFarOut) {
  EXPECT_NEAR(sign_test(1, 7), 0.0703, 5e-5);
  EXPECT_NEAR(sign_test(6, 16), 0.0525, 5e-5);
  EXPECT_NEAR(sign_test(2, 9), 0.06543, 5e-6);
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

// --- fits of curves ---

TEST(PolynomialFit, FindsTheCoefficientsOfAnExactPolynomial) {
  // The coefficients are of the size of (4.24): from 16 to 3e10 at x below 0.01.
  const std::vector<int> powers = {5, 4, 3, 2, 1};
  const std::vector<double> coefficients = {2.9e10, -6.4e8, 4.8e6, -1.2e4, 16};
  std::vector<double> x, y;
  for (int i = 1; i <= 40; ++i) {
    x.push_back(0.01 * i / 40);
    double sum = 0;
    for (std::size_t k = 0; k < powers.size(); ++k) sum += coefficients[k] * std::pow(x.back(), powers[k]);
    y.push_back(sum);
  }
  const PolynomialFit fit = fit_polynomial(x, y, powers);
  for (std::size_t k = 0; k < powers.size(); ++k)
    EXPECT_NEAR(fit.coefficients[k], coefficients[k], 1e-7 * std::abs(coefficients[k]));
  EXPECT_LT(fit.residual_rms, 1e-12);
  EXPECT_LT(fit.half_width(0.005), 1e-10);
}

// A mean is the fit of the power 0: its standard error is known in closed form.
TEST(PolynomialFit, ConfidenceOfAMeanIsItsStandardError) {
  const std::vector<double> y = {1, 4, 2, 8, 5, 7};
  const PolynomialFit fit = fit_polynomial({1, 2, 3, 4, 5, 6}, y, {0});
  EXPECT_NEAR(fit.coefficients[0], 4.5, 1e-12);
  double squares = 0;
  for (const double value : y) squares += (value - 4.5) * (value - 4.5);
  EXPECT_NEAR(fit.half_width(3), 1.959963984540054 * std::sqrt(squares / 5 / 6), 1e-12);
}

// The band holds the truth in 95 % of many repetitions, with scatter that grows with x.
TEST(PolynomialFit, BandHoldsTheTruthAsOftenAsItSays) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  int held = 0;
  constexpr int kRepetitions = 1000;
  for (int repetition = 0; repetition < kRepetitions; ++repetition) {
    std::vector<double> x, y;
    for (int i = 0; i < 200; ++i) {
      x.push_back(0.01 * i);
      y.push_back(3 * x.back() - x.back() * x.back() + (0.1 + x.back()) * normal(random));
    }
    const PolynomialFit fit = fit_polynomial(x, y, {2, 1, 0});
    held += std::abs(fit.at(1.7) - (3 * 1.7 - 1.7 * 1.7)) < fit.half_width(1.7) ? 1 : 0;
  }
  EXPECT_NEAR(held / double{kRepetitions}, 0.95, 0.025);
}

// No decreasing curve in its neighbourhood is nearer to the values.
TEST(FallingCurve, IsTheNearest) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int repetition = 0; repetition < 50; ++repetition) {
    std::vector<double> values(8), weights(8);
    for (double& value : values) value = uniform(random);
    for (double& weight : weights) weight = 0.1 + uniform(random);
    const std::vector<double> best = isotonic_falling(values, weights);
    EXPECT_TRUE(std::is_sorted(best.rbegin(), best.rend()));
    const auto distance = [&](const std::vector<double>& curve) {
      double sum = 0;
      for (std::size_t i = 0; i < curve.size(); ++i)
        sum += weights[i] * (curve[i] - values[i]) * (curve[i] - values[i]);
      return sum;
    };
    for (int attempt = 0; attempt < 200; ++attempt) {
      std::vector<double> other = best;
      for (double& value : other) value += 0.05 * (uniform(random) - 0.5);
      std::sort(other.rbegin(), other.rend());
      EXPECT_GE(distance(other), distance(best) - 1e-12);
    }
  }
}

TEST(FallingCurve, CrossesALevelByInterpolation) {
  const std::vector<double> x = {0, 10, 20};
  EXPECT_DOUBLE_EQ(crossing(x, {1, 0.75, 0.25}, 0.5), 15);
  EXPECT_DOUBLE_EQ(crossing(x, {1, 0.5, 0.25}, 0.5), 10);
  EXPECT_DOUBLE_EQ(crossing(x, {0.4, 0.3, 0.1}, 0.5), 0);
  EXPECT_DOUBLE_EQ(crossing(x, {1, 0.9, 0.6}, 0.5), 20);
}

constexpr double kHz = 1.5, kTurn_rad = 2 * std::numbers::pi;

struct Signal {
  std::vector<double> time_s, values;
};

// Two periods of 3 + amplitude * cos(2 pi f (t - lag)), and of a part with twice the frequency.
Signal signal(double amplitude, double lag_of_signal_s) {
  constexpr int kCount = 400;
  Signal s;
  for (int i = 0; i < kCount; ++i) {
    const double t = 0.7 + 2 / kHz * i / kCount;
    s.time_s.push_back(t);
    s.values.push_back(3 + amplitude * std::cos(kTurn_rad * kHz * (t - lag_of_signal_s)) +
                       0.5 * std::sin(2 * kTurn_rad * kHz * t));
  }
  return s;
}

Sinusoid part_of(const Signal& s) {
  return sinusoid_in(s.time_s, s.values, kHz);
}

TEST(Sinusoid, HasTheAmplitudeOfItsFrequencyAlone) {
  EXPECT_NEAR(part_of(signal(0.2, 0.1)).amplitude, 0.2, 1e-12);
  EXPECT_NEAR(part_of(signal(0, 0)).amplitude, 0, 1e-12);
  EXPECT_TRUE(std::isnan(sinusoid_in({}, {}, kHz).amplitude));
}

}  // namespace
}  // namespace remote_touch::interval_estimates_test
