#include "core/dissertation/tool_motion/near_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "core/dissertation/tool_motion/contact_list.h"
#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/dissertation/tool_motion/touch_finder.h"
#include "core/kernels/kernels.h"
#include "tests/support/box_tool.h"
#include "tests/support/cloud_form.h"
#include "tests/support/scenes.h"

namespace remote_touch::near_disks_test {
namespace {

constexpr double kMissed_m = 5e-5;  // error of a search along two lines, at a corner

// Nineteen voxels high, so that its middle is the middle of a cell.
const auto kPlate = scenes::box_tool({0.01, 0.00475, 0.01});

SurfaceDisk disk_at(const Vec3& p_T, const Vec3& n_T, double radius_m = 1e-3) {
  return {p_T, n_T, radius_m, sample_field(*kPlate, p_T)};
}

TEST(DiskContact, ADiskBelowAFaceIsMetInItsPlane) {
  const SurfaceDisk disk = disk_at({0.001, -0.00485, 0.002}, Vec3::UnitY());
  const ToolContact contact = near_contact(*kPlate, disk, nearest_position(*kPlate, disk), 0);
  EXPECT_EQ(contact.n_T, Vec3(0, 1, 0));
  EXPECT_EQ(contact.side, 1);
  EXPECT_NEAR(contact.depth_m, -1e-4, 1e-9);
}

// The same disk faces away from the tool, so the tool is behind the surface.
TEST(DiskContact, TurnsThePlaneIfTheDiskFacesAway) {
  const SurfaceDisk disk = disk_at({0.001, -0.00485, 0.002}, -Vec3::UnitY());
  const ToolContact contact = near_contact(*kPlate, disk, nearest_position(*kPlate, disk), 0);
  EXPECT_EQ(contact.n_T, Vec3(0, 1, 0));
  EXPECT_EQ(contact.side, -1);
}

// A point that a frame puts halfway between two faces came from the sensor's side. The field has no clear
// direction there, so the normal decides.
TEST(DiskContact, TheNormalDecidesAtTheRidgeOfTheField) {
  for (const double up : {1.0, -1.0}) {
    const SurfaceDisk disk = disk_at({0.001, 0, 0.002}, {0, up, 0});
    ASSERT_LT(disk.at.gradient_T.norm(), 0.1);
    const ToolContact contact = near_contact(*kPlate, disk, nearest_position(*kPlate, disk), 0);
    EXPECT_EQ(contact.n_T, Vec3(0, up, 0));
    EXPECT_EQ(contact.side, 1);
  }
}

// A known side counts inside the tool, and nowhere else.
TEST(DiskContact, AKnownSideCountsInside) {
  const SurfaceDisk inside = disk_at({0.001, -0.00425, 0.002}, Vec3::UnitY()),
                    outside = disk_at({0.001, -0.00485, 0.002}, Vec3::UnitY());
  EXPECT_EQ(near_contact(*kPlate, inside, nearest_position(*kPlate, inside), -1).n_T, Vec3(0, -1, 0));
  EXPECT_EQ(near_contact(*kPlate, outside, nearest_position(*kPlate, outside), -1).n_T, Vec3(0, 1, 0));
}

// The disk lies beside the plate, edge-on and within reach of its rim: it touches the tool at the rim.
TEST(DiskContact, ADiskSeenEdgeOnIsMetAtItsRim) {
  const SurfaceDisk disk = disk_at({0.0112, 0.001, 0.002}, Vec3::UnitZ());
  const DiskPosition nearest = nearest_position(*kPlate, disk);
  EXPECT_TRUE(nearest.at_rim);
  EXPECT_NEAR((nearest.p_T - disk.p_T).norm(), disk.radius_m, 1e-12);
  const ToolContact contact = near_contact(*kPlate, disk, nearest, 0);
  EXPECT_NEAR(contact.depth_m, -2e-4, 1e-9);
  EXPECT_NEAR(contact.n_T.x(), -1, 1e-9);
  EXPECT_EQ(contact.side, 0);
}

// A corner of the plate lies above a disk. A dense scan of the disk finds no position that is nearer by more
// than a search along two lines can miss.
TEST(DiskContact, NoPlaceOfADiskBelowACornerIsNearer) {
  const Vec3 n = Vec3(1, -1, 1).normalized(), corner(0.01, -0.00475, 0.01);
  const Vec3 u = Vec3(1, 1, 0).normalized(), v = n.cross(u);
  for (const double off_m : {-6e-4, -3e-4, 0.0, 4e-4}) {
    const SurfaceDisk disk = disk_at(corner + 2e-4 * n + off_m * u, -n);
    double min_m = 1;
    for (int i = -50; i <= 50; ++i)
      for (int j = -50; j <= 50; ++j)
        if (i * i + j * j <= 2500)
          min_m = std::min(min_m,
                           sample_field(*kPlate, disk.p_T + disk.radius_m / 50 * (i * u + j * v)).distance_m);
    const DiskPosition nearest = nearest_position(*kPlate, disk);
    EXPECT_LE(nearest.at.distance_m, disk.at.distance_m);
    EXPECT_NEAR(nearest.at.distance_m, min_m, kMissed_m) << off_m;
    EXPECT_LE(lower_bound_m(disk), min_m);
  }
}

// The field over the disk of one point is flat if its slope is small. A merged disk also needs a small rise
// of the field across it.
TEST(DiskContact, FlatFieldDependsOnSlopeDepthAndExtent) {
  const double slope = 0.9 * disk_search::kFlatSlope, steep = 1.1 * disk_search::kFlatSlope;
  const double small_m = 0.9 * disk_search::kFlatDepth_m / slope,
               large_m = 1.1 * disk_search::kFlatDepth_m / slope;
  for (const double extent_m : {0.0, 1e-3}) {
    EXPECT_TRUE(is_flat(slope, small_m, extent_m));
    EXPECT_FALSE(is_flat(steep, small_m, extent_m));
    EXPECT_EQ(is_flat(slope, large_m, extent_m), extent_m == 0);
  }
}

TEST(DiskContact, FarAwayItIsTheMiddleWithTheBoundAsDistance) {
  const SurfaceDisk disk = disk_at({0.001, -0.00625, 0.002}, Vec3(1, 2, 0).normalized());
  const ToolContact contact = far_contact(disk, lower_bound_m(disk));
  EXPECT_EQ(contact.r_T, disk.p_T);
  EXPECT_NEAR((contact.n_T - Vec3::UnitY()).norm(), 0, 1e-6);
  EXPECT_EQ(contact.side, 1);
  EXPECT_LT(contact.depth_m, 0);
  EXPECT_GT(contact.depth_m, -disk.at.distance_m);
}

const auto kTool = scenes::box_tool({0.02, 0.005, 0.01});
const ToolPose kPose{{0.001, -0.002, 0.003}, rotation({1, 2, -0.5})};
constexpr double kReach_m = 0.005, kFraction = 0.75, kCell_m = 0.004;

PointCloud cloud_with_normals() {
  return scenes::cloud_with_normals(20000, 0.03, 21);
}

struct Query {
  TouchFinder finder;
  NearDisks disks{kFraction, kCell_m};

  Query(const PointCloud& cloud, const Kernels& kernels) : finder(kTool, kernels) {
    finder.on_frame(in_form<TiledCloud>(cloud));
    disks.on_frame(finder.cloud());
    disks.query(finder, kernels, kPose, kReach_m);
  }
};

bool same(const Vec3& a, const Vec3& b) {
  return a == b || (!a.allFinite() && !b.allFinite());
}

// Computes the disks within reach_m whose lower bound is at most max_lower_m, one after the other.
std::vector<SurfaceDisk> plain_disks(const TiledCloud& cloud, const ToolPose& pose, double reach_m,
                                     double max_lower_m) {
  const Eigen::Matrix3d R_TW = pose.q_WT.conjugate().toRotationMatrix();
  std::vector<SurfaceDisk> disks;
  for (std::uint32_t i = 0; i < cloud.padded_size(); ++i) {
    const Vec3 p_T = R_TW * (cloud.point(i) - pose.p_W);
    if (p_T.norm() > 1) continue;  // padding
    const SurfaceDisk disk{p_T, R_TW * cloud.normal(i), kFraction * cloud.spacing_m(i),
                           sample_field(*kTool, p_T)};
    if (disk.at.distance_m <= reach_m && lower_bound_m(disk) <= max_lower_m) disks.push_back(disk);
  }
  return disks;
}

// True if the bound is the field's own distance: the disk is near enough to be searched, and the field is too
// flat in the disk's plane for a slide to begin.
bool bound_is_distance(const SurfaceDisk& disk) {
  const Vec3 along = disk.at.gradient_T - disk.at.gradient_T.dot(disk.n_T) * disk.n_T;
  return lower_bound_m(disk) <= NearDisks::kSearch_m && is_flat(along.norm(), disk.radius_m, disk.extent_m);
}

::testing::AssertionResult are_same(const NearDisks& found, const std::vector<SurfaceDisk>& expected) {
  if (found.size() != expected.size())
    return ::testing::AssertionFailure() << found.size() << " disks instead of " << expected.size();
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const SurfaceDisk disk = found.disk(k), &plain = expected[k];
    const double lower_m = lower_bound_m(plain);
    const bool is_same = disk.p_T == plain.p_T && same(disk.n_T, plain.n_T) &&
                         disk.radius_m == plain.radius_m && disk.at.distance_m == plain.at.distance_m &&
                         disk.at.gradient_T == plain.at.gradient_T && found.lower_m(k) == lower_m &&
                         found.bound_m(k) == (bound_is_distance(plain) ? plain.at.distance_m : lower_m) &&
                         found.cell(k) == cell_and_octant(plain.p_T, -plain.at.gradient_T, 1 / kCell_m);
    if (!is_same) return ::testing::AssertionFailure() << "disk " << k << " is another one";
  }
  return ::testing::AssertionSuccess();
}

TEST(NearDisks, HasTheBitsOfAPlainLoopOnEveryInstructionSet) {
  const PointCloud cloud = cloud_with_normals();
  for (const Kernels* kernels : supported_kernels()) {
    Query query(cloud, *kernels);
    const TiledCloud& tiled = query.finder.cloud();
    for (const double max_lower_m : {std::numeric_limits<double>::infinity(), 0.002, 0.0002}) {
      query.disks.query(query.finder, *kernels, kPose, kReach_m, max_lower_m);
      EXPECT_TRUE(are_same(query.disks, plain_disks(tiled, kPose, kReach_m, max_lower_m))) << kernels->isa;
      EXPECT_GT(query.disks.size(), 100u);
    }
  }
}

// A point less than a cell outside the grid can be in the list.
TEST(NearDisks, PlacesOutsideTheGridAreMeasuredToo) {
  const VoxelGrid& grid = kTool->grid;
  const PointCloud cloud = scenes::points_outside(grid);
  TouchFinder finder(kTool, scenes::kernels());
  finder.on_frame(in_form<TiledCloud>(cloud));
  NearDisks disks(kFraction, kCell_m);
  disks.on_frame(finder.cloud());
  disks.query(finder, scenes::kernels(), {}, kFieldMargin_m + 3 * grid.size_m);
  EXPECT_EQ(disks.size(), cloud.size());
  for (std::size_t k = 0; k < disks.size(); ++k) {
    EXPECT_EQ(disks.distance_m(k), sample_field(*kTool, disks.p_T(k)).distance_m);
    EXPECT_EQ(disks.lower_m(k), lower_bound_m(disks.disk(k)));
    EXPECT_EQ(disks.disk(k).at.gradient_T, sample_field(*kTool, disks.p_T(k)).gradient_T);
    EXPECT_LT(disks.disk(k).at.gradient_T.x(), -0.5) << "out of the tool";
  }
}

// Number of disks within a distance.
std::size_t within(const NearDisks& disks, double distance_m) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < disks.size(); ++k) count += disks.distance_m(k) <= distance_m ? 1 : 0;
  return count;
}

// A result for one pose is not reused in the next frame, at another pose or for another reach.
TEST(NearDisks, AResultIsKeptForItsOwnQueryOnly) {
  const PointCloud cloud = cloud_with_normals();
  const Kernels& kernels = scenes::kernels();
  Query query(cloud, kernels);
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
  query.finder.on_frame(in_form<TiledCloud>(fewer));
  query.disks.on_frame(query.finder.cloud());
  query.disks.query(query.finder, kernels, kPose, kReach_m);
  EXPECT_LT(within(query.disks, kReach_m), all);
  EXPECT_GT(within(query.disks, kReach_m), 0u);
}

// A walk of mostly very short steps, for which points are kept from earlier poses and groups of points are
// skipped. The disks are those of a loop over all points, at every pose and in every frame.
TEST(NearDisks, PointsKeptFromEarlierPosesAreAllThatAreWithinReach) {
  constexpr double kShort_m = 2e-5;
  for (const Kernels* kernels : supported_kernels()) {
    Query query(cloud_with_normals(), *kernels);
    ToolPose pose = kPose;
    int kept = 0;
    for (int step = 0; step < 60; ++step) {
      const double a = 0.7 * step, size = step % 20 == 19 ? 100 : 1;
      Vector6 motion;
      motion << std::sin(a), std::cos(1.3 * a), std::sin(2.1 * a), 30 * std::cos(a), 30 * std::sin(1.7 * a),
          30;
      pose = moved(pose, size * kShort_m * motion);
      if (step % 25 == 24) {
        query.finder.on_frame(in_form<TiledCloud>(scenes::random_cloud(20000, 0.03, 100 + step)));
        query.disks.on_frame(query.finder.cloud());
      }
      const double reach_m = step % 7 == 6 ? 0.5 * kReach_m : kReach_m,
                   max_lower_m = step % 2 == 0 ? 0.002 : 1;
      query.disks.query(query.finder, *kernels, pose, reach_m, max_lower_m);
      ASSERT_TRUE(are_same(query.disks, plain_disks(query.finder.cloud(), pose, reach_m, max_lower_m)))
          << step << " " << kernels->isa;
      kept += query.disks.kept_points() != query.finder.within(pose, reach_m + NearDisks::kSpare_m).size();
    }
    EXPECT_GT(kept, 10) << "the points were searched anew at every step";
  }
}

// Compares a list that has been queried at this pose with a fresh one.
TEST(NearDisks, ADetectionDoesNotChangeWhatIsTouched) {
  const PointCloud cloud = cloud_with_normals();
  ContactList looked(kTool, {}, scenes::kernels()), fresh(kTool, {}, scenes::kernels());
  looked.on_frame(in_form<TiledCloud>(cloud)), fresh.on_frame(in_form<TiledCloud>(cloud));
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
