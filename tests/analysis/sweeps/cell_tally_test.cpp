#include "analysis/sweeps/sweep_tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "tests/analysis/sweeps/example_tally.h"
#include "tests/analysis/sweeps/fixed_point_sum.h"
#include "tests/support/test_files.h"

namespace remote_touch::cell_tally_test {
namespace {

// Quantiles of a sketch against those of the sorted values.

QuantileSketch sketch_of(const std::vector<double>& values) {
  QuantileSketch sketch;
  for (const double value : values) sketch.add(value);
  return sketch;
}

// x_k, k = max(1, ceil(p n)).
double sorted_quantile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  const double rank = std::max(1.0, std::ceil(p * static_cast<double>(values.size())));
  return values[static_cast<std::size_t>(rank) - 1];
}

void expect_near_quantiles(const std::vector<double>& values) {
  const QuantileSketch sketch = sketch_of(values);
  for (const double p : {0.0, 0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.9, 0.99, 0.999, 1.0}) {
    const double exact = sorted_quantile(values, p);
    ASSERT_LE(std::abs(sketch.quantile(p) - exact), std::abs(exact) / 64) << "p " << p << ", exact " << exact;
  }
}

TEST(QuantileSketch, HasTheQuantilesOfTheSortedValues) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const std::size_t count : {1u, 2u, 3u, 10u, 101u, 4000u}) {
    std::vector<double> log_normal(count), symmetric(count), wide(count), events(count), close(count);
    for (std::size_t i = 0; i < count; ++i) {
      log_normal[i] = std::exp(0.3 * normal(random));
      symmetric[i] = normal(random);
      wide[i] = std::exp(200 * normal(random)) * (random() % 2 == 0 ? 1 : -1);
      events[i] = random() % 4 == 0 ? 1 : 0;
      close[i] = 1e8 + 1e-3 * normal(random);
    }
    for (const auto* values : {&log_normal, &symmetric, &wide, &events, &close})
      expect_near_quantiles(*values);
  }
}

// The error of 1/64 occurs at the lower end of the first bucket of a power of two; no bound below it would
// hold.
TEST(QuantileSketch, HasTheStatedErrorAtTheEndsOfEveryBucket) {
  double largest = 0;
  for (std::int32_t bucket = QuantileSketch::bucket_of(0x1p-1022); bucket <= QuantileSketch::bucket_of(1e308);
       ++bucket) {
    const double middle = QuantileSketch::middle_of(bucket);
    ASSERT_EQ(QuantileSketch::bucket_of(middle), bucket);
    ASSERT_EQ(QuantileSketch::bucket_of(-middle), -bucket);
    // The least and the greatest double of the bucket.
    const auto low = std::bit_cast<double>(static_cast<std::uint64_t>(bucket - 1) << 47);
    const double high = std::nextafter(std::bit_cast<double>(static_cast<std::uint64_t>(bucket) << 47), 0);
    ASSERT_EQ(QuantileSketch::bucket_of(low), bucket);
    ASSERT_EQ(QuantileSketch::bucket_of(high), bucket);
    ASSERT_EQ(QuantileSketch::bucket_of(std::nextafter(low, 0)), bucket - 1);
    largest = std::max({largest, (middle - low) / low, (high - middle) / high});
  }
  EXPECT_EQ(largest, 1.0 / 64);
}

TEST(QuantileSketch, IsExactForZeroAndNearSubnormals) {
  EXPECT_EQ(QuantileSketch::bucket_of(0.0), 0);
  EXPECT_EQ(QuantileSketch::bucket_of(-0.0), 0);
  EXPECT_EQ(QuantileSketch::middle_of(0), 0);
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(QuantileSketch::bucket_of(least), 1);
  EXPECT_EQ(QuantileSketch::bucket_of(-least), -1);
  for (const double value : {least, 1e-310, 0x1.fffffffffffffp-1023})
    EXPECT_LE(std::abs(QuantileSketch::middle_of(QuantileSketch::bucket_of(value)) - value), 0x1p-1028);
  EXPECT_TRUE(std::isfinite(
      QuantileSketch::middle_of(QuantileSketch::bucket_of(std::numeric_limits<double>::max()))));
}

TEST(QuantileSketch, NumbersBucketsInTheOrderOfTheirValues) {
  const std::vector<double> increasing = {-1e308, -2, -1.04, -1, -1e-320, 0, 1e-320, 1e-300, 1, 1.04, 1e308};
  for (std::size_t i = 1; i < increasing.size(); ++i)
    EXPECT_LT(QuantileSketch::bucket_of(increasing[i - 1]), QuantileSketch::bucket_of(increasing[i]));
  EXPECT_EQ(QuantileSketch::bucket_of(1.0), QuantileSketch::bucket_of(1 + 0.99 / 32));
  EXPECT_EQ(QuantileSketch::bucket_of(1.0) + 1, QuantileSketch::bucket_of(1 + 1.0 / 32));
}

TEST(QuantileSketch, DoesNotDependOnOrderOrParts) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  std::vector<double> values(1000);
  for (double& value : values) value = std::round(4 * normal(random)) / 4 * std::exp(normal(random));
  const QuantileSketch whole = sketch_of(values);
  EXPECT_EQ(whole.count(), 1000);
  std::shuffle(values.begin(), values.end(), random);
  EXPECT_EQ(sketch_of(values), whole);
  QuantileSketch merged;
  for (std::size_t at = 0; at < values.size(); at += 50) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(at);
    merged.add(sketch_of({first, first + 50}));
  }
  EXPECT_EQ(merged, whole);
  merged.add(merged);
  EXPECT_EQ(merged.count(), 2000);
  EXPECT_EQ(merged.quantile(0.3), whole.quantile(0.3));
}

TEST(QuantileSketch, IsNanWithoutValues) {
  EXPECT_TRUE(std::isnan(QuantileSketch().quantile(0.5)));
  EXPECT_EQ(QuantileSketch().count(), 0);
}

TEST(QuantileSketch, ReadsItsPairsAndRefusesOthers) {
  const QuantileSketch sketch = sketch_of({-3, 0, 0, 1, 1.01, 1e300});
  EXPECT_EQ(QuantileSketch::from_pairs(sketch.pairs()), sketch);
  EXPECT_EQ(QuantileSketch::from_pairs({}), QuantileSketch());
  using Pairs = std::vector<std::pair<std::int32_t, std::int64_t>>;
  constexpr std::int64_t kMany = std::numeric_limits<std::int64_t>::max();
  for (const Pairs& wrong : {Pairs{{1, 0}},
                             {{1, -1}},
                             {{2, 1}, {1, 1}},
                             {{1, 1}, {1, 1}},
                             {{65505, 1}},
                             {{-65505, 1}},
                             {{1, kMany}, {2, 1}}})
    EXPECT_FALSE(QuantileSketch::from_pairs(wrong).has_value());
}

// The tally of a cell.

const TallyLayout kLayout{3, 3, {1}};

CellTally tally_of(const std::vector<std::uint64_t>& numbers) {
  CellTally tally(kLayout);
  for (const std::uint64_t number : numbers)
    if (const ExampleRun run = example_run(number); run.error.empty())
      tally.add_done(kLayout, number, run.values, run.notes);
    else
      tally.add_failed(number, run.error);
  return tally;
}

TEST(CellTally, CountsItsRuns) {
  CellTally tally(kLayout);
  const double nan = std::nan("");
  tally.add_done(kLayout, 12, std::vector<double>{1.5, 1, nan}, 0b101);
  tally.add_done(kLayout, 10, std::vector<double>{2.5, 1, 3}, 0b001);
  tally.add_done(kLayout, 11, std::vector<double>{3.5, nan, 4}, 0);
  tally.add_failed(19, "late"), tally.add_failed(15, "early"), tally.add_failed(17, "between");
  EXPECT_EQ(tally.done, 3);
  EXPECT_EQ(tally.failed, 3);
  EXPECT_EQ(tally.runs(), 6);
  EXPECT_EQ(tally.first_failed, 15u);
  EXPECT_EQ(tally.first_error, "early");
  EXPECT_EQ(tally.measures[0].mean(), 2.5);
  EXPECT_EQ(tally.measures[1].unknown, 1);
  EXPECT_EQ(tally.measures[2].values, 2);
  EXPECT_EQ(tally.notes[0], (NoteTally{2, 10}));
  EXPECT_EQ(tally.notes[1], NoteTally());
  EXPECT_EQ(tally.notes[2], (NoteTally{1, 12}));
  EXPECT_EQ(tally.events[0], (std::vector<std::uint64_t>{10, 12}));
  EXPECT_EQ(tally.contradiction(), "");
}

TEST(CellTally, ListsNoRunsWithoutEvents) {
  const TallyLayout layout{1, 0, {}};
  CellTally tally(layout);
  tally.add_done(layout, 0, std::vector<double>{1}, 0);
  EXPECT_TRUE(tally.events.empty());
  EXPECT_TRUE(tally.notes.empty());
}

TEST(CellTally, IsTheSameForAnyOrderAndParts) {
  std::mt19937_64 random(1);
  std::vector<std::uint64_t> numbers = numbers_below(200);
  const CellTally whole = tally_of(numbers);
  for (int round = 0; round < 30; ++round) {
    std::shuffle(numbers.begin(), numbers.end(), random);
    std::vector<CellTally> parts;
    for (std::size_t at = 0; at < numbers.size();) {
      const std::size_t count = std::min<std::size_t>(random() % 30, numbers.size() - at);
      const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(at);
      parts.push_back(tally_of({first, first + static_cast<std::ptrdiff_t>(count)}));
      at += count;
    }
    // Merged in pairs, as parts of parts.
    while (parts.size() > 1) {
      const std::size_t at = random() % (parts.size() - 1);
      parts[at].add(parts[at + 1]);
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(at) + 1);
    }
    ASSERT_TRUE(parts[0] == whole);
  }
}

TEST(CellTally, NoticesAContradiction) {
  const auto expect_wrong = [](auto&& change) {
    CellTally tally = tally_of(numbers_below(40));
    ASSERT_EQ(tally.contradiction(), "");
    change(tally);
    EXPECT_NE(tally.contradiction(), "");
  };
  expect_wrong([](CellTally& tally) { ++tally.done; });
  expect_wrong([](CellTally& tally) { tally.failed = -1; });
  expect_wrong([](CellTally& tally) { tally.failed = 0; });
  expect_wrong([](CellTally& tally) { ++tally.measures[1].values; });
  expect_wrong([](CellTally& tally) { ++tally.measures[1].values, --tally.measures[1].unknown; });
  expect_wrong([](CellTally& tally) { tally.notes[0].runs = 1000; });
  expect_wrong([](CellTally& tally) { std::swap(tally.events[0].front(), tally.events[0].back()); });
  expect_wrong([](CellTally& tally) { tally.events[0].push_back(tally.events[0].back()); });
}

}  // namespace
}  // namespace remote_touch::cell_tally_test

namespace remote_touch::measure_tally_test {
namespace {

// The tally of a measure: what it counts, and its mean, deviation and quantiles.

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
