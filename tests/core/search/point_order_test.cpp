#include "core/search/point_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/geometry/vector.h"
#include "tests/support/scenes.h"

namespace remote_touch::point_order_test {
namespace {

std::vector<Vec3> points_of(const PointCloud& cloud) {
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < cloud.size(); ++i) points.push_back(cloud.point(i));
  return points;
}

TEST(CompactOrder, HoldsEveryIndexOnce) {
  for (const int count : {0, 1, 7, 8, 9, 63, 65, 130, 1000, 5000}) {
    std::vector<std::uint32_t> order = compact_order(points_of(scenes::random_cloud(count, 0.1, 3)));
    ASSERT_EQ(order.size(), static_cast<std::size_t>(count));
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
  }
  EXPECT_EQ(compact_order(std::vector<Vec3>(100, Vec3(1, 2, 3))).size(), 100u);
}

// On a grid of 64 x 64 points, every run is a square, or half of one.
TEST(CompactOrder, RunsOfAGridAreSquares) {
  std::vector<Vec3> points;
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i) points.push_back(Vec3((i * 37) % 64, 0, j));
  const std::vector<std::uint32_t> order = compact_order(points);
  for (const std::size_t run : {8u, 64u, 512u}) {
    double longest = 0;
    for (std::size_t first = 0; first < order.size(); first += run) {
      BoundingBox box;
      for (std::size_t i = first; i < first + run; ++i) box.extend(points[order[i]]);
      longest = std::max(longest, box.sizes().maxCoeff());
    }
    EXPECT_LE(longest + 1, std::sqrt(2.0 * static_cast<double>(run)));
  }
}

}  // namespace
}  // namespace remote_touch::point_order_test
