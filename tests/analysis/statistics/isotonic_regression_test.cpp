#include "analysis/statistics/isotonic_regression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace remote_touch::isotonic_regression_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::isotonic_regression_test
