// Contacts near a tool compared with a loop over all disks, and the merging of points of dense surfaces.
#include "core/dissertation/tool_motion/contact_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <vector>

#include "core/dissertation/tool_motion/contact_thinning.h"
#include "core/kernels/kernels.h"
#include "core/points/vector.h"
#include "tests/support/box_tool.h"
#include "tests/support/cloud_form.h"
#include "tests/support/scenes.h"

namespace remote_touch::contact_list_test {
namespace {

const auto kTool = scenes::box_tool({0.005, 0.003, 0.004});
const ToolPose kPose{{0.001, -0.002, 0.003}, rotation({1, 2, -0.5})};
constexpr double kCellsPer_m = 250;
// Interpolation error: a convex tool's field is convex between its nodes, except for a fraction of a voxel.
constexpr double kInterpolated_m = 5e-5;
constexpr double kTouched_m = 3e-4;  // distance below which points are searched

PointCloud cloud_of(std::size_t count) {
  return scenes::cloud_with_normals(static_cast<int>(count), 0.012, 21);
}

struct Found {
  std::uint64_t cell;
  ToolContact contact;
};

// Computes the contact of every disk within the look-ahead, one after the other.
std::vector<Found> all_contacts(const PointCloud& cloud, const ToolParameters& p, double side = 0) {
  TouchFinder finder(kTool, scenes::kernels());
  finder.on_frame(in_form<TiledCloud>(cloud));
  std::vector<Found> all;
  const Eigen::Matrix3d R_TW = kPose.q_WT.conjugate().toRotationMatrix();
  for (std::uint32_t i = 0; i < finder.cloud().padded_size(); ++i) {
    const Vec3 p_T = R_TW * (finder.cloud().point(i) - kPose.p_W);
    if (!(p_T.norm() < 0.1)) continue;  // padding
    const SurfaceDisk disk{p_T, R_TW * finder.cloud().normal(i),
                           p.disk_radius_ratio * finder.cloud().spacing_m(i), sample_field(*kTool, p_T)};
    const double lower_m = lower_bound_m(disk);
    if (lower_m > p.look_ahead_m || disk.at.distance_m > kFieldMargin_m - 2e-4) continue;
    all.push_back({cell_and_octant(p_T, -disk.at.gradient_T, kCellsPer_m),
                   lower_m <= kTouched_m ? near_contact(*kTool, disk, nearest_position(*kTool, disk), side)
                                         : far_contact(disk, lower_m)});
  }
  return all;
}

bool same(const ToolContact& a, const ToolContact& b) {
  return a.r_T == b.r_T && a.n_T == b.n_T && a.depth_m == b.depth_m && a.side == b.side;
}

// The vectorised search returns the same contacts, bit for bit, as a loop over the disks. This holds on every
// instruction set, on both sides and for disks that reach out of the grid.
TEST(ContactList, HasTheSameBitsOnEveryInstructionSet) {
  for (const double ratio : {0.75, 2.0})
    for (const double side : {0.0, 1.0, -1.0}) {
      ToolParameters p;
      p.disk_radius_ratio = ratio;
      const PointCloud cloud = cloud_of(300);
      const std::vector<Found> all = all_contacts(cloud, p, side);
      ASSERT_GT(all.size(), 5u);
      for (const Kernels* kernels : supported_kernels()) {
        ContactList list(kTool, p, *kernels);
        list.on_frame(in_form<TiledCloud>(cloud));
        const NearContacts near = list.near(kPose, side);
        ASSERT_EQ(near.contacts.size(), all.size());
        for (std::size_t i = 0; i < all.size(); ++i)
          EXPECT_TRUE(same(near.contacts[i], all[i].contact)) << i << " " << kernels->isa;
      }
    }
}

// The result does not depend on earlier queries. Contacts within kTouched_m are always included.
TEST(ContactList, HasAllWithinTheGivenDistanceAndNoneFartherAway) {
  const PointCloud cloud = cloud_of(800);
  ContactList list(kTool, {}, scenes::kernels());
  list.on_frame(in_form<TiledCloud>(cloud));
  std::size_t last = 0;
  for (const double asked_m : {1e-4, 2e-3, 5e-4, 1e-3, 3e-4, 1.0}) {
    ToolParameters p;
    const double within_m = std::max(asked_m, kTouched_m);
    const bool is_all = within_m >= p.look_ahead_m;
    if (!is_all) p.look_ahead_m = within_m;
    const std::vector<Found> expected = all_contacts(cloud, p);
    const NearContacts near = list.near(kPose, 0, asked_m);
    EXPECT_EQ(near.within_m, is_all ? std::numeric_limits<double>::infinity() : within_m);
    ASSERT_EQ(near.contacts.size(), expected.size()) << within_m;
    double deepest_m = -1;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_TRUE(same(near.contacts[i], expected[i].contact)) << i << " " << within_m;
      deepest_m = std::max(deepest_m, expected[i].contact.depth_m);
    }
    EXPECT_EQ(near.deepest_m, deepest_m);
    EXPECT_NE(near.contacts.size(), last);
    last = near.contacts.size();
  }
}

// Most disks are never searched. The deepest contact of each cell is kept all the same, because the lower
// bound of a disk holds for a convex tool.
TEST(ContactList, HasTheDeepestOfEveryCellOfMany) {
  for (const std::size_t count : {20000u, 100000u}) {
    const PointCloud cloud = cloud_of(count);
    std::map<std::uint64_t, double> deepest;
    const std::vector<Found> all = all_contacts(cloud, {});
    for (const Found& found : all) {
      const auto at = deepest.emplace(found.cell, found.contact.depth_m).first;
      at->second = std::max(at->second, found.contact.depth_m);
    }
    std::vector<double> expected_m, kept_distance_m;
    for (const auto& cell : deepest) expected_m.push_back(cell.second);
    ContactList list(kTool, {}, scenes::kernels());
    list.on_frame(in_form<TiledCloud>(cloud));
    const NearContacts near = list.near(kPose, 0);
    for (const ToolContact& contact : near.contacts) kept_distance_m.push_back(contact.depth_m);
    std::sort(kept_distance_m.begin(), kept_distance_m.end()),
        std::sort(expected_m.begin(), expected_m.end());
    EXPECT_GT(all.size(), 10 * kept_distance_m.size());
    ASSERT_EQ(kept_distance_m.size(), expected_m.size());
    for (std::size_t i = 0; i < kept_distance_m.size(); ++i)
      EXPECT_NEAR(kept_distance_m[i], expected_m[i], kInterpolated_m);
    EXPECT_EQ(near.deepest_m, expected_m.back());
  }
}

// A large plate over a plane touches more cells than the table has room for. Its deepest contact is in the
// list all the same, wherever it is in the order of the points.
TEST(ContactList, ALargeToolKeepsItsDeepestContact) {
  const Vec3 half_m(0.2, 0.004, 0.2);
  const auto plate = scenes::box_tool(half_m, 2e-3);
  PointCloud cloud;
  for (int j = -70; j <= 70; ++j)
    for (int i = -70; i <= 70; ++i) cloud.append({0.003 * i, 0, 0.003 * j}, Vec3::UnitY());
  ContactList list(plate, {}, scenes::kernels());
  list.on_frame(in_form<TiledCloud>(cloud));
  for (const double about_x : {-0.005, 0.005})
    for (const double about_z : {-0.005, 0.0, 0.005}) {
      const ToolPose pose{{0, 0.0049, 0}, rotation({about_x, 0, about_z})};
      double deepest_m = -1;
      for (std::size_t i = 0; i < cloud.size(); ++i)
        deepest_m = std::max(
            deepest_m, -scenes::box_distance(half_m, pose.q_WT.conjugate() * (cloud.point(i) - pose.p_W)));
      const NearContacts near = list.near(pose, 0);
      EXPECT_NEAR(near.deepest_m, deepest_m, 3e-5) << about_x << " " << about_z;
      EXPECT_LE(near.contacts.size(), ContactThinning::kMaxCount);
      EXPECT_TRUE(std::any_of(near.contacts.begin(), near.contacts.end(),
                              [&](const ToolContact& contact) { return contact.depth_m == near.deepest_m; }));
    }
}

// Contacts that find no room in the table are not lost: the deepest one is kept in every order.
TEST(ContactThinning, KeepsTheDeepestOfManyInEveryOrder) {
  std::vector<ToolContact> all;
  for (int i = 0; i < 40000; ++i)
    all.push_back(
        {Vec3(0.004 * (i % 200), 0, 0.004 * (i / 200)), Vec3::UnitY(), -1e-7 * (i * 7919 % 40000), 1});
  ContactThinning thinning;
  for (const int first : {0, 13000, 39000}) {
    std::vector<ToolContact> contacts = all;
    std::rotate(contacts.begin(), contacts.begin() + first, contacts.end());
    thinning.thin(contacts);
    EXPECT_LE(contacts.size(), ContactThinning::kMaxCount);
    EXPECT_GT(contacts.size(), ContactThinning::kMaxCount / 4);
    EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), [](const ToolContact& contact) {
      return contact.depth_m == 0;
    })) << first;
  }
}

// A tilted box over a dense flat surface. The deepest contact has the distance of the lower edge, with or
// without merged points, wherever the edge is.
TEST(ContactList, MergedPointsAreAsFarAsTheyAre) {
  constexpr double kGap_m = 1e-4;
  const PointCloud cloud = scenes::dense_plane();
  const auto points = in_form<TiledCloud>(cloud, ToolParameters{}.merged_disk_m);
  for (const double merged_disk_m : {0.0, ToolParameters{}.merged_disk_m}) {
    ToolParameters p;
    p.merged_disk_m = merged_disk_m;
    ContactList list(kTool, p, scenes::kernels());
    list.on_frame(points);
    for (const double tilt_rad : {0.004, 0.01, 0.02, 0.04, 0.06})
      for (const double x_m : {0.0, 6e-4, 1.3e-3}) {
        ToolPose pose{{x_m, 0, 0}, rotation({0, 0, tilt_rad})};
        pose.p_W.y() = kGap_m + 0.005 * std::sin(tilt_rad) + 0.003 * std::cos(tilt_rad);
        const NearContacts near = list.near(pose, 0);
        EXPECT_NEAR(near.deepest_m, -kGap_m, 2e-5) << tilt_rad << " " << x_m;
        for (const ToolContact& contact : near.contacts) EXPECT_GT((pose.q_WT * contact.n_T).y(), -0.1);
      }
    EXPECT_EQ(list.near_disks().size() > 500, merged_disk_m == 0);
  }
}

// Every point that may stop a motion of the continuous rule is tested, even where points are merged.
TEST(ContactList, PointsWithinReachAreNeverMerged) {
  const PointCloud cloud = scenes::dense_plane();
  ToolParameters p;
  p.contact_rule = ContactRule::continuous;
  ContactList list(kTool, p, scenes::kernels());
  list.on_frame(in_form<TiledCloud>(cloud, used_merged_disk_m(p)));
  const ToolPose pose{{0, 0.0031, 0}, Eigen::Quaterniond::Identity()};
  list.near(pose, 0);
  EXPECT_LT(list.near_disks().size(), 500u);
  constexpr double kReach_m = 2e-4;
  std::size_t expected = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i)
    expected += sample_field(*kTool, cloud.point(i) - pose.p_W).distance_m <= kReach_m ? 1 : 0;
  EXPECT_GT(expected, 600u);
  SlabWay way{};
  way.far = kReach_m, way.touch = std::numeric_limits<double>::infinity();
  EXPECT_EQ(list.points_on_way(pose, way).size(), expected);
}

TEST(ContactList, HasNoContactBeforeAFrame) {
  ContactList list(kTool, {}, scenes::kernels());
  EXPECT_TRUE(list.near(kPose, 0).contacts.empty());
  EXPECT_EQ(list.touched(kPose).points, 0);
  EXPECT_TRUE(list.in_voxels(kPose).contacts.empty());
}

// --- merged points ---

constexpr double kCube_m = 2e-3, kSpacing_m = 3e-4;

// A 60 mm square of points at (x, height(x, z), z). There is no point where the height is NaN. noise_m is
// added and subtracted in turn.
std::vector<CloudPoint> surface(const std::function<double(double, double)>& height_m, double noise_m = 0) {
  std::vector<CloudPoint> points;
  for (int j = 0; j < 200; ++j)
    for (int i = 0; i < 200; ++i) {
      const double x = (i - 100) * kSpacing_m, z = (j - 100) * kSpacing_m, y = height_m(x, z);
      const double slope = (height_m(x + 1e-6, z) - height_m(x - 1e-6, z)) / 2e-6;
      const double sign = (i * 7 + j * 3) % 2 == 0 ? 1 : -1;
      const Vec3 n_W = std::isnan(slope) ? Vec3::UnitY() : Vec3(-slope, 1, 0).normalized();
      if (!std::isnan(y)) points.push_back({{x, y + sign * noise_m, z}, n_W, kSpacing_m});
    }
  return points;
}

// Turns the surface in its plane and moves it, so that it is not aligned with the cubes.
std::vector<CloudPoint> turned(std::vector<CloudPoint> points, double angle_rad) {
  const Eigen::Quaterniond q = rotation({0, angle_rad, 0});
  for (CloudPoint& point : points) point.p_W = q * point.p_W + Vec3(3e-4, 1e-4, 7e-4);
  return points;
}

double distance_to_nearest_m(const std::vector<CloudPoint>& points, const Vec3& p_W) {
  double squared = 1;
  for (const CloudPoint& point : points) squared = std::min(squared, (point.p_W - p_W).squaredNorm());
  return std::sqrt(squared);
}

// No position on a disk is far from the cloud: a square of 1.5 spacings has a diagonal of 2.1 spacings.
void expect_no_more_than_the_cloud(const std::vector<CloudPoint>& points) {
  const std::vector<PointOrDisk> merged = merged_points(points, kCube_m);
  std::vector<CloudPoint> near_middle;  // one of them is the nearest to every position on these disks
  for (const CloudPoint& point : points)
    if (point.p_W.norm() < 0.01) near_middle.push_back(point);
  int disks = 0;
  for (const PointOrDisk& disk : merged) {
    if (disk.extent_m == 0 || disk.p_W.norm() > 0.006) continue;
    ++disks;
    const Vec3 u = disk.n_W.unitOrthogonal(), v = disk.n_W.cross(u);
    for (int k = 0; k < 24; ++k) {
      const double turn = k * std::numbers::pi / 12;
      for (const double part : {0.3, 0.65, 1.0}) {
        const Vec3 place = disk.p_W + part * disk.extent_m * (std::cos(turn) * u + std::sin(turn) * v);
        ASSERT_LE(distance_to_nearest_m(near_middle, place), 2.2 * kSpacing_m) << disk.p_W.transpose();
      }
    }
  }
  EXPECT_GT(disks, 5);
}

TEST(MergedPoints, EveryPointIsInADiskOrIsKept) {
  // A gently curved surface with a step. No disk may reach across the step.
  const std::vector<CloudPoint> points =
      surface([](double x, double z) { return 0.5 * x * x + (z > 0.01 ? 2e-4 : 0); });
  const std::vector<PointOrDisk> merged = merged_points(points, kCube_m);
  ASSERT_FALSE(merged.empty());
  EXPECT_LT(2 * merged.size(), points.size());
  double step_m = 0;
  for (const PointOrDisk& disk : merged)
    if (disk.extent_m > 0)
      step_m = std::max(step_m, std::abs(disk.p_W.z() - 0.01) < 2e-4 ? disk.extent_m : 0);
  EXPECT_EQ(step_m, 0);
  for (const CloudPoint& point : points) {
    const bool is_there = std::any_of(merged.begin(), merged.end(), [&](const PointOrDisk& disk) {
      const Vec3 offset = point.p_W - disk.p_W;
      return offset.norm() <= disk.extent_m + 1e-12 && std::abs(offset.dot(disk.n_W)) <= kFlat_m;
    });
    ASSERT_TRUE(is_there) << point.p_W.transpose();
  }
}

// Sheets with an edge, and with a hole, in several directions.
TEST(MergedPoints, DisksEndWhereTheSurfaceEnds) {
  for (const double angle_rad : {0.0, 0.3, 0.7}) {
    for (const double edge_m : {0.0, 3e-4, 8e-4, 1.4e-3})
      expect_no_more_than_the_cloud(
          turned(surface([&](double x, double) { return x > edge_m ? std::nan("") : 0; }), angle_rad));
    for (const double radius_m : {8e-4, 1.5e-3})
      expect_no_more_than_the_cloud(
          turned(surface([&](double x, double z) { return std::hypot(x, z) < radius_m ? std::nan("") : 0; }),
                 angle_rad));
  }
}

TEST(MergedPoints, PointsThatAreRoughFarApartOrWithoutSpacingOrNormalsStandForThemselves) {
  const auto level = [](double, double) { return 5e-4; };  // the middle of a layer of cubes
  const std::vector<CloudPoint> dense = surface(level);
  EXPECT_FALSE(merged_points(dense, kCube_m).empty());
  EXPECT_TRUE(merged_points({}, kCube_m).empty());
  EXPECT_TRUE(merged_points(surface(level, 2 * kFlat_m), kCube_m).empty());
  std::vector<CloudPoint> coarse = surface([](double, double) { return 0; }), unspaced = dense, bare = dense;
  for (CloudPoint& point : coarse) point.p_W *= 4, point.spacing_m *= 4;
  for (CloudPoint& point : unspaced) point.spacing_m = 0;
  for (CloudPoint& point : bare) point.n_W = Vec3::Constant(std::nan(""));
  for (const auto& points : {coarse, unspaced, bare}) EXPECT_TRUE(merged_points(points, kCube_m).empty());
}

// The disks of a cloud of points one step apart: a circle of `half` steps in one cube. Points around it,
// which have no normals and lie in another cube, cover the squares at its rim.
std::vector<PointOrDisk> disks_of_circle(int half) {
  constexpr double kStep_m = 1.0 / (1 << 16), kCircleCube_m = 1.0 / 128;
  const Vec3 no_normal = Vec3::Constant(std::nan(""));
  std::vector<CloudPoint> points;
  const int all = half + 3;
  for (int j = -all; j <= all; ++j)
    for (int i = -all; i <= all; ++i) {
      const int squared = i * i + j * j;
      if (squared > all * all) continue;
      const bool is_in_circle = squared <= half * half;
      const double height_m = is_in_circle ? 0.25 * kStep_m : -0.25 * kStep_m;  // above a side of the cubes
      points.push_back({{0.5 * kCircleCube_m + i * kStep_m, height_m, 0.5 * kCircleCube_m + j * kStep_m},
                        is_in_circle ? Vec3::UnitY() : no_normal,
                        kStep_m});
      points.back().p_W.y() += kCircleCube_m;
    }
  std::vector<PointOrDisk> merged = merged_points(points, kCircleCube_m);
  std::erase_if(merged, [](const PointOrDisk& point) { return point.extent_m == 0; });
  return merged;
}

// A disk with the largest possible number of squares along a side, and with a point at each end of its axes.
// The last square ends there: points on the rim belong to no square. Wider squares could hide holes.
TEST(MergedPoints, OfACircleAreADiskUpToTheLargestNumberOfSquares) {
  constexpr int kHalf = 24;  // 32 squares of 1.5 steps
  const std::vector<PointOrDisk> disks = disks_of_circle(kHalf);
  ASSERT_EQ(disks.size(), 1u);
  EXPECT_EQ(disks[0].extent_m, kHalf * (1.0 / (1 << 16)));
  for (const int half : {25, 40, 64}) EXPECT_TRUE(disks_of_circle(half).empty()) << half;
}

}  // namespace
}  // namespace remote_touch::contact_list_test
