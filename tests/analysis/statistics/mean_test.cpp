#include "analysis/statistics/mean.h"

#include <gtest/gtest.h>

#include <cmath>

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
