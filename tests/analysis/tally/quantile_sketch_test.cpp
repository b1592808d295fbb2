// Quantiles of a sketch against those of the sorted values.
#include "analysis/tally/quantile_sketch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <random>

namespace remote_touch::quantile_sketch_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::quantile_sketch_test
