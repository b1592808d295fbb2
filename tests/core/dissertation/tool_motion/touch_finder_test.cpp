#include "core/dissertation/tool_motion/touch_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/support/box_tool.h"
#include "tests/support/cloud_form.h"
#include "tests/support/scenes.h"

namespace remote_touch::touch_finder_test {
namespace {

const Vec3 kHalf_m(0.02, 0.005, 0.01);

// Positions, not numbers: the finder keeps its points in an order of its own.
using Places = std::set<std::array<double, 3>>;

Places places(const TouchFinder& finder, std::span<const std::uint32_t> points) {
  Places found;
  for (const std::uint32_t i : points) {
    const Vec3 p = finder.cloud().point(i);
    found.insert({p.x(), p.y(), p.z()});
  }
  return found;
}

template <class Wanted>  // wanted(p_T) -> bool
Places brute_force(const PointCloud& cloud, const ToolPose& pose, const Wanted& wanted) {
  Places found;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (wanted(Vec3(pose.q_WT.conjugate() * (cloud.point(i) - pose.p_W))))
      found.insert({cloud.x[i], cloud.y[i], cloud.z[i]});
  return found;
}

std::vector<ToolPose> poses() {
  return {{{0, 0, 0}, Eigen::Quaterniond::Identity()},
          {{0.01, -0.02, 0.03}, rotation({1, 2, -0.5})},
          {{0.09, 0.09, -0.09}, rotation({-0.2, 0.1, 3})},
          {{0.5, 0, 0}, rotation({0, 0.3, 0})},
          {{0.115, 0.02, 0}, rotation({0, 0, 1.5})}};
}

// Rounding can put a point on a cell's face into either neighbour: none of these points lies that close.
TEST(TouchFinder, FindsThePointsInTheVoxelsOfTheTool) {
  const PointCloud cloud = scenes::random_cloud(40000, 0.1, 11);
  const auto tool = scenes::box_tool(kHalf_m);
  for (const Kernels* kernels : supported_kernels()) {
    TouchFinder finder(tool, *kernels);
    finder.on_frame(in_form<TiledCloud>(cloud));
    int max = 0;
    for (const ToolPose& pose : poses()) {
      const Places expected =
          brute_force(cloud, pose, [&](const Vec3& p) { return (p.cwiseAbs() - kHalf_m).maxCoeff() <= 0; });
      EXPECT_EQ(places(finder, finder.in_tool(pose)), expected);
      max = std::max(max, static_cast<int>(expected.size()));
    }
    EXPECT_GT(max, 50);
  }
}

// Compared with the eight nodes of every voxel that is not free. The tool's field has no symmetry.
TEST(TouchFinder, KnowsTheLargestFieldInAVoxel) {
  auto tool = std::make_shared<VoxelTool>(*scenes::box_tool(kHalf_m));
  const auto& cells = tool->grid.cells;
  const auto node = [&](int i, int j, int k) {
    return static_cast<std::size_t>((k * (cells[1] + 1) + j) * (cells[0] + 1) + i);
  };
  for (int k = 0; k <= cells[2]; ++k)
    for (int j = 0; j <= cells[1]; ++j)
      for (int i = 0; i <= cells[0]; ++i)
        tool->distance_m[node(i, j, k)] += static_cast<float>(1e-6 * i - 3e-6 * j + 2e-6 * k);
  float max = -1;
  std::size_t cell = 0;
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i)
        if (tool->voxels[cell++] != Voxel::free)
          for (int corner = 0; corner < 8; ++corner)
            max = std::max(max, tool->distance_m[node(i + corner % 2, j + corner / 2 % 2, k + corner / 4)]);
  EXPECT_NEAR(TouchFinder(tool, scenes::kernels()).max_voxel_m(), static_cast<double>(max), 2e-9);
}

TEST(TouchFinder, MissesNothingWithinADistanceAndAddsLittle) {
  const PointCloud cloud = scenes::random_cloud(40000, 0.1, 12);
  const auto tool = scenes::box_tool(kHalf_m);
  const double slack_m = 2 * tool->grid.size_m;
  TouchFinder finder(tool, scenes::kernels());
  finder.on_frame(in_form<TiledCloud>(cloud));
  for (const ToolPose& pose : poses())
    for (const double distance : {-0.002, 0.0, 0.001, 0.0055}) {
      const Places found = places(finder, finder.within(pose, distance));
      const auto closer_than = [&](double d) {
        return brute_force(cloud, pose, [&](const Vec3& p) { return scenes::box_distance(kHalf_m, p) <= d; });
      };
      for (const auto& place : closer_than(distance)) EXPECT_TRUE(found.count(place));
      const Places allowed = closer_than(distance + slack_m);
      for (const auto& place : found) EXPECT_TRUE(allowed.count(place));
    }
}

TEST(TouchFinder, FindsTheSameListOnEveryInstructionSet) {
  PointCloud cloud = scenes::random_cloud(20000, 0.04, 13);
  cloud.x[77] = std::nan(""), cloud.y[78] = 1e300;
  const auto tool = scenes::box_tool(kHalf_m);
  std::vector<std::vector<std::uint32_t>> lists;
  for (const Kernels* kernels : supported_kernels()) {
    TouchFinder finder(tool, *kernels);
    finder.on_frame(in_form<TiledCloud>(cloud));
    const auto list = finder.within(poses()[1], 0.003);
    lists.emplace_back(list.begin(), list.end());
    EXPECT_GT(list.size(), 100u);
  }
  for (const auto& list : lists) EXPECT_EQ(list, lists.front());
}

TEST(TouchFinder, FindsNothingInAnEmptyCloudOrFarAway) {
  TouchFinder finder(scenes::box_tool(kHalf_m), scenes::kernels());
  EXPECT_TRUE(finder.in_tool({}).empty());  // before the first frame
  finder.on_frame(in_form<TiledCloud>({}));
  EXPECT_TRUE(finder.in_tool({}).empty());
  PointCloud unmeasured;
  for (int i = 0; i < 100; ++i) unmeasured.append(Vec3::Constant(std::nan("")));
  finder.on_frame(in_form<TiledCloud>(unmeasured));
  EXPECT_TRUE(finder.within({}, 0.005).empty());
  finder.on_frame(in_form<TiledCloud>(scenes::random_cloud(1000, 0.01, 1)));
  EXPECT_TRUE(finder.within({{1e6, -1e6, 1e6}, Eigen::Quaterniond::Identity()}, 0.005).empty());
}

}  // namespace
}  // namespace remote_touch::touch_finder_test
