#include "core/tool/contact/near_disks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/tool/contact/contact_list.h"
#include "tests/support/box_tool.h"
#include "tests/support/formatted.h"
#include "tests/support/scenes.h"

namespace remote_touch::near_disks_test {
namespace {

const auto kTool = scenes::box_tool({0.02, 0.005, 0.01});
const ToolPose kPose{{0.001, -0.002, 0.003}, rotation({1, 2, -0.5})};
constexpr double kReach_m = 0.005, kFraction = 0.75, kCell_m = 0.004;

// Normals in all directions; every seventh point has none.
PointCloud cloud_with_normals() {
  PointCloud cloud = scenes::random_cloud(20000, 0.03, 21);
  const PointCloud directions = scenes::random_cloud(20000, 1, 22);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 n = i % 7 == 0 ? Vec3(Vec3::Constant(std::nan(""))) : directions.point(i).normalized();
    cloud.nx.push_back(n.x()), cloud.ny.push_back(n.y()), cloud.nz.push_back(n.z());
  }
  return cloud;
}

struct Look {
  TouchFinder finder;
  NearDisks disks{kFraction, kCell_m};

  Look(const PointCloud& cloud, const Kernels& kernels) : finder(kTool, kernels) {
    finder.on_frame(formatted<TiledCloud>(cloud));
    disks.on_frame(finder.cloud());
    disks.query(finder, kernels, kPose, kReach_m);
  }
};

bool same(const Vec3& a, const Vec3& b) {
  return a == b || (!a.allFinite() && !b.allFinite());
}

TEST(NearDisks, TheSameBitsAsOneAfterTheOtherOnEveryInstructionSet) {
  const PointCloud cloud = cloud_with_normals();
  const Eigen::Matrix3d R_TW = kPose.q_WT.conjugate().toRotationMatrix();
  for (const Isa isa : {Isa::x86_64, Isa::x86_64_v3, Isa::x86_64_v4}) {
    if (isa > best_isa()) continue;
    const Look query(cloud, kernels_for(isa));
    const auto points = query.finder.within(kPose, kReach_m + NearDisks::kSpare_m);
    const TiledCloud& tiled = query.finder.cloud();
    ASSERT_EQ(query.disks.size(), points.size());
    EXPECT_GT(points.size(), 1000u);
    for (std::size_t k = 0; k < points.size(); ++k) {
      const std::uint32_t i = points[k];
      const Vec3 p_T = R_TW * (tiled.point(i) - kPose.p_W);
      const SurfaceDisk expected{p_T, R_TW * tiled.normal(i), kFraction * tiled.spacing_m(i),
                                 sample_field(*kTool, p_T)};
      const SurfaceDisk disk = query.disks.disk(k);
      ASSERT_EQ(disk.p_T, p_T);
      ASSERT_TRUE(same(disk.n_T, expected.n_T));
      ASSERT_EQ(disk.radius_m, expected.radius_m);
      ASSERT_EQ(disk.at.distance_m, expected.at.distance_m);
      ASSERT_EQ(disk.at.gradient_T, expected.at.gradient_T);
      ASSERT_EQ(query.disks.lower_m(k), lower_bound_m(expected));
      ASSERT_EQ(query.disks.cell(k), cell_and_octant(p_T, -expected.at.gradient_T, 1 / kCell_m));
    }
  }
}

// A point less than a cell outside the grid can be in the list.
TEST(NearDisks, PlacesOutsideTheGridAreMeasuredToo) {
  const VoxelGrid& grid = kTool->grid;
  PointCloud cloud;
  for (int i = 0; i < 5; ++i)
    cloud.append(Vec3(grid.origin_T.x() - 0.3 * grid.size_m, 1e-3 * i, 0), Vec3::UnitX());
  TouchFinder finder(kTool, scenes::kernels());
  finder.on_frame(formatted<TiledCloud>(cloud));
  NearDisks disks(kFraction, kCell_m);
  disks.on_frame(finder.cloud());
  disks.query(finder, scenes::kernels(), {}, kFieldMargin_m + grid.size_m);
  EXPECT_EQ(disks.size(), cloud.size());
  for (std::size_t k = 0; k < disks.size(); ++k) {
    EXPECT_EQ(disks.distance_m(k), sample_field(*kTool, disks.p_T(k)).distance_m);
    EXPECT_EQ(disks.lower_m(k), lower_bound_m(disks.disk(k)));
    EXPECT_EQ(disks.disk(k).at.gradient_T, sample_field(*kTool, disks.p_T(k)).gradient_T);
    EXPECT_LT(disks.disk(k).at.gradient_T.x(), -0.5) << "out of the tool";
  }
}

// How many disks are within a distance.
std::size_t within(const NearDisks& disks, double distance_m) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < disks.size(); ++k) count += disks.distance_m(k) <= distance_m ? 1 : 0;
  return count;
}

// What was found for a pose is not what counts in the next frame, at another pose or for another reach.
TEST(NearDisks, AnAnswerIsKeptForItsOwnQuestionOnly) {
  const PointCloud cloud = cloud_with_normals();
  const Kernels& kernels = scenes::kernels();
  Look query(cloud, kernels);
  const std::size_t all = within(query.disks, kReach_m), some = within(query.disks, 0.001);
  EXPECT_LT(some, all);
  query.disks.query(query.finder, kernels, kPose, 0.001);
  EXPECT_EQ(within(query.disks, 0.001), some);
  query.disks.query(query.finder, kernels, {{1, 1, 1}, kPose.q_WT}, 0.001);
  EXPECT_EQ(query.disks.size(), 0u);
  query.disks.query(query.finder, kernels, kPose, 0.001);
  EXPECT_EQ(within(query.disks, 0.001), some);
  query.disks.query(query.finder, kernels, kPose, kReach_m);
  EXPECT_EQ(within(query.disks, kReach_m), all);
  PointCloud fewer = cloud;
  fewer.x.resize(5000), fewer.y.resize(5000), fewer.z.resize(5000);
  fewer.nx.resize(5000), fewer.ny.resize(5000), fewer.nz.resize(5000);
  query.finder.on_frame(formatted<TiledCloud>(fewer));
  query.disks.on_frame(query.finder.cloud());
  query.disks.query(query.finder, kernels, kPose, kReach_m);
  EXPECT_LT(within(query.disks, kReach_m), all);
  EXPECT_GT(within(query.disks, kReach_m), 0u);
}

// A walk of steps that are mostly so short that the points are kept: at every pose all points within reach
// are there, as a loop over all points finds them.
TEST(NearDisks, PointsKeptFromEarlierPosesAreAllThatAreWithinReach) {
  constexpr double kShort_m = 2e-5;
  const PointCloud cloud = cloud_with_normals();
  Look query(cloud, scenes::kernels());
  ToolPose pose = kPose;
  int kept = 0;
  for (int step = 0; step < 60; ++step) {
    const double a = 0.7 * step, size = step % 20 == 19 ? 100 : 1;
    Vector6 motion;
    motion << std::sin(a), std::cos(1.3 * a), std::sin(2.1 * a), 30 * std::cos(a), 30 * std::sin(1.7 * a), 30;
    pose = moved(pose, size * kShort_m * motion);
    query.disks.query(query.finder, scenes::kernels(), pose, kReach_m);
    const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
    std::size_t expected = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i)
      expected += sample_field(*kTool, R_TW * (cloud.point(i) - pose.p_W)).distance_m <= kReach_m ? 1 : 0;
    ASSERT_EQ(within(query.disks, kReach_m), expected) << step;
    kept += query.disks.size() != query.finder.within(pose, kReach_m + NearDisks::kSpare_m).size() ? 1 : 0;
  }
  EXPECT_GT(kept, 10) << "the points were searched anew at every step";
}

// A list that has looked at the pose already, and one that has not.
TEST(NearDisks, WhatIsTouchedIsTheSameAfterADetection) {
  const PointCloud cloud = cloud_with_normals();
  ContactList looked(kTool, {}, scenes::kernels()), fresh(kTool, {}, scenes::kernels());
  looked.on_frame(formatted<TiledCloud>(cloud)), fresh.on_frame(formatted<TiledCloud>(cloud));
  looked.near(kPose, 0);
  const Touched a = looked.touched(kPose), b = fresh.touched(kPose);
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.clusters, b.clusters);
  EXPECT_EQ(a.nearest_distance_m, b.nearest_distance_m);
  EXPECT_EQ(a.state, b.state);
  EXPECT_GT(a.points, 0);
}

}  // namespace
}  // namespace remote_touch::near_disks_test
