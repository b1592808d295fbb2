#include "core/dissertation/tool_motion/contact_thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/points/vector.h"
#include "tests/support/scenes.h"

namespace remote_touch::contact_thinning_test {
namespace {

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
  int disks = 0;
  for (const PointOrDisk& disk : merged) {
    if (disk.extent_m == 0 || disk.p_W.norm() > 0.006) continue;
    ++disks;
    const Vec3 u = disk.n_W.unitOrthogonal(), v = disk.n_W.cross(u);
    for (int k = 0; k < 24; ++k) {
      const double turn = k * std::numbers::pi / 12;
      for (const double part : {0.3, 0.65, 1.0}) {
        const Vec3 place = disk.p_W + part * disk.extent_m * (std::cos(turn) * u + std::sin(turn) * v);
        ASSERT_LE(distance_to_nearest_m(points, place), 2.2 * kSpacing_m) << disk.p_W.transpose();
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

TEST(MergedPoints, AFullPlaneKeepsATwentiethOfItsPoints) {
  const std::vector<CloudPoint> points = surface([](double, double) { return 0; });
  std::size_t inside = 0, merged_inside = 0;  // away from the rim
  const auto is_inside = [](const Vec3& p_W) { return p_W.cwiseAbs().maxCoeff() < 0.024; };
  for (const CloudPoint& point : points) inside += is_inside(point.p_W) ? 1 : 0;
  for (const PointOrDisk& disk : merged_points(points, kCube_m)) merged_inside += is_inside(disk.p_W) ? 1 : 0;
  EXPECT_LT(20 * merged_inside, inside);
}

TEST(MergedPoints, DisksEndWhereTheSurfaceEnds) {
  for (const double angle_rad : {0.0, 0.3, 0.7})
    for (const double edge_m : {0.0, 3e-4, 8e-4, 1.4e-3})
      expect_no_more_than_the_cloud(
          turned(surface([&](double x, double) { return x > edge_m ? std::nan("") : 0; }), angle_rad));
}

TEST(MergedPoints, DisksDoNotCloseHoles) {
  for (const double angle_rad : {0.0, 0.3, 0.7})
    for (const double radius_m : {8e-4, 1.5e-3})
      expect_no_more_than_the_cloud(
          turned(surface([&](double x, double z) { return std::hypot(x, z) < radius_m ? std::nan("") : 0; }),
                 angle_rad));
}

TEST(MergedPoints, PointsStandForThemselvesWhereTheyAreRoughOrFarApart) {
  const auto level = [](double, double) { return 5e-4; };  // the middle of a layer of cubes
  EXPECT_FALSE(merged_points(surface(level), kCube_m).empty());
  EXPECT_TRUE(merged_points(surface(level, 2 * kFlat_m), kCube_m).empty());
  std::vector<CloudPoint> coarse = surface([](double, double) { return 0; });
  for (CloudPoint& point : coarse) point.p_W *= 4, point.spacing_m *= 4;
  EXPECT_TRUE(merged_points(coarse, kCube_m).empty());
  EXPECT_TRUE(merged_points({}, kCube_m).empty());
}

TEST(MergedPoints, PointsWithoutASpacingOrNormalsStandForThemselves) {
  std::vector<CloudPoint> unspaced = surface([](double, double) { return 5e-4; }), bare = unspaced;
  for (CloudPoint& point : unspaced) point.spacing_m = 0;
  for (CloudPoint& point : bare) point.n_W = Vec3::Constant(std::nan(""));
  EXPECT_TRUE(merged_points(unspaced, kCube_m).empty());
  EXPECT_TRUE(merged_points(bare, kCube_m).empty());
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
// The last square ends there.
TEST(MergedPoints, ThePointsOnTheRimOfADiskBelongToNoSquare) {
  constexpr int kHalf = 24;  // 32 squares of 1.5 steps
  const std::vector<PointOrDisk> disks = disks_of_circle(kHalf);
  ASSERT_EQ(disks.size(), 1u);
  EXPECT_EQ(disks[0].extent_m, kHalf * (1.0 / (1 << 16)));
}

// Wider squares could hide holes.
TEST(MergedPoints, PointsThatNeedMoreSquaresStandForThemselves) {
  for (const int half : {25, 40, 64}) EXPECT_TRUE(disks_of_circle(half).empty()) << half;
}

}  // namespace
}  // namespace remote_touch::contact_thinning_test
