#include "analysis/trace/column.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace remote_touch::column_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(Column, TheMaxOfNumbers) {
  EXPECT_EQ(max_of(std::vector<double>{-3, 2, -7}), 2);
  EXPECT_EQ(max_of(std::vector<double>{-3}), -3);
}

TEST(Column, MaxIsNanIfANumberIsMissing) {
  EXPECT_TRUE(std::isnan(max_of({})));
  for (const std::vector<double>& values :
       {std::vector<double>{kNan, 1}, {1, kNan}, {1, kNan, 2}, {2, kNan, 1}})
    EXPECT_TRUE(std::isnan(max_of(values)));
}

}  // namespace
}  // namespace remote_touch::column_test
