#include "analysis/columns/column.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace remote_touch::column_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Column, TheLargestOfNumbers) {
  EXPECT_EQ(largest_of(std::vector<double>{-3, 2, -7}), 2);
  EXPECT_EQ(largest_of(std::vector<double>{-3}), -3);
}

TEST(Column, WhereANumberIsMissingNoneIsTheLargest) {
  EXPECT_TRUE(std::isnan(largest_of({})));
  for (const std::vector<double>& values :
       {std::vector<double>{kNan, 1}, {1, kNan}, {1, kNan, 2}, {2, kNan, 1}})
    EXPECT_TRUE(std::isnan(largest_of(values)));
}

}  // namespace
}  // namespace remote_touch::column_test
