// The cells of a sweep that are checked, and those of its first round.
#include "runners/sweep/sweep_cells.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

namespace remote_touch::sweep_cells_test {
namespace {

SweepResult grid(const std::vector<std::size_t>& lengths) {
  SweepResult result;
  for (const std::size_t length : lengths)
    result.axes.push_back({"axis", "1", "an axis", std::vector<double>(length)});
  return result;
}

TEST(CheckedCells, AreAllOfASmallGrid) {
  std::vector<std::size_t> all(6 * 7);
  std::iota(all.begin(), all.end(), std::size_t{0});
  EXPECT_EQ(checked_cells(grid({6, 7})), all);
  EXPECT_EQ(checked_cells(grid({100, 200})).size(), 20000u);
}

// The least gap between neighbours of 20000 spread cells of 1e9 is 50000.
TEST(CheckedCells, OfALargeGridAreSpreadAndHaveEachValue) {
  const SweepResult large = grid({10000, 100, 1000});
  const std::vector<std::size_t> cells = checked_cells(large);
  EXPECT_LE(cells.size(), 20000u + 11100u);
  EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
  EXPECT_EQ(cells.front(), 0u);
  EXPECT_EQ(cells.back(), 999999999u);
  std::vector<std::set<std::size_t>> seen(3);
  for (const std::size_t cell : cells)
    for (std::size_t axis = 0; axis < 3; ++axis) seen[axis].insert(large.axis_indices(cell)[axis]);
  EXPECT_EQ(seen[0].size(), 10000u);
  EXPECT_EQ(seen[1].size(), 100u);
  EXPECT_EQ(seen[2].size(), 1000u);
  for (std::size_t i = 1; i < cells.size(); ++i) EXPECT_LE(cells[i] - cells[i - 1], 50000u);
}

std::vector<SweepAxis> axes(const std::vector<std::pair<std::size_t, std::size_t>>& length_and_stride) {
  std::vector<SweepAxis> all;
  for (const auto& [length, stride] : length_and_stride) {
    SweepAxis axis;
    axis.settings.resize(length), axis.stride = stride;
    all.push_back(axis);
  }
  return all;
}

TEST(FirstRound, HasTheCellsWhoseIndicesAreMultiplesOfTheStrides) {
  const SweepResult result = grid({5, 3, 9});
  const std::vector<SweepAxis> refined = axes({{5, 4}, {3, 1}, {9, 2}});
  std::vector<std::size_t> expected, found;
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell) {
    const std::vector<std::size_t> at = result.axis_indices(cell);
    if (at[0] % 4 == 0 && at[2] % 2 == 0) expected.push_back(cell);
  }
  const FirstRound first(result, refined);
  for (std::size_t i = 0; i < first.count(); ++i) found.push_back(first.cell(i));
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace remote_touch::sweep_cells_test
