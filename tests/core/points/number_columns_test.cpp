#include "core/points/number_columns.h"

#include <gtest/gtest.h>
#include <cstdint>
#include <vector>

namespace remote_touch::counting_sort_test {
namespace {

TEST(CountingSort, ItemsOfACellAreSideBySideInTheirOrder) {
  const std::vector<std::uint32_t> cell{2, 0, 2, 3, 0, 2};
  std::vector<std::uint32_t> start(5, 77), next(5, 77), sorted(cell.size());
  sort_by_cell(
      cell.size(), start, next, [&](std::size_t i) { return cell[i]; },
      [&](std::size_t i, std::uint32_t to) { sorted[to] = static_cast<std::uint32_t>(i); });
  EXPECT_EQ(start, (std::vector<std::uint32_t>{0, 2, 2, 5, 6}));
  EXPECT_EQ(sorted, (std::vector<std::uint32_t>{1, 4, 0, 2, 5, 3}));
}

TEST(CountingSort, EveryCellIsEmptyIfThereAreNoItems) {
  std::vector<std::uint32_t> start(3, 77), next(3);
  sort_by_cell(
      0, start, next, [](std::size_t) { return 0u; }, [](std::size_t, std::uint32_t) { FAIL(); });
  EXPECT_EQ(start, (std::vector<std::uint32_t>{0, 0, 0}));
}

}  // namespace
}  // namespace remote_touch::counting_sort_test

namespace remote_touch::whole_lines_test {
namespace {

TEST(WholeLines, ColumnsBeginAtALineAndKeepTheirNumbers) {
  for (const std::size_t size : {1u, 7u, 100u, 100000u}) {
    LineVector<double> column(1, 0.0), other;
    for (std::size_t i = 1; i < size; ++i) {
      column.push_back(static_cast<double>(i));
      EXPECT_EQ(reinterpret_cast<std::uintptr_t>(column.data()) % kLineBytes, 0u);
    }
    other = column;
    EXPECT_EQ(other, column);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(other.data()) % kLineBytes, 0u);
  }
}

}  // namespace
}  // namespace remote_touch::whole_lines_test

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
