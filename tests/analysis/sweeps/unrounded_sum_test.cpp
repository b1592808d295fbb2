#include "analysis/sweeps/sweep_tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/analysis/sweeps/example_tally.h"
#include "tests/analysis/sweeps/fixed_point_sum.h"
#include "tests/support/test_files.h"

namespace remote_touch::unrounded_sum_test {
namespace {

// Exact sums against a long integer, in every order.

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargestDouble = std::numeric_limits<double>::max();
constexpr double kLeastDouble = std::numeric_limits<double>::denorm_min();

UnroundedSum sum_of(const std::vector<double>& values) {
  UnroundedSum sum;
  for (const double value : values) sum.add(value);
  return sum;
}

// The parts by their definition: the rounded sum, the rounded rest, and so on.
std::vector<double> parts_by_oracle(FixedPointSum rest) {
  std::vector<double> parts;
  for (double part = rest.rounded(); part != 0; part = rest.rounded()) {
    parts.push_back(part);
    rest.add(-part);
  }
  return parts;
}

std::vector<double> expected_parts(const std::vector<double>& values) {
  FixedPointSum sum;
  for (const double value : values) sum.add(value);
  return parts_by_oracle(sum);
}

// A double of any magnitude, sign and number of bits.
double any_double(std::mt19937_64& random, int least_power, int greatest_power) {
  const int bits = 1 + static_cast<int>(random() % 53);
  const auto mantissa = static_cast<double>(random() >> (64 - bits));
  const int powers = greatest_power - least_power - 53;
  const int power = least_power + static_cast<int>(random() % static_cast<std::uint64_t>(powers));
  return std::ldexp(random() % 2 == 0 ? mantissa : -mantissa, power);
}

TEST(UnroundedSum, OfNothingIsZero) {
  EXPECT_EQ(UnroundedSum().value(), 0);
  EXPECT_FALSE(std::signbit(UnroundedSum().value()));
  EXPECT_TRUE(UnroundedSum().parts().empty());
  EXPECT_FALSE(std::signbit(sum_of({-0.0, 1, -1, -0.0}).value()));
}

TEST(UnroundedSum, HasThePartsOfALongIntegerInEveryOrder) {
  const std::vector<std::vector<double>> sets = {
      {1e300, 1e-300, -1e300, 1, 1e16, -1},
      {0.1, 0.2, 0.3, -0.6, 0x1p-54, 0x1p-55},
      {1, 0x1p-53, 0x1p-106, -0x1p-159, 0x1p-1074, -0x1p-1074},
      {1, 0x1p-53, 0x1p-1074},
      {1, 0x1p-53, -0x1p-1074},
      {1 + 0x1p-52, 0x1p-53, 0x1p-300, -0x1p-301},
      {kLeastDouble, -0x1p-1022, 3 * kLeastDouble, 0x1.fffffffffffffp-1023, 1e-310, -1e-310},
      {kLargestDouble, -kLargestDouble, kLargestDouble, 1, kLeastDouble},
      {1e22, 1, -1e22, 1e-22, 1e5, -1e5},
      {0x1p1022, 0x1p1021, -0x1p969, -0x1p1022, 0x1p-1074}};
  for (std::vector<double> values : sets) {
    const std::vector<double> expected = expected_parts(values);
    std::sort(values.begin(), values.end());
    do {
      const UnroundedSum sum = sum_of(values);
      ASSERT_EQ(sum.parts(), expected) << testing::PrintToString(values);
      ASSERT_EQ(sum.value(), expected.empty() ? 0 : expected[0]) << testing::PrintToString(values);
    } while (std::next_permutation(values.begin(), values.end()));
  }
}

TEST(UnroundedSum, HasThePartsOfALongIntegerForRandomValues) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 600; ++round) {
    const int kinds[][2] = {{-1074, 1024}, {-60, 60}, {-1074, -950}, {900, 1024}, {-10, 50}};
    const auto& range = kinds[round % 5];
    std::vector<double> values;
    for (int i = 0; i < 50; ++i) values.push_back(any_double(random, range[0], range[1]));
    // A third is taken away again, so that the rest has to be exact.
    for (std::size_t i = 0; i < 25; ++i) values.push_back(-values[i]);
    std::vector<double> expected = expected_parts(values);
    if (!expected.empty() && std::isinf(expected[0])) continue;
    std::shuffle(values.begin(), values.end(), random);
    const UnroundedSum sum = sum_of(values);
    ASSERT_EQ(sum.parts(), expected);
    ASSERT_LE(expected.size(), 40u);
    UnroundedSum merged;
    for (std::size_t at = 0; at < values.size(); at += 15) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(at);
      merged.add(sum_of({first, first + 15}));
    }
    ASSERT_EQ(merged.parts(), expected);
    ASSERT_TRUE(merged == sum);
  }
}

TEST(UnroundedSum, RoundsAsALongIntegerAroundTheMiddleOfTwoDoubles) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 20000; ++round) {
    const double first = any_double(random, -20, 60);
    const double half = std::ldexp(1.0, std::ilogb(first == 0 ? 1 : first) - 53);
    const double tiny = std::ldexp(1.0, -200 + static_cast<int>(random() % 150));
    std::vector<double> values = {first, half, random() % 2 == 0 ? tiny : -tiny};
    if (random() % 3 == 0) values.pop_back();
    if (random() % 2 == 0) values[1] = -half;
    ASSERT_EQ(sum_of(values).parts(), expected_parts(values)) << testing::PrintToString(values);
  }
}

TEST(UnroundedSum, IsExactBeyondTheLargestDouble) {
  const std::vector<double> values = {kLargestDouble, kLargestDouble, 1, 0x1p1023, -0x1p1022, kLeastDouble};
  std::vector<double> order = values;
  std::sort(order.begin(), order.end());
  const std::vector<double> parts = sum_of(values).parts();
  EXPECT_EQ(parts[0], kInfinity);
  do {
    UnroundedSum sum = sum_of(order);
    ASSERT_EQ(sum.value(), kInfinity);
    ASSERT_EQ(sum.parts(), parts);
    for (const double value : values) sum.add(-value);
    ASSERT_TRUE(sum.parts().empty());
    ASSERT_TRUE(sum == UnroundedSum());
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_EQ(sum_of({-0x1p1023, -0x1p1023}).value(), -kInfinity);
  // Terms that are no larger than 2^1022, of which no unit is taken.
  UnroundedSum many, back;
  for (int i = 0; i < 100; ++i) many.add(0x1.8p1021), back.add(-0x1.8p1021);
  EXPECT_EQ(many.value(), kInfinity);
  EXPECT_EQ(back.value(), -kInfinity);
  many.add(1), many.add(back);
  EXPECT_EQ(many.parts(), std::vector<double>{1});
}

// Halves of an ulp, and a last part that is far below, where the rounding decides between a double and
// infinity.
TEST(UnroundedSum, RoundsToInfinityAsADoubleDoes) {
  const double half = 0x1p970;
  EXPECT_EQ(sum_of({kLargestDouble, half}).value(), kInfinity);
  EXPECT_EQ(sum_of({kLargestDouble, half, -kLeastDouble}).value(), kLargestDouble);
  EXPECT_EQ(sum_of({kLargestDouble, half, -kLeastDouble, 0x1p-1000}).value(), kInfinity);
  EXPECT_EQ(sum_of({kLargestDouble, half, -0x1p-1010, 0x1p-1070}).value(), kLargestDouble);
  EXPECT_EQ(sum_of({0x1p1023, 0x1p970, kLeastDouble}).value(), 0x1p1023 + 0x1p971);
  EXPECT_EQ(sum_of({0x1p1023, 0x1p970}).value(), 0x1p1023);
  EXPECT_EQ(sum_of({-kLargestDouble, -half}).value(), -kInfinity);
}

// 2^1022 and -2^1022 with one unit of 2^1023 more are the same number.
TEST(UnroundedSum, HasOneFormAtTheEndOfAUnit) {
  for (const double rest : {0.0, 1.0, -1.0, 0x1p969, -0x1p969, 0x1p970}) {
    std::vector<double> values = {0x1p1023, 0x1p1023, 0x1p1023, 0x1p1022, rest};
    std::sort(values.begin(), values.end());
    const std::vector<double> parts = sum_of(values).parts();
    do ASSERT_EQ(sum_of(values).parts(), parts);
    while (std::next_permutation(values.begin(), values.end()));
    UnroundedSum from_below = sum_of({0x1p1023, 0x1p1023, 0x1p1023, 0x1p1023, rest});
    from_below.add(-0x1p1022);
    EXPECT_EQ(from_below.parts(), parts) << rest;
  }
}

TEST(UnroundedSum, OfSquaresIsThatOfALongInteger) {
  std::mt19937_64 random(3);
  for (int round = 0; round < 300; ++round) {
    FixedPointSum expected;
    UnroundedSum sum;
    for (int i = 0; i < 40; ++i) {
      const double value = round % 2 == 0 ? any_double(random, -430, 510) : any_double(random, -5, 60);
      expected.add_square(value), sum.add_square(value);
      if (i % 3 == 0) expected.add(-value), sum.add(-value);
    }
    ASSERT_EQ(sum.parts(), parts_by_oracle(expected));
  }
}

TEST(UnroundedSum, OfTinySquaresIsRoundedAndHasNoOrder) {
  std::vector<double> values = {1e-147, 3e-150, 0x1.fffffffffffffp-486, 1e-160, 0x1p-537, 1e-200};
  std::sort(values.begin(), values.end());
  FixedPointSum exact;
  UnroundedSum first;
  for (const double value : values) exact.add_square(value), first.add_square(value);
  EXPECT_NEAR(first.value(), exact.rounded(), static_cast<double>(values.size()) * kLeastDouble);
  do {
    UnroundedSum sum;
    for (const double value : values) sum.add_square(value);
    ASSERT_TRUE(sum == first);
  } while (std::next_permutation(values.begin(), values.end()));
  UnroundedSum exactly;
  exactly.add_square(0x1.fffffffffffffp-485);
  FixedPointSum expected;
  expected.add_square(0x1.fffffffffffffp-485);
  EXPECT_EQ(exactly.parts(), parts_by_oracle(expected)) << "the least values whose squares are exact";
}

TEST(UnroundedSum, IsInfiniteForEverAfterTooLargeASquare) {
  UnroundedSum sum;
  sum.add_square(std::nextafter(0x1p512, 0));
  EXPECT_FALSE(sum.is_infinite());
  sum.add_square(-0x1p512);
  EXPECT_TRUE(sum.is_infinite());
  sum.add(-kLargestDouble);
  EXPECT_EQ(sum.value(), kInfinity);
  EXPECT_EQ(sum.parts(), std::vector<double>{kInfinity});
  UnroundedSum other;
  other.add(-kLargestDouble);
  other.add(sum);
  EXPECT_TRUE(other == sum);
  EXPECT_TRUE(UnroundedSum::from_parts(sum.parts()) == sum);
}

TEST(UnroundedSum, ReadsItsPartsAndRefusesOthers) {
  for (const std::vector<double>& values :
       {std::vector<double>{}, {0.1, 1e20, 1e-20}, {kLargestDouble, kLargestDouble, 1, -1e-300}}) {
    const UnroundedSum sum = sum_of(values);
    const auto read = UnroundedSum::from_parts(sum.parts());
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(read->parts(), sum.parts());
  }
  const double nan = std::nan("");
  for (const std::vector<double>& wrong : {std::vector<double>{0},
                                           {1, 1},
                                           {1e-20, 1},
                                           {1, nan},
                                           {nan},
                                           {1, kInfinity},
                                           {-kInfinity},
                                           {kInfinity, 1, 1},
                                           {kInfinity, 2.5},
                                           {kInfinity, nan},
                                           {kInfinity, 1e300},
                                           {kInfinity, -3},
                                           {kInfinity, 3, -0x1p1022},
                                           {1, 0x1p-53, 0x1p-54},
                                           {1, -0.0}})
    EXPECT_FALSE(UnroundedSum::from_parts(wrong).has_value()) << testing::PrintToString(wrong);
}

// The list of these sums would grow without renormalisation.
TEST(UnroundedSum, StaysShort) {
  std::mt19937_64 random(4);
  UnroundedSum sum;
  FixedPointSum expected;
  for (int i = 0; i < 20000; ++i) {
    const double value = std::ldexp(1.0, static_cast<int>(random() % 2090) - 1074);
    sum.add(i % 2 == 0 ? value : -value), expected.add(i % 2 == 0 ? value : -value);
  }
  EXPECT_EQ(sum.parts(), parts_by_oracle(expected));
  EXPECT_LE(sum.parts().size(), 40u);
}

TEST(UnroundedSum, AddedToItselfIsTwiceAsLarge) {
  UnroundedSum sum = sum_of({0.1, 1e20, -3e-7});
  const UnroundedSum twice = sum_of({0.2, 2e20, -6e-7});
  sum.add(sum);
  EXPECT_TRUE(sum == twice);
}

}  // namespace
}  // namespace remote_touch::unrounded_sum_test
