// The tally of a measure: what it counts, and its mean, deviation and quantiles.
#include "analysis/tally/measure_tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/analysis/tally/fixed_point_sum.h"

namespace remote_touch::measure_tally_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

MeasureTally tally_of(const std::vector<double>& values) {
  MeasureTally tally;
  for (const double value : values) tally.add(value);
  return tally;
}

// n sum of squares - (sum)^2 in fixed point, divided by n (n - 1). The values are multiples of 2^-60 below
// 2^40.
double expected_variance(const std::vector<double>& values) {
  FixedPointSum numerator, squares;
  std::vector<double> shifted;
  for (const double value : values) squares.add_square(value);
  numerator.add(squares, static_cast<std::int64_t>(values.size()));
  FixedPointSum products;
  for (const double a : values)
    for (const double b : values) products.add_product(a, b);
  numerator.add(products, -1);
  const auto n = static_cast<double>(values.size());
  return numerator.rounded() / (n * (n - 1));
}

TEST(MeasureTally, CountsWhatIsNotFiniteApart) {
  const MeasureTally tally = tally_of({1, kNan, kInfinity, -2, -kInfinity, kNan, kNan});
  EXPECT_EQ(tally.values, 2);
  EXPECT_EQ(tally.unknown, 3);
  EXPECT_EQ(tally.infinite, 2);
  EXPECT_EQ(tally.least, -2);
  EXPECT_EQ(tally.greatest, 1);
  EXPECT_EQ(tally.mean(), -0.5);
  EXPECT_EQ(tally.sketch.count(), 2);
  EXPECT_EQ(tally.contradiction(), "");
}

TEST(MeasureTally, HasNoMeanWithoutValues) {
  const MeasureTally tally = tally_of({kNan});
  EXPECT_TRUE(std::isnan(tally.mean()));
  EXPECT_TRUE(std::isnan(tally.variance()));
  EXPECT_TRUE(std::isnan(tally.quantile(0.5)));
  EXPECT_TRUE(std::isnan(tally_of({3}).variance()));
  EXPECT_EQ(tally_of({3, 3}).variance(), 0);
  EXPECT_EQ(tally.contradiction(), "");
}

TEST(MeasureTally, LosesNothingBesideALargeMean) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(1e8, 1e-3);
  std::vector<double> values(1000);
  for (double& value : values) value = normal(random);
  const double variance = tally_of(values).variance();
  EXPECT_DOUBLE_EQ(variance, expected_variance(values));
  EXPECT_NEAR(std::sqrt(variance), 1e-3, 1e-4);
  for (double& value : values) value += 0x1p40, value -= 0x1p40;  // multiples of 2^-12
  const double shifted = tally_of(values).variance();
  for (double& value : values) value -= 1e8;
  EXPECT_DOUBLE_EQ(shifted, tally_of(values).variance()) << "the variance does not depend on the mean";
}

TEST(MeasureTally, HasTheVarianceOfALongInteger) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 30; ++round) {
    std::vector<double> values(2 + random() % 30);
    for (double& value : values) value = std::exp(3 * normal(random)) * (round % 2 == 0 ? 1 : normal(random));
    EXPECT_DOUBLE_EQ(tally_of(values).variance(), expected_variance(values));
  }
}

TEST(MeasureTally, HasAVarianceForLargeAndTinyValues) {
  for (const double scale : {0x1p500, 0x1p-480, 0x1p-100}) {
    const MeasureTally tally = tally_of({scale, 2 * scale, 4 * scale});
    EXPECT_DOUBLE_EQ(tally.standard_deviation() / scale, std::sqrt(7.0 / 3));
  }
  EXPECT_TRUE(std::isnan(tally_of({1e154, -2e154, 3}).variance())) << "a square is above the largest double";
  EXPECT_TRUE(std::isnan(tally_of({1e308, 1e308}).variance()));
  EXPECT_EQ(tally_of({1e308, 1e308}).mean(), kInfinity);
  EXPECT_EQ(tally_of({1e308, 1e308, -1e308}).mean(), 1e308 / 3);
  EXPECT_EQ(tally_of({1e-200, 2e-200}).variance(), 0) << "squares below the least double are lost";
  EXPECT_GE(tally_of({5e-324, 1e-160, 1.0001e-160}).variance(), 0);
}

TEST(MeasureTally, CountsMinusZeroAsZero) {
  EXPECT_EQ(std::signbit(tally_of({-0.0}).least), false);
  EXPECT_TRUE(tally_of({-0.0, 0.0}) == tally_of({0.0, -0.0}));
}

TEST(MeasureTally, HasQuantilesBetweenItsExtremes) {
  const MeasureTally one = tally_of({1.001});
  for (const double p : {0.0, 0.5, 1.0}) EXPECT_EQ(one.quantile(p), 1.001);
  const MeasureTally tally = tally_of({1.001, 1.002, 1.003, 1.004, 5});
  EXPECT_EQ(tally.quantile(0), 1.001);
  EXPECT_EQ(tally.quantile(0.2), 1.001);
  EXPECT_EQ(tally.quantile(1), 5);
  EXPECT_NEAR(tally.quantile(0.5), 1.003, 1.003 / 64);
  const MeasureTally close = tally_of({1.001, 1.002, 1.003});
  EXPECT_LE(close.quantile(0.5), 1.003) << "the middle of the bucket is 1.0156";
}

TEST(MeasureTally, DoesNotDependOnOrderOrParts) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::vector<double> values = {kNan, kInfinity, 1e140, -3e140, 1e-300, 0, -0.0};
  for (int i = 0; i < 300; ++i) values.push_back(std::exp(10 * normal(random)));
  const MeasureTally whole = tally_of(values);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(values.begin(), values.end(), random);
    MeasureTally merged;
    for (std::size_t at = 0; at < values.size();) {
      const std::size_t count = std::min<std::size_t>(1 + random() % 40, values.size() - at);
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(at);
      merged.add(tally_of({first, first + static_cast<std::ptrdiff_t>(count)}));
      at += count;
    }
    ASSERT_TRUE(merged == whole);
    ASSERT_EQ(merged.variance(), whole.variance());
  }
  values.back() = std::nextafter(values.back(), 0);
  EXPECT_FALSE(tally_of(values) == whole);
}

TEST(MeasureTally, NoticesAContradiction) {
  const auto expect_wrong = [](auto&& change) {
    MeasureTally tally = tally_of({1, 2, kNan});
    change(tally);
    EXPECT_NE(tally.contradiction(), "");
  };
  expect_wrong([](MeasureTally& tally) { tally.unknown = -1; });
  expect_wrong([](MeasureTally& tally) { ++tally.values; });
  expect_wrong([](MeasureTally& tally) { tally.least = 3; });
  expect_wrong([](MeasureTally& tally) { tally.least = kNan; });
  expect_wrong([](MeasureTally& tally) { tally.greatest = kInfinity; });
  expect_wrong([](MeasureTally& tally) { tally.greatest = 4; });
  expect_wrong([](MeasureTally& tally) { tally.values = 0, tally.sketch = {}; });
}

}  // namespace
}  // namespace remote_touch::measure_tally_test
