#include "runners/presentation/view/touching_points.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/box_tool.h"
#include "tests/support/scenes.h"

namespace remote_touch::touching_points_test {
namespace {

TEST(TouchingProxy, AreThoseOfEveryPointAskedInEveryTick) {
  PointCloud cloud = scenes::random_cloud(20000, 0.03, 6);
  for (std::size_t i = 0; i < cloud.size(); ++i) cloud.fixture_radius_m.push_back(i % 3 == 0 ? 0.002 : 0);
  cloud.z[5] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<Vec3> path{
      {0, 0, 0}, {0.004, 0.001, 0}, Vec3::Constant(std::numeric_limits<double>::quiet_NaN())};
  const TouchingPoints touching = touching_proxy(path, 0.005, cloud);
  ASSERT_EQ(touching.size(), 3u);
  for (std::size_t tick = 0; tick < 2; ++tick) {
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if ((cloud.point(i) - path[tick]).norm() - cloud.fixture_radius_m[i] <= 0.005)
        expected.push_back(static_cast<std::uint32_t>(i));
    EXPECT_EQ(touching[tick], expected) << tick;
    EXPECT_GT(expected.size(), 20u);
  }
  EXPECT_TRUE(touching[2].empty());
}

// A box that slides and turns through a random cloud.
std::vector<ToolPose> poses() {
  std::vector<ToolPose> list;
  for (int i = 0; i < 30; ++i)
    list.push_back({Vec3(0.0008 * i - 0.01, 0.002, 1e-4 * i),
                    Eigen::Quaterniond(Eigen::AngleAxisd(0.03 * i, Vec3(1, 2, 3).normalized()))});
  return list;
}

TEST(TouchingTool, AreThoseOfEveryPointAskedInEveryTick) {
  const auto tool = scenes::box_tool({0.02, 0.005, 0.01});
  const PointCloud cloud = scenes::random_cloud(20000, 0.05, 6);
  const std::vector<ToolPose> path = poses();
  const auto touching = touching_tool(*tool, path, cloud);
  ASSERT_EQ(touching.size(), path.size());
  for (std::size_t tick = 0; tick < path.size(); ++tick) {
    std::vector<std::uint32_t> expected;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      if (sample_field(*tool, path[tick].q_WT.conjugate() * (cloud.point(i) - path[tick].p_W)).distance_m <=
          kTouchingTool_m)
        expected.push_back(static_cast<std::uint32_t>(i));
    EXPECT_EQ(touching[tick], expected) << tick;
    EXPECT_GT(expected.size(), 20u);
  }
}

TEST(TouchingTool, NoPointTouchesIfThereIsNoPose) {
  const auto tool = scenes::box_tool({0.02, 0.005, 0.01});
  const PointCloud cloud = scenes::random_cloud(2000, 0.02, 6);
  std::vector<ToolPose> path(3);
  path[1].p_W.x() = std::numeric_limits<double>::quiet_NaN();
  const auto touching = touching_tool(*tool, path, cloud);
  EXPECT_FALSE(touching[0].empty());
  EXPECT_TRUE(touching[1].empty());
  EXPECT_EQ(touching[2], touching[0]);
  path[2].p_W = path[1].p_W;
  EXPECT_EQ(touching_tool(*tool, path, cloud)[0], touching[0]) << "the only pose is before the middle";
  for (ToolPose& pose : path) pose.p_W.x() = std::numeric_limits<double>::quiet_NaN();
  for (const auto& none : touching_tool(*tool, path, cloud)) EXPECT_TRUE(none.empty());
}

}  // namespace
}  // namespace remote_touch::touching_points_test
