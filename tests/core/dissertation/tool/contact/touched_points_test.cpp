#include "core/dissertation/tool/contact/touched_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/dissertation/tool/contact/contact_list.h"
#include "core/dissertation/tool/contact/contact_thinning.h"
#include "core/dissertation/tool/contact/disk_contact.h"
#include "core/kernels/isa.h"
#include "tests/support/box_tool.h"
#include "tests/support/formatted.h"
#include "tests/support/scenes.h"

namespace remote_touch::touched_points_test {
namespace {

const auto kTool = scenes::box_tool({0.02, 0.005, 0.01});
const ToolPose kPose{{0.001, -0.002, 0.003}, rotation({1, 2, -0.5})};
constexpr double kReach_m = 0.002, kRatio = 0.75, kInfinite = std::numeric_limits<double>::infinity();

PointCloud cloud_of(std::size_t count, unsigned seed) {
  return scenes::cloud_with_normals(static_cast<int>(count), 0.03, seed);
}

// Point by point: the voxel of each point and the nearest position on its disk.
Touched plain_touched(const TouchFinder& finder, const ToolPose& pose, double reach_m, double voxels_m,
                      bool with_disks) {
  const TiledCloud& cloud = finder.cloud();
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  Touched all;
  all.nearest_distance_m = kInfinite;
  std::set<std::uint64_t> clusters;
  for (std::uint32_t i = 0; i < cloud.padded_size(); ++i) {
    const Vec3 p_T = R_TW * (cloud.point(i) - pose.p_W);
    if (p_T.norm() > 1) continue;  // padding
    const SurfaceDisk disk{p_T, R_TW * cloud.normal(i), kRatio * cloud.spacing_m(i),
                           sample_field(*kTool, p_T)};
    if (disk.at.distance_m > reach_m) continue;
    all.nearest_distance_m = std::min(all.nearest_distance_m, disk.at.distance_m);
    const Voxel voxel = disk.at.distance_m <= voxels_m ? finder.voxel(p_T) : Voxel::free;
    const bool is_touched = with_disks && lower_bound_m(disk) <= TouchedPoints::kTouch_m &&
                            nearest_position(*kTool, disk).at.distance_m <= TouchedPoints::kTouch_m;
    if (voxel == Voxel::free && !is_touched) continue;
    ++all.points;
    clusters.insert(cell_number(p_T, 100));
    all.state =
        std::max(all.state, voxel == Voxel::interior ? ContactState::entrenched : ContactState::contact);
  }
  all.clusters = static_cast<int>(clusters.size());
  return all;
}

::testing::AssertionResult are_same(const Touched& a, const Touched& b) {
  if (a.state == b.state && a.points == b.points && a.clusters == b.clusters &&
      a.nearest_distance_m == b.nearest_distance_m)
    return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure()
         << a.points << " points in " << a.clusters << " clusters, nearest " << a.nearest_distance_m
         << " m, instead of " << b.points << " in " << b.clusters << ", " << b.nearest_distance_m << " m";
}

// A walk of short steps, for which groups are kept and skipped. Long steps, other reaches and new frames come
// between them.
TEST(TouchedPoints, AreThoseOfALoopOverAllPointsOnAWalk) {
  const double voxels_m = 2 * kTool->grid.size_m;
  for (const Kernels* kernels : supported_kernels())
    for (const bool with_disks : {true, false}) {
      TouchFinder finder(kTool, *kernels);
      TouchedPoints touched(kRatio, with_disks);
      ToolPose pose = kPose;
      int several = 0;
      for (int step = 0; step < 60; ++step) {
        if (step % 20 == 0) {
          finder.on_frame(formatted<TiledCloud>(cloud_of(step == 40 ? 2000 : 20000, 30 + step)));
          touched.reserve(finder.cloud().padded_size());
          touched.on_frame();
        }
        const double a = 0.7 * step, size = step % 15 == 14 ? 100 : 1;
        Vector6 motion;
        motion << std::sin(a), std::cos(1.3 * a), std::sin(2.1 * a), 30 * std::cos(a), 30 * std::sin(1.7 * a),
            30;
        pose = moved(pose, size * 2e-5 * motion);
        const double reach_m = step % 7 == 6 ? 0.005 : step % 5 == 4 ? 0.0005 : kReach_m;
        const Touched found = touched.query(finder, *kernels, pose, reach_m, voxels_m);
        ASSERT_TRUE(are_same(found, plain_touched(finder, pose, reach_m, voxels_m, with_disks)))
            << step << " " << kernels->isa;
        several += found.points > 50 && found.clusters > 3 ? 1 : 0;
      }
      EXPECT_GT(several, 20);
    }
}

// The tool is deep in a cloud, then at its rim with few points near, and then outside. The reach that
// ContactList chooses omits no point that counts.
TEST(TouchedPoints, AContactListCountsEveryTouchedPoint) {
  ToolParameters p;
  const double voxels_m = 2 * kTool->grid.size_m;
  for (const ContactRule rule : {ContactRule::look_ahead, ContactRule::voxels})
    for (const std::size_t count : {20000u, 500u}) {
      p.contact_rule = rule, p.disk_radius_ratio = kRatio;
      const bool with_disks = rule == ContactRule::look_ahead;
      ContactList list(kTool, p, scenes::kernels());
      const auto cloud = formatted<TiledCloud>(cloud_of(count, 50));
      list.on_frame(cloud);
      const double disk_m = with_disks ? kRatio * cloud->max_spacing_m() : 0;
      int some = 0, none = 0;
      for (int step = 0; step < 110; ++step) {
        const ToolPose pose{kPose.p_W + Vec3(6e-4 * step, 0, 0), kPose.q_WT};
        const auto plain = [&](double reach_m) {
          return plain_touched(list.finder(), pose, std::min(reach_m, kFieldMargin_m - 2e-4), voxels_m,
                               with_disks);
        };
        Touched expected = plain(std::max(voxels_m, TouchedPoints::kTouch_m + disk_m));
        if (expected.nearest_distance_m > voxels_m) expected = plain(p.look_ahead_m + disk_m);
        if (expected.nearest_distance_m > p.look_ahead_m) expected.nearest_distance_m = kInfinite;
        ASSERT_TRUE(are_same(list.touched(pose), expected)) << step;
        some += expected.points > 0, none += expected.nearest_distance_m == kInfinite;
      }
      EXPECT_GT(some, 10);
      EXPECT_GT(none, 5);
    }
}

// Five points a fraction of a cell outside the grid.
TEST(TouchedPoints, PlacesOutsideTheGridAreMeasuredToo) {
  const VoxelGrid& grid = kTool->grid;
  const PointCloud cloud = scenes::points_outside(grid);
  TouchFinder finder(kTool, scenes::kernels());
  finder.on_frame(formatted<TiledCloud>(cloud));
  TouchedPoints touched(kRatio, true);
  touched.reserve(finder.cloud().padded_size());
  const double reach_m = kFieldMargin_m + 3 * grid.size_m, voxels_m = 2 * grid.size_m;
  const Touched found = touched.query(finder, scenes::kernels(), {}, reach_m, voxels_m);
  EXPECT_TRUE(are_same(found, plain_touched(finder, {}, reach_m, voxels_m, true)));
  EXPECT_LT(found.nearest_distance_m, reach_m);
}

}  // namespace
}  // namespace remote_touch::touched_points_test
