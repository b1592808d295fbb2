#include "analysis/statistics/polynomial_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace remote_touch::polynomial_fit_test {
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

}  // namespace
}  // namespace remote_touch::polynomial_fit_test
