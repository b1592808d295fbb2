// Shares of cells that hold, regions of the map of lifts, and deviations that are not known.
#include "runners/evaluation/figures/pop_through_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace remote_touch::pop_through_map_test {
namespace {

// survived of `known` cells that are 1, `lost` cells that are 0 and `unknown` cells.
std::vector<double> cells(std::size_t known, std::size_t lost, std::size_t unknown) {
  std::vector<double> survived(known, 1.0);
  survived.insert(survived.end(), lost, 0.0);
  survived.insert(survived.end(), unknown, std::nan(""));
  return survived;
}

TEST(ShareOfKnown, IsTheMeanOfTheKnownCells) {
  EXPECT_EQ(share_of_known(cells(3, 1, 0)), 0.75);
  EXPECT_EQ(share_of_known(cells(60, 39, 1)), 60.0 / 99);  // 1 % are unknown
}

TEST(ShareOfKnown, IsUnknownIfMoreThanOneInAHundredIs) {
  EXPECT_TRUE(std::isnan(share_of_known(cells(60, 37, 1))));
  EXPECT_TRUE(std::isnan(share_of_known(cells(60, 38, 2))));
  EXPECT_TRUE(std::isnan(share_of_known(cells(0, 0, 1))));
  EXPECT_TRUE(std::isnan(share_of_known({})));
}

TEST(RegionTable, GivesACellOnAnEdgeToTheRegionAboveIt) {
  Table map{"map", ""};
  map.add("noise", "r_c", "", {0.0, 0.5, 2.9});
  map.add("acceleration", "r_c/s^2", "", {0.0, 300.0, 2000.0});
  map.add("survived", "1", "", {1.0, 0.5, 0.25});
  const std::vector<double> regions = numbers(region_table("regions", map), "survived");
  ASSERT_EQ(regions.size(), 25u);  // five of noise in each of five of acceleration
  EXPECT_EQ(regions[0], 1);
  EXPECT_EQ(regions[6], 0.5);
  EXPECT_EQ(regions[24], 0.25);
  EXPECT_TRUE(std::isnan(regions[1])) << "a region without cells";
}

TEST(MaxApart, KnowsNothingOfRowsThatWereNotCompared) {
  Table table{"table", ""};
  table.add("difference_in_standard_errors", "1", "", {-3.0, 2.0});
  EXPECT_EQ(max_apart(table), 3);
  table.columns[0].values = std::vector<double>{-3.0, std::nan("")};
  EXPECT_TRUE(std::isnan(max_apart(table)));
  table.columns[0].values = std::vector<double>{};
  EXPECT_TRUE(std::isnan(max_apart(table)));
}

}  // namespace
}  // namespace remote_touch::pop_through_map_test
