#include "core/points/counting_sort.h"

#include <gtest/gtest.h>

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
