#include "core/points/order_statistic.h"

#include <gtest/gtest.h>

#include <vector>

namespace remote_touch::order_statistic_test {
namespace {

double quantile_of(std::vector<double> values, double fraction) {
  return quantile_in_place(values, fraction);
}

TEST(OrderStatistic, IsTheValueThatTheFractionLiesBelow) {
  const std::vector<double> values{5, 1, 4, 2, 3};
  EXPECT_EQ(quantile_of(values, 0), 1);
  EXPECT_EQ(quantile_of(values, 0.19), 1);
  EXPECT_EQ(quantile_of(values, 0.4), 3);
  EXPECT_EQ(quantile_of(values, 0.99), 5);
}

TEST(OrderStatistic, MedianOfAnEvenNumberIsTheUpperOne) {
  std::vector<double> odd{9, 7, 8}, even{4, 1, 3, 2}, one{6};
  EXPECT_EQ(median_in_place(odd), 8);
  EXPECT_EQ(median_in_place(even), 3);
  EXPECT_EQ(median_in_place(one), 6);
}

}  // namespace
}  // namespace remote_touch::order_statistic_test
