#include "scenarios/synthetic/panel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace remote_touch::panel_test {
namespace {

// A panel whose axes are not those of the world.
FlatPanel askew() {
  const Vec3 normal = Vec3(1, 2, 2) / 3, u = Vec3(2, 1, -2) / 3;
  return {{0.1, 0.2, -0.3}, normal, u, 0.0301, 0.02};
}

TEST(FlatPanel, PointsAreAGridOnItWithItsNormal) {
  const FlatPanel panel = askew();
  PointCloud cloud;
  append(cloud, panel, {0.01, 0.002, 0});
  // -0.028, -0.018, ... 0.022 along u, and -0.02 .. 0.02 along v, the border included.
  ASSERT_EQ(cloud.size(), 6u * 5u);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 from_centre = cloud.point(i) - panel.centre;
    EXPECT_NEAR(from_centre.dot(panel.normal), 0, 1e-16);
    EXPECT_NEAR(from_centre.dot(panel.u), -0.028 + 0.01 * static_cast<double>(i % 6), 1e-15);
    EXPECT_NEAR(from_centre.dot(panel.v()), -0.02 + 0.01 * static_cast<double>(i / 6), 1e-15);
    EXPECT_EQ(cloud.normal(i), panel.normal);
  }
}

TEST(FlatPanel, DistanceIsToTheNearestOfManySamples) {
  const FlatPanel panel = askew();
  PointCloud dense;
  append(dense, panel, {0.0005});
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-0.06, 0.06);
  int behind = 0, beside = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 p = panel.centre + Vec3(place(random), place(random), place(random));
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < dense.size(); ++j) nearest = std::min(nearest, (dense.point(j) - p).norm());
    const double got = signed_distance({&panel, 1}, p);
    const Vec3 from_centre = p - panel.centre;
    const bool is_behind = panel.normal.dot(from_centre) < 0;
    const bool is_beside = std::abs(from_centre.dot(panel.u)) > panel.half_u_m ||
                           std::abs(from_centre.dot(panel.v())) > panel.half_v_m;
    EXPECT_EQ(std::isnan(got), is_behind && is_beside);
    beside += std::isnan(got);
    if (std::isnan(got)) continue;
    EXPECT_EQ(got < 0, is_behind);
    behind += got < 0;
    EXPECT_LE(std::abs(got), nearest + 1e-15);
    EXPECT_GE(std::abs(got), nearest - 0.0005);  // half a diagonal of the samples, and the border beyond them
  }
  EXPECT_GT(behind, 10);
  EXPECT_GT(beside, 100);
}

// Two walls of a corner, whose inside is free. The edge belongs to both walls.
TEST(FlatPanel, CornersHaveOneInside) {
  const std::vector<FlatPanel> corner = {{{1, 0, 0}, Vec3::UnitY(), Vec3::UnitX(), 1, 1},
                                         {{0, 1, 0}, Vec3::UnitX(), Vec3::UnitY(), 1, 1}};
  EXPECT_DOUBLE_EQ(signed_distance(corner, {0.3, 0.2, 0}), 0.2);
  EXPECT_DOUBLE_EQ(signed_distance(corner, {0.2, 0.3, 0}), 0.2);
  EXPECT_DOUBLE_EQ(signed_distance(corner, {-0.3, -0.4, 0}), -0.5);
  EXPECT_DOUBLE_EQ(signed_distance(corner, {-0.3, 0.4, 0}), -0.3);
  // Below one wall, beyond the edge, and 1e-12 m on the free side of the other wall.
  EXPECT_DOUBLE_EQ(signed_distance(corner, {1e-12, -0.4, 0}), -0.4);
  EXPECT_EQ(signed_distance({}, {0, 0, 0}), std::numeric_limits<double>::infinity());
}

// The walls are those of CornersHaveOneInside. The edge at which they meet is no border. Its ends and the
// other edges are borders.
TEST(FlatPanel, HasNoBackBesideItsBorder) {
  const std::vector<FlatPanel> corner = {{{1, 0, 0}, Vec3::UnitY(), Vec3::UnitX(), 1, 1},
                                         {{0, 1, 0}, Vec3::UnitX(), Vec3::UnitY(), 1, 1}};
  EXPECT_DOUBLE_EQ(signed_distance(corner, {-0.3, -0.4, 0.999}), -0.5);
  EXPECT_TRUE(std::isnan(signed_distance(corner, {-0.3, -0.4, 1.001}))) << "beyond the end of the edge";
  EXPECT_DOUBLE_EQ(signed_distance(corner, {1.9, -0.4, 0}), -0.4);
  EXPECT_TRUE(std::isnan(signed_distance(corner, {2.1, -0.4, 0})));
  EXPECT_TRUE(std::isnan(signed_distance(corner, {-0.3, 2.4, 0})));
  EXPECT_DOUBLE_EQ(signed_distance(corner, {2.3, 0.4, 0}), 0.5) << "above the border";
  // A third panel makes the end of the edge a corner: there is no way round it.
  std::vector<FlatPanel> closed = corner;
  closed.push_back({{1, 1, 1}, -Vec3::UnitZ(), Vec3::UnitX(), 1, 1});
  EXPECT_DOUBLE_EQ(signed_distance(closed, {-0.2, -0.3, 1.6}), -0.7);
}

}  // namespace
}  // namespace remote_touch::panel_test
