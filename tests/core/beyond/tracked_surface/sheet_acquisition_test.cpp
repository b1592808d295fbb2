// Finding a sheet in one frame, before there is a track.
#include "core/beyond/tracked_surface/sheet_acquisition.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/scenes.h"

namespace remote_touch::sheet_acquisition_test {
namespace {

constexpr double kUnit = 0.005;

// Planes y = -depth + 0.3 x, with points 1.5 mm apart and noise of standard deviation sigma in contact radii.
PointCloud planes(const std::vector<double>& depths_m, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  PointCloud cloud;
  for (const double depth : depths_m)
    for (int j = -40; j <= 40; ++j)
      for (int i = -40; i <= 40; ++i) {
        const Vec3 off(normal(random), normal(random), normal(random));
        cloud.append(Vec3(0.0015 * i, -depth + 0.3 * 0.0015 * i, 0.0015 * j) + sigma * kUnit * off);
      }
  return cloud;
}

std::optional<FoundSheet> found(const PointCloud& cloud, const Vec3& proxy_W) {
  const BruteForceSearch frame(cloud);
  GatheredPoints gathered;
  gathered.reserve(cloud.size(), false, false);
  PatchPoints points(scenes::kernels());
  points.reserve(cloud.size());
  HeightFit fit;
  return find_sheet(frame, proxy_W, kUnit, scenes::kernels(), {gathered, points, fit});
}

const Vec3 kNormal = Vec3(-0.3, 1, 0).normalized();

double height_above(const FoundSheet& sheet, double depth_m) {
  const Vec3 origin = sheet.frame.origin_W();
  return (origin - Vec3(0, -depth_m, 0)).dot(kNormal) / kUnit;
}

TEST(SheetAcquisition, FindsPlaceNormalAndNoise) {
  for (const double sigma : {0.0, 0.2, 0.6, 1.0}) {
    const auto sheet = found(planes({0}, sigma, 3), Vec3(0, 0.01, 0));
    ASSERT_TRUE(sheet) << sigma;
    EXPECT_GT(sheet->frame.normal_W().dot(kNormal), std::cos(0.1)) << sigma;
    EXPECT_NEAR(height_above(*sheet, 0), 0, 0.02 + 0.2 * sigma) << sigma;
    EXPECT_NEAR(sheet->sigma.value_or(-1), sigma, 0.01 + 0.2 * sigma) << sigma;
  }
}

TEST(SheetAcquisition, FacesDownIfItIsFoundFromBelow) {
  const auto sheet = found(planes({0}, 0.2, 3), Vec3(0, -0.01, 0));
  ASSERT_TRUE(sheet);
  EXPECT_LT(sheet->frame.normal_W().dot(kNormal), -std::cos(0.1));
}

// Two planes, 4 contact radii apart: the sheet is the one that is nearer to the proxy.
TEST(SheetAcquisition, TheNearerOfTwoIsTheSheet) {
  const PointCloud cloud = planes({0, 0.02}, 0.2, 5);
  const auto upper = found(cloud, Vec3(0, 0.006, 0)), lower = found(cloud, Vec3(0, -0.028, 0));
  ASSERT_TRUE(upper && lower);
  EXPECT_NEAR(height_above(*upper, 0), 0, 0.1);
  EXPECT_NEAR(height_above(*lower, 0.02), 0, 0.1);
}

TEST(SheetAcquisition, FindsNoSheetIfThereIsNoSurface) {
  EXPECT_FALSE(found(PointCloud(), Vec3::Zero()));
  EXPECT_FALSE(found(planes({0}, 0, 1), Vec3(0, 0.5, 0))) << "too far away";
  PointCloud few;
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0.001, 0, 0), Vec3(0, 0, 0.001)}) few.append(p);
  EXPECT_FALSE(found(few, Vec3(0, 0.005, 0)));
  PointCloud lost;
  for (int i = 0; i < 100; ++i) lost.append(Vec3::Constant(std::nan("")));
  EXPECT_FALSE(found(lost, Vec3::Zero()));
}

}  // namespace
}  // namespace remote_touch::sheet_acquisition_test
