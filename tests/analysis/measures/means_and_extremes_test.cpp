#include "analysis/measures/means_and_extremes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
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
