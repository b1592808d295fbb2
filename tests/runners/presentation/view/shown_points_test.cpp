#include "runners/presentation/view/shown_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/support/scenes.h"

namespace remote_touch::shown_points_test {
namespace {

const BoundingBox kBox(Vec3(-0.03, -0.03, -0.03), Vec3(0.03, 0.03, 0.03));
const std::vector<Vec3> kPath{{0, 0, 0}, {0.001, 0, 0}, {0.02, 0.01, 0}};

PointCloud cloud_with_holes() {
  PointCloud cloud = scenes::random_cloud(20000, 0.05, 4);
  for (std::size_t i = 0; i < cloud.size(); i += 50) cloud.y[i] = std::numeric_limits<double>::quiet_NaN();
  return cloud;
}

bool is_shown(const ShownPoints& shown, std::size_t i) {
  return std::binary_search(shown.indices.begin(), shown.indices.end(), i);
}

TEST(ShownPoints, AreAllPointsInTheBoxIfTheyAreFewEnough) {
  const PointCloud cloud = cloud_with_holes();
  const ShownPoints shown = shown_points(cloud, {}, kPath, {kBox, 0.005, cloud.size()});
  std::size_t measured = 0, in_box = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const bool inside = cloud.is_measured(i) && kBox.contains(cloud.point(i));
    measured += cloud.is_measured(i), in_box += inside;
    EXPECT_EQ(is_shown(shown, i), inside) << i;
  }
  EXPECT_EQ(shown.measured, measured);
  EXPECT_EQ(shown.in_box, in_box);
  EXPECT_EQ(shown.indices.size(), in_box);
}

TEST(ShownPoints, AreAllNearTheProxyAndAboutAsManyOthersAsAllowed) {
  const PointCloud cloud = cloud_with_holes();
  const ShownPoints shown = shown_points(cloud, {}, kPath, {kBox, 0.005, 500});
  std::size_t near = 0, others = 0, others_shown = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i) || !kBox.contains(cloud.point(i))) continue;
    double from_path_m = 1;
    for (const Vec3& proxy : kPath) from_path_m = std::min(from_path_m, (cloud.point(i) - proxy).norm());
    if (from_path_m <= 0.005) {
      EXPECT_TRUE(is_shown(shown, i)) << i;
      ++near;
    } else if (from_path_m > 1.1 * 0.005) {  // both are right in between
      ++others, others_shown += is_shown(shown, i);
    }
  }
  ASSERT_GT(near, 20u);
  // The number is that of a draw with the same chance for each of the others, within four standard
  // deviations.
  const double chance = 500 / static_cast<double>(others);
  EXPECT_NEAR(static_cast<double>(others_shown), 500, 4 * std::sqrt(500 * (1 - chance)));
}

TEST(ShownPoints, RequestedPointsAreShownOutsideOfTheBoxToo) {
  const PointCloud cloud = cloud_with_holes();
  std::vector<std::uint32_t> always;
  for (std::uint32_t i = 1; i < 40; i += 2) always.push_back(i);
  const ShownPoints shown = shown_points(cloud, always, {}, {kBox, 0, 0});
  EXPECT_EQ(shown.indices, always);
}

TEST(ShownPoints, FewerAreThoseOfTheSmallestRanks) {
  const PointCloud cloud = cloud_with_holes();
  const std::vector<std::uint32_t> always{5, 7, 1001};
  const ShownPoints many = shown_points(cloud, always, kPath, {kBox, 0.005, 900});
  const ShownPoints few = shown_points(cloud, always, kPath, {kBox, 0.005, 100});
  ASSERT_EQ(many.rank.size(), many.indices.size());
  EXPECT_EQ(many.others, few.others);
  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < many.indices.size(); ++i)
    if (many.rank[i] < rank_limit(many.others, 100)) kept.push_back(many.indices[i]);
  EXPECT_EQ(kept, few.indices);
  EXPECT_LT(kept.size(), many.indices.size());
  for (const std::uint32_t i : always) EXPECT_TRUE(is_shown(few, i));
}

// A point that is left out of one frame is left out of the next, so that an animation does not flicker.
TEST(ShownPoints, AreTheSamePixelsInEveryFrame) {
  PointCloud cloud = cloud_with_holes();
  const ShownPointsRule rule{kBox, 0, 300};
  const std::vector<std::uint32_t> before = shown_points(cloud, {}, {}, rule).indices;
  for (double& y : cloud.y) y += 1e-6;
  std::vector<std::uint32_t> common;
  const std::vector<std::uint32_t> after = shown_points(cloud, {}, {}, rule).indices;
  std::set_intersection(before.begin(), before.end(), after.begin(), after.end(), std::back_inserter(common));
  EXPECT_GT(static_cast<double>(common.size()), 0.98 * static_cast<double>(before.size()));
}

}  // namespace
}  // namespace remote_touch::shown_points_test
