#include "core/dissertation/tool/contact/near_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/kernels/isa.h"
#include "tests/support/box_tool.h"
#include "tests/support/formatted.h"
#include "tests/support/scenes.h"

namespace remote_touch::near_points_test {
namespace {

const auto kTool = scenes::box_tool({0.02, 0.005, 0.01});
const ToolPose kPose{{0.001, -0.002, 0.003}, rotation({1, 2, -0.5})};

struct Place {
  Vec3 p_T;
  double distance_m;
  std::uint32_t number;

  bool operator==(const Place& other) const {
    return p_T == other.p_T && distance_m == other.distance_m && number == other.number;
  }
};

// Computes the positions point by point.
std::vector<Place> plain_places(const TiledCloud& cloud, const ToolPose& pose, double reach_m) {
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  std::vector<Place> places;
  for (std::uint32_t i = 0; i < cloud.padded_size(); ++i) {
    const Vec3 p_T = R_TW * (cloud.point(i) - pose.p_W);
    if (p_T.norm() > 1) continue;  // padding
    const double distance_m = sample_field(*kTool, p_T).distance_m;
    if (distance_m <= reach_m) places.push_back({p_T, distance_m, i});
  }
  return places;
}

std::vector<Place> found_places(const NearPoints& points) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < points.size(); ++i)
    places.push_back({points.p_T(i), points.distance_m(i), points.number(i)});
  return places;
}

struct Query {
  TouchFinder finder;
  NearPoints points;
  const Kernels& kernels;

  Query(const PointCloud& cloud, const Kernels& kernels_) : finder(kTool, kernels_), kernels(kernels_) {
    show(cloud);
  }
  void show(const PointCloud& cloud) {
    finder.on_frame(formatted<TiledCloud>(cloud));
    points.reserve(finder.cloud().padded_size());
    points.on_frame();
  }
  // True if the points are those found one by one, bit for bit. count: number of points found one by one.
  bool is_right(const ToolPose& pose, double reach_m, std::size_t& count) {
    points.query(finder, kernels, pose, reach_m);
    const auto expected = plain_places(finder.cloud(), pose, reach_m);
    count = expected.size();
    return found_places(points) == expected;
  }
};

TEST(NearPoints, HasTheBitsOfAPlainLoopOnEveryInstructionSet) {
  const PointCloud cloud = scenes::random_cloud(20000, 0.03, 21);
  std::size_t count = 0;
  for (const Kernels* kernels : supported_kernels()) {
    Query query(cloud, *kernels);
    std::size_t before = 0;
    for (const double reach_m : {1e-4, 1e-3, 2e-3, 5e-3}) {
      EXPECT_TRUE(query.is_right(kPose, reach_m, count)) << kernels->isa << " " << reach_m;
      EXPECT_GT(count, before);
      before = count;
    }
  }
}

// Small motions, for which the groups are kept, and large ones. The reach rises and falls.
TEST(NearPoints, AreFoundAtEveryPoseOfAMotion) {
  const PointCloud cloud = scenes::random_cloud(20000, 0.03, 22);
  Query query(cloud, scenes::kernels());
  std::size_t count = 0, most = 0;
  for (int i = 0; i < 200; ++i) {
    const double step_m = i % 50 == 49 ? 5e-3 : 3e-5;
    ToolPose pose = kPose;
    pose.p_W += Vec3(i * 3e-5, i % 50 == 49 ? step_m : 0, -i * 2e-5);
    pose.q_WT = rotation({1 + i * 1e-3, 2, -0.5});
    ASSERT_TRUE(query.is_right(pose, i % 7 == 0 ? 2e-3 : 3e-4, count)) << i;
    most = std::max(most, count);
  }
  EXPECT_GT(most, 100u);
}

TEST(NearPoints, ANewCloudReplacesTheOldOne) {
  Query query(scenes::random_cloud(20000, 0.03, 23), scenes::kernels());
  std::size_t count = 0;
  ASSERT_TRUE(query.is_right(kPose, 1e-3, count));
  query.show(scenes::random_cloud(5000, 0.03, 24));
  EXPECT_TRUE(query.is_right(kPose, 1e-3, count));
  EXPECT_GT(count, 0u);
}

TEST(NearPoints, PlacesALittleOutsideTheGridAreMeasuredToo) {
  const VoxelGrid& grid = kTool->grid;
  const PointCloud cloud = scenes::points_outside(grid);
  Query query(cloud, scenes::kernels());
  const ToolPose at_home{Vec3::Zero(), Eigen::Quaterniond::Identity()};
  std::size_t count = 0;
  EXPECT_TRUE(query.is_right(at_home, kFieldMargin_m + 3 * grid.size_m, count));
  EXPECT_EQ(count, cloud.size());
}

TEST(NearPoints, NoneAreFoundForAToolFarAway) {
  Query query(scenes::random_cloud(2000, 0.03, 25), scenes::kernels());
  std::size_t count = 1;
  EXPECT_TRUE(query.is_right({{0.5, 0, 0}, Eigen::Quaterniond::Identity()}, 1e-3, count));
  EXPECT_EQ(count, 0u);
}

}  // namespace
}  // namespace remote_touch::near_points_test
