#include "analysis/trace/curve_fits.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace remote_touch::curve_fits_test {
namespace {

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

TEST(FallingCurve, KeepsADecreasingCurve) {
  const std::vector<double> values = {1, 0.9, 0.9, 0.2, 0};
  EXPECT_EQ(isotonic_falling(values, {1, 2, 3, 4, 5}), values);
}

TEST(FallingCurve, PoolsByWeight) {
  EXPECT_EQ(isotonic_falling({1, 0, 3}, {1, 1, 1}), (std::vector<double>{4.0 / 3, 4.0 / 3, 4.0 / 3}));
  EXPECT_EQ(isotonic_falling({1, 0, 0.5}, {1, 3, 1}), (std::vector<double>{1, 0.125, 0.125}));
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
}

TEST(Sinusoid, WithoutValuesIsNan) {
  EXPECT_TRUE(std::isnan(sinusoid_in({}, {}, kHz).amplitude));
}

}  // namespace
}  // namespace remote_touch::curve_fits_test
