#include "core/beyond/tracked_surface/height_map.h"

#include <gtest/gtest.h>

#include <cmath>

namespace remote_touch::height_map_test {
namespace {

HeightMap plane(double height, double slope_u, double error) {
  HeightMap map;
  map.set_plane(height, slope_u, 0, 20);
  for (int j = 0; j < HeightMap::kNodes; ++j)
    for (int i = 0; i < HeightMap::kNodes; ++i) map.node(i, j).error = error;
  map.fill_cells();
  return map;
}

// A change x is kept as x^3 / (x^2 + 4 e^2), where e is 1.5 times the error of a node.
TEST(HeightMap, SteadyKeepsWhatNoiseDoesNotExplain) {
  const double error = 0.1, e = 1.5 * error;
  for (const double x : {0.0, 0.05, 0.3, 3.0}) {
    HeightMap map = plane(1 + x, 0, error);
    map.shrink_change_since(plane(1, 0, error));
    EXPECT_NEAR(map.height(0.3, -2.1), 1 + x * x * x / (x * x + 4 * e * e), 1e-12) << x;
  }
}

TEST(HeightMap, SteadyKeepsARotationThatIsLarge) {
  HeightMap map = plane(0, 0.5, 0.01);
  map.shrink_change_since(plane(0, 0, 0.01));
  EXPECT_NEAR(map.slopes(0.2, 0.3).u, 0.5, 0.01);
}

TEST(HeightMap, SteadyLeavesNodesThatOneOfTheMapsDoesNotCover) {
  HeightMap map = plane(2, 0, 0.1), earlier = plane(1.9, 0, 0.1);
  earlier.node(8, 8).covered = false;
  map.shrink_change_since(earlier);
  EXPECT_EQ(map.node(8, 8).height, 2);
  EXPECT_NE(map.node(8, 9).height, 2);
}

// A node without a plane takes the largest error around it: it must not seem the most certain one.
TEST(HeightMap, ErrorOfANodeWithoutAPlaneIsThatOfItsNeighbours) {
  HeightMap map = plane(0, 0, 0.1);
  map.node(8, 8) = {};
  map.node(9, 9).error = 0.2;
  EXPECT_EQ(map.error(0.1, -0.1), 0.2);
  EXPECT_EQ(map.error(-1, 0), 0.1);
  for (int j = 7; j <= 9; ++j)
    for (int i = 7; i <= 9; ++i) map.node(i, j) = {};
  EXPECT_TRUE(std::isinf(map.error(0, 0)));
  EXPECT_EQ(map.error(1, 1), 0.1);
}

}  // namespace
}  // namespace remote_touch::height_map_test
