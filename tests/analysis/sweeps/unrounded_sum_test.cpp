// Exact sums against a long integer, in every order, and the tally of a measure that is made of them.
#include "analysis/sweeps/sweep_tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace remote_touch::unrounded_sum_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLargestDouble = std::numeric_limits<double>::max();
constexpr double kLeastDouble = std::numeric_limits<double>::denorm_min();

// Exact sums in fixed point, by other means than UnroundedSum: one long integer in units of 2^-2148, which
// holds every double and the square of every double.
class FixedPointSum {
 public:
  void add(double value) {
    int power = 0;
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(value, &power), 53));
    add_shifted(mantissa, power - 53 + kUnit);
  }
  void add_square(double value) { add_product(value, value); }
  void add_product(double a, double b) {
    int power_of_a = 0, power_of_b = 0;
    const auto x = static_cast<std::int64_t>(std::ldexp(std::frexp(a, &power_of_a), 53));
    const auto y = static_cast<std::int64_t>(std::ldexp(std::frexp(b, &power_of_b), 53));
    add_shifted(static_cast<__int128>(x) * y, power_of_a + power_of_b - 106 + kUnit);
  }
  void add(const FixedPointSum& other, std::int64_t times) {
    for (std::size_t i = 0; i < digits_.size(); ++i) digits_[i] += times * other.digits_[i];
    carry();
  }

  bool operator==(const FixedPointSum&) const = default;

  // The nearest double, even if two are as near.
  double rounded() const {
    FixedPointSum magnitude = *this;
    const bool is_negative = digits_.back() < 0;
    if (is_negative) magnitude = FixedPointSum(), magnitude.add(*this, -1);
    int top = static_cast<int>(32 * kDigits) - 1;
    while (top >= 0 && !magnitude.bit(top)) --top;
    // The last bit that the double has: 53 bits from the top, or 2^-1074.
    const int last = std::max(top - 52, kUnit - 1074);
    std::uint64_t mantissa = 0;
    for (int i = top; i >= last; --i) mantissa = 2 * mantissa + (magnitude.bit(i) ? 1 : 0);
    bool is_above_half = false;
    for (int i = last - 2; i >= 0 && !is_above_half; --i) is_above_half = magnitude.bit(i);
    if (magnitude.bit(last - 1) && (is_above_half || mantissa % 2 == 1)) ++mantissa;
    const double size = std::ldexp(static_cast<double>(mantissa), last - kUnit);
    return is_negative ? -size : size;
  }

 private:
  static constexpr int kUnit = 2148;
  static constexpr std::size_t kDigits =
      140;  // digits of 32 bits: 2^-2148 to 2^2331; the last one has the sign

  // Adds number 2^shift. A number below the unit is a multiple of it after all.
  void add_shifted(__int128 number, int shift) {
    while (shift < 0) number /= 2, ++shift;
    const bool is_negative = number < 0;
    auto left = static_cast<unsigned __int128>(is_negative ? -number : number);
    const auto first = static_cast<std::size_t>(shift / 32);
    auto low = static_cast<std::uint64_t>(left & 0xffffffffu) << (shift % 32);
    for (std::size_t i = first; left != 0 || low != 0; ++i) {
      const auto digit = static_cast<std::int64_t>(low & 0xffffffffu);
      digits_.at(i) += is_negative ? -digit : digit;
      left >>= 32;
      low = (low >> 32) + (static_cast<std::uint64_t>(left & 0xffffffffu) << (shift % 32));
    }
    carry();
  }
  // All digits but the last become 0 .. 2^32 - 1.
  void carry() {
    for (std::size_t i = 0; i + 1 < digits_.size(); ++i) {
      const std::int64_t over = digits_[i] >> 32;
      digits_[i] -= over * (std::int64_t{1} << 32);
      digits_[i + 1] += over;
    }
  }
  bool bit(int i) const { return i >= 0 && (digits_[static_cast<std::size_t>(i / 32)] >> (i % 32) & 1) != 0; }
  std::array<std::int64_t, kDigits> digits_{};
};

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
    const std::vector<double> expected = expected_parts(values);
    ASSERT_EQ(sum_of(values).parts(), expected) << testing::PrintToString(values);
    ASSERT_EQ(sum_of(values).value(), expected.empty() ? 0 : expected[0]);
  }
  EXPECT_FALSE(std::signbit(UnroundedSum().value()));
  EXPECT_FALSE(std::signbit(sum_of({-0.0, 1, -1, -0.0}).value()));
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
  const std::vector<std::vector<double>> others = {{0},
                                                   {1, 1},
                                                   {1e-20, 1},
                                                   {1, kNan},
                                                   {kNan},
                                                   {1, kInfinity},
                                                   {-kInfinity},
                                                   {kInfinity, 1, 1},
                                                   {kInfinity, 2.5},
                                                   {kInfinity, kNan},
                                                   {kInfinity, 1e300},
                                                   {kInfinity, -3},
                                                   {kInfinity, 3, -0x1p1022},
                                                   {1, 0x1p-53, 0x1p-54},
                                                   {1, -0.0}};
  for (const std::vector<double>& wrong : others)
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

// Minus zero counts as zero, because the order would decide which of both is the least value.
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
  EXPECT_FALSE(std::signbit(tally_of({-0.0}).least));
  EXPECT_TRUE(tally_of({-0.0, 0.0}) == tally_of({0.0, -0.0}));
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

// The values of every third round are 1e8 and some thousandths: a sum of rounded squares would have no digit
// left.
TEST(MeasureTally, HasTheVarianceOfALongInteger) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int round = 0; round < 30; ++round) {
    std::vector<double> values(2 + random() % 30);
    for (double& value : values) value = std::exp(3 * normal(random)) * (round % 2 == 0 ? 1 : normal(random));
    if (round % 3 == 2)
      for (double& value : values) value = 1e8 + 1e-3 * normal(random);
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
    merged.add(merged);
    ASSERT_EQ(merged.values, 2 * whole.values);
    ASSERT_EQ(merged.mean(), whole.mean());
    ASSERT_EQ(merged.quantile(0.3), whole.quantile(0.3));
  }
  values.back() = std::nextafter(values.back(), 0);
  EXPECT_FALSE(tally_of(values) == whole);
}

}  // namespace
}  // namespace remote_touch::unrounded_sum_test
