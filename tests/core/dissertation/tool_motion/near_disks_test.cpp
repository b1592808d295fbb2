// Disks near a tool and what touches it, compared with loops over all points.
#include "core/dissertation/tool_motion/near_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

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

// The tool is behind a surface whose disk faces away. Where the field has no clear direction, at its ridge,
// the normal decides: a point that a frame puts halfway between two faces came from the sensor's side. A
// known side counts inside the tool, and nowhere else.
TEST(DiskContact, ThePlaneAndTheSideAreThoseOfTheFieldExceptAtItsRidge) {
  struct Case {
    double y_m, up, known_side;  // the disk at this height, its normal up or down
    double expected_up, expected_side;
  };
  for (const auto& [y_m, up, known_side, expected_up, expected_side] : {Case{-0.00485, 1, 0, 1, 1},
                                                                        {-0.00485, -1, 0, 1, -1},
                                                                        {0, 1, 0, 1, 1},
                                                                        {0, -1, 0, -1, 1},
                                                                        {-0.00425, 1, -1, -1, -1},
                                                                        {-0.00485, 1, -1, 1, 1}}) {
    const SurfaceDisk disk = disk_at({0.001, y_m, 0.002}, {0, up, 0});
    EXPECT_EQ(disk.at.gradient_T.norm() < 0.1, y_m == 0);
    const ToolContact contact = near_contact(*kPlate, disk, nearest_position(*kPlate, disk), known_side);
    EXPECT_EQ(contact.n_T, Vec3(0, expected_up, 0)) << y_m << " " << up << " " << known_side;
    EXPECT_EQ(contact.side, expected_side) << y_m << " " << up << " " << known_side;
    if (y_m == -0.00485) {
      EXPECT_NEAR(contact.depth_m, -1e-4, 1e-9);
    }
  }
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

TEST(DiskContact, FarAwayItIsTheMiddleWithTheBoundAsDistance) {
  const SurfaceDisk disk = disk_at({0.001, -0.00625, 0.002}, Vec3(1, 2, 0).normalized());
  const ToolContact contact = far_contact(disk, lower_bound_m(disk));
  EXPECT_EQ(contact.r_T, disk.p_T);
  EXPECT_NEAR((contact.n_T - Vec3::UnitY()).norm(), 0, 1e-6);
  EXPECT_EQ(contact.side, 1);
  EXPECT_LT(contact.depth_m, 0);
  EXPECT_GT(contact.depth_m, -disk.at.distance_m);
}

const Vec3 kHalf_m(0.02, 0.005, 0.01);
const auto kTool = scenes::box_tool(kHalf_m);
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
      const double max_lower_m = step % 3 == 0 ? 1 : step % 3 == 1 ? 0.002 : 0.0002;
      // A result for one reach is not reused for a longer one at the same pose.
      for (const double reach_m : {0.2 * kReach_m, step % 7 == 6 ? 0.5 * kReach_m : kReach_m}) {
        query.disks.query(query.finder, *kernels, pose, reach_m, max_lower_m);
        ASSERT_TRUE(are_same(query.disks, plain_disks(query.finder.cloud(), pose, reach_m, max_lower_m)))
            << step << " " << kernels->isa;
        kept += query.disks.kept_points() != query.finder.within(pose, reach_m + NearDisks::kSpare_m).size();
      }
    }
    EXPECT_GT(kept, 10) << "the points were searched anew at every step";
  }
}

// --- points within a distance ---

// Positions are compared, because the finder keeps its points in an order of its own. Rounding can put a
// point on a cell's face into either neighbour: none of these points lies that close.
TEST(TouchFinder, FindsThePointsInTheVoxelsOfTheTool) {
  PointCloud cloud = scenes::random_cloud(40000, 0.1, 11);
  cloud.x[77] = std::nan(""), cloud.y[78] = 1e300;
  using Places = std::set<std::array<double, 3>>;
  std::size_t most = 0;
  for (const ToolPose& pose : {ToolPose{{0, 0, 0}, Eigen::Quaterniond::Identity()},
                               {{0.01, -0.02, 0.03}, rotation({1, 2, -0.5})},
                               {{0.09, 0.09, -0.09}, rotation({-0.2, 0.1, 3})},
                               {{0.5, 0, 0}, rotation({0, 0.3, 0})},
                               {{0.115, 0.02, 0}, rotation({0, 0, 1.5})}}) {
    Places expected;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Vec3 p_T = pose.q_WT.conjugate() * (cloud.point(i) - pose.p_W);
      if (p_T.allFinite() && (p_T.cwiseAbs() - kHalf_m).maxCoeff() <= 0)
        expected.insert({cloud.x[i], cloud.y[i], cloud.z[i]});
    }
    most = std::max(most, expected.size());
    for (const Kernels* kernels : supported_kernels()) {
      TouchFinder finder(kTool, *kernels);
      finder.on_frame(in_form<TiledCloud>(cloud));
      Places found;
      for (const std::uint32_t i : finder.in_tool(pose)) {
        const Vec3 p = finder.cloud().point(i);
        found.insert({p.x(), p.y(), p.z()});
      }
      EXPECT_EQ(found, expected) << kernels->isa;
    }
  }
  EXPECT_GT(most, 50u);
}

// Compared with the eight nodes of every voxel that is not free. The tool's field has no symmetry.
TEST(TouchFinder, KnowsTheLargestFieldInAVoxel) {
  auto tool = std::make_shared<VoxelTool>(*kTool);
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

TEST(TouchFinder, FindsNothingInAnEmptyCloudOrFarAway) {
  TouchFinder finder(kTool, scenes::kernels());
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
}  // namespace remote_touch::near_disks_test
