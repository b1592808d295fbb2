// Points near a tool and on its way, and what it touches, compared with loops over all points.
#include "core/dissertation/tool_motion/near_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/kernels/kernels.h"
#include "tests/support/box_tool.h"
#include "tests/support/cloud_form.h"
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

  Query(const PointCloud& cloud, const Kernels& kernels_, double merged_cube_m = 0)
      : finder(kTool, kernels_), kernels(kernels_) {
    show(cloud, merged_cube_m);
  }
  void show(const PointCloud& cloud, double merged_cube_m = 0) {
    finder.on_frame(in_form<TiledCloud>(cloud, merged_cube_m));
    points.reserve(finder.cloud().padded_size());
    points.on_frame();
  }
  // True if the points are those found one by one, bit for bit. count: number of points found one by one.
  bool is_right(const ToolPose& pose, double reach_m, std::size_t& count) {
    points.query(finder, kernels, pose, reach_m);
    const auto expected = plain_places(finder.cloud().packed(), pose, reach_m);
    count = expected.size();
    return found_places(points) == expected;
  }
};

constexpr double kCube_m = 0.002;

PointCloud wavy_plane() {
  PointCloud cloud;
  for (int j = 0; j < 150; ++j)
    for (int i = 0; i < 150; ++i) {
      const double x = (i - 75) * 3e-4, z = (j - 75) * 3e-4;
      cloud.append(Vec3(x, 5e-4 * std::sin(150 * x) * std::cos(90 * z), z), Vec3::UnitY());
    }
  return cloud;
}

// Clouds that are packed, and a position of the tool on each: a surface, and points all around the tool with
// some at the same place.
std::vector<std::pair<PointCloud, Vec3>> dense_clouds() {
  PointCloud all_around = scenes::random_cloud(20000, 0.004, 31);
  for (int i = 0; i < 30; ++i) all_around.append({0.001, -0.0005, 0});
  return {{wavy_plane(), {0, 0.0055, 0}}, {all_around, {0.002, 0.006, -0.001}}};
}

class Walk {
 public:
  explicit Walk(const Vec3& start_W) : pose_{start_W, Eigen::Quaterniond::Identity()} {}
  Vector6 motion(double size) {
    Vector6 a_g;
    for (int k = 0; k < 6; ++k) a_g[k] = (k < 3 ? 5e-4 : 0.02) * size * any_(random_);
    return a_g;
  }
  // Mostly short steps, and a far one at times; it stays near the start.
  const ToolPose& step(int i) {
    pose_ = moved(pose_, motion(i % 9 == 8 ? 3 : 0.1));
    pose_.p_W += 0.1 * (start_W_ - pose_.p_W);
    return pose_;
  }

 private:
  std::mt19937 random_{7};
  std::uniform_real_distribution<double> any_{-1, 1};
  ToolPose pose_;
  const Vec3 start_W_ = pose_.p_W;
};

// Clouds without slabs, and dense ones whose groups have them. Another cloud comes in the middle of a walk of
// mostly short steps, for which the groups are kept. The reach rises and falls.
TEST(NearPoints, AreThoseOfAPlainLoopAtEveryPoseOnEveryInstructionSet) {
  std::vector<std::pair<PointCloud, Vec3>> clouds = dense_clouds();
  clouds.push_back({scenes::random_cloud(20000, 0.03, 21), Vec3(0.001, -0.002, 0.003)});
  for (const auto& [cloud, start_W] : clouds)
    for (const Kernels* kernels : supported_kernels()) {
      const double cube_m = cloud.x == clouds.back().first.x ? 0 : kCube_m;
      Query query(cloud, *kernels, cube_m);
      ASSERT_EQ(query.finder.cloud().packed().has_slabs(), cube_m > 0);
      Walk walk(start_W);
      std::size_t count = 0, most = 0;
      for (int i = 0; i < 80; ++i) {
        if (i == 40) query.show(clouds[1].first, cube_m);
        const double reach_m = i % 4 == 3 ? 2e-3 : i % 4 == 2 ? 0 : i % 20 == 0 ? 5e-3 : 2e-4;
        ASSERT_TRUE(query.is_right(walk.step(i), reach_m, count)) << kernels->isa << " " << i;
        most = std::max(most, count);
      }
      EXPECT_GT(most, 500u);
      EXPECT_TRUE(query.is_right({{0.5, 0, 0}, Eigen::Quaterniond::Identity()}, 1e-3, count));
      EXPECT_EQ(count, 0u) << "of a tool far away";
    }
}

TEST(NearPoints, PlacesALittleOutsideTheGridAreMeasuredToo) {
  const VoxelGrid& grid = kTool->grid;
  PointCloud dense;
  for (int i = 0; i < 50; ++i)
    dense.append(Vec3(grid.origin_T.x() - 0.3 * grid.size_m, 1e-4 * i, 0), Vec3::UnitX());
  for (const PointCloud& cloud : {scenes::points_outside(grid), dense}) {
    Query query(cloud, scenes::kernels(), cloud.size() == 50 ? kCube_m : 0);
    ASSERT_EQ(query.finder.cloud().packed().has_slabs(), cloud.size() == 50);
    std::size_t count = 0;
    EXPECT_TRUE(query.is_right({}, kFieldMargin_m + 3 * grid.size_m, count));
    EXPECT_EQ(count, cloud.size());
  }
}

// No point that the motion can bring into the tool is left out, and most others are.
TEST(NearPoints, OnAWayAreAllThatCanStopTheTool) {
  const ClearWay way(*kTool);
  for (const auto& [cloud, start_W] : dense_clouds())
    for (const Kernels* kernels : supported_kernels()) {
      Query query(cloud, *kernels, kCube_m);
      Walk walk(start_W);
      std::size_t stopping = 0, found = 0, all = 0;
      for (int i = 0; i < 60; ++i) {
        const ToolPose& pose = walk.step(i);
        const Vector6 a_g = walk.motion(i % 3 == 0 ? 0.1 : 1);
        const ClearWay::Motion motion(pose, a_g);
        const double far_m = way.far_m(motion, 0.03);
        SlabWay slab_way = way.slab_way(motion, far_m);
        const Vec3 ahead_W = i % 2 == 0 ? Vec3(Vec3::Zero()) : Vec3(a_g.head<3>());
        std::copy_n(ahead_W.data(), 3, slab_way.ahead_W);
        query.points.query(query.finder, *kernels, pose, slab_way);
        const std::vector<Place> places = found_places(query.points);
        std::size_t next = 0;
        for (const Place& place : plain_places(query.finder.cloud().packed(), pose, far_m)) {
          const bool is_found = next < places.size() && places[next] == place;
          if (is_found) ++next;
          const bool is_behind = query.finder.cloud().packed().normal(place.number).dot(ahead_W) > 0;
          const bool stops = !is_behind && way.fraction(motion, place.p_T, place.distance_m) < 1;
          ASSERT_TRUE(is_found || !stops) << kernels->isa << " " << i << " " << place.number;
          stopping += stops ? 1 : 0, ++all;
        }
        ASSERT_EQ(next, places.size()) << "others are found, or not in order";
        found += places.size();
      }
      EXPECT_GT(stopping, 100u);
      EXPECT_LT(found, all);
    }
}

// A motion onto a plane ends nearer to it than a point may be, but not in it.
TEST(NearPoints, OnAWayAreThoseThatTheToolComesTooCloseTo) {
  const ClearWay way(*kTool);
  for (const Kernels* kernels : supported_kernels()) {
    Query query(scenes::dense_plane(), *kernels, kCube_m);
    for (const double height_m : {1e-4, 5e-4, 9e-4})
      for (const double end_m : {0.5e-6, 1.5e-6}) {
        const ToolPose pose{{0, 0.005 + height_m, 0}, Eigen::Quaterniond::Identity()};
        Vector6 a_g = Vector6::Zero();
        a_g[1] = end_m - height_m;
        query.points.query(query.finder, *kernels, pose, way.slab_way({pose, a_g}, 1e-3));
        const std::vector<Place> found = found_places(query.points);
        const auto below = std::count_if(found.begin(), found.end(), [](const Place& place) {
          return std::abs(place.p_T.x()) < 0.0121 && std::abs(place.p_T.z()) < 0.004;  // not near an edge
        });
        EXPECT_EQ(below, end_m < ClearWay::kTouch_m ? 81 * 27 : 0) << height_m << " " << kernels->isa;
      }
  }
}

// Queries of other kinds at the same pose do not change the result.
TEST(NearPoints, KnowsWhetherOneIsBelowAValue) {
  for (const auto& [cloud, start_W] : dense_clouds())
    for (const double cube_m : {0.0, kCube_m}) {
      Query query(cloud, scenes::kernels(), cube_m);
      Walk walk(start_W - Vec3(0, 2e-4, 0));
      int yes = 0, no = 0;
      for (int i = 0; i < 100; ++i) {
        const ToolPose& pose = walk.step(i);
        const std::vector<Place> inside = plain_places(query.finder.cloud().packed(), pose, 0);
        for (const double value_m : {-2e-6, -1e-4, -6e-4, -4e-3}) {
          const bool expected = std::any_of(inside.begin(), inside.end(),
                                            [&](const Place& place) { return place.distance_m < value_m; });
          ASSERT_EQ(query.points.has_below(query.finder, scenes::kernels(), pose, value_m, 1e-3), expected)
              << i;
          ++(expected ? yes : no);
        }
        std::size_t count = 0;
        if (i % 2 == 0) {
          ASSERT_TRUE(query.is_right(pose, i % 4 == 0 ? 2e-3 : 2e-4, count)) << i;
        }
      }
      EXPECT_GT(yes, 20);
      EXPECT_GT(no, 20);
    }
}

// --- what is touched ---

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
          finder.on_frame(in_form<TiledCloud>(cloud_of(step == 40 ? 2000 : 20000, 30 + step)));
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
      const auto cloud = in_form<TiledCloud>(cloud_of(count, 50));
      list.on_frame(cloud);
      const double disk_m = with_disks ? kRatio * cloud->max_spacing_m() : 0;
      int some = 0, none = 0;
      for (int step = 0; step < 110; ++step) {
        const ToolPose pose{kPose.p_W + Vec3(6e-4 * step, 0, 0), kPose.q_WT};
        if (with_disks && step % 2 == 1) list.near(pose, 0);  // a detection changes nothing
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
  finder.on_frame(in_form<TiledCloud>(cloud));
  TouchedPoints touched(kRatio, true);
  touched.reserve(finder.cloud().padded_size());
  const double reach_m = kFieldMargin_m + 3 * grid.size_m, voxels_m = 2 * grid.size_m;
  const Touched found = touched.query(finder, scenes::kernels(), {}, reach_m, voxels_m);
  EXPECT_TRUE(are_same(found, plain_touched(finder, {}, reach_m, voxels_m, true)));
  EXPECT_LT(found.nearest_distance_m, reach_m);
}

}  // namespace
}  // namespace remote_touch::near_points_test
