// Points that a SheetTracker shows for a sheet which it tracks from frame to frame.
#include "core/beyond/tracked_surface/sheet_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/scenes.h"

namespace remote_touch::sheet_tracker_test {
namespace {

constexpr double kUnit = 0.005;

// A plane y = height_m, with points 1.5 mm apart and noise of standard deviation sigma in contact radii.
std::shared_ptr<const NeighbourSearch> plane(double height_m, double sigma, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  PointCloud cloud;
  for (int j = -60; j <= 60; ++j)
    for (int i = -60; i <= 60; ++i) {
      const Vec3 off(normal(random), normal(random), normal(random));
      cloud.append(Vec3(0.0015 * i, height_m, 0.0015 * j) + sigma * kUnit * off);
    }
  return std::make_shared<BruteForceSearch>(cloud);
}

struct Shown {
  double count = 0, rms_m = 0;  // number of points within 3 r_c of the y axis; rms height about the plane
};

Shown shown_of(const NeighbourSearch& points, double height_m, double max_height_m) {
  const GatheredPoints gathered = scenes::gathered(points, {Vec3(0, height_m, 0), 0.1});
  const PointsView all = gathered.view();
  Shown shown;
  for (std::size_t i = 0; i < gathered.size(); ++i) {
    const double height = all.y[i] - height_m;
    if (std::hypot(all.x[i], all.z[i]) > 3 * kUnit || std::abs(height) > max_height_m) continue;
    ++shown.count, shown.rms_m += height * height;
  }
  shown.rms_m = std::sqrt(shown.rms_m / shown.count);
  return shown;
}

// The points of a sheet are moved onto it. However noisy they are, chance does not make a second sheet of
// some of them.
TEST(SheetTracker, ShowsAllPointsOfASheetWithoutTheirNoise) {
  for (const double sigma : {0.2, 0.6, 1.0, 1.5, 2.0})
    for (unsigned seed = 1; seed <= 5; ++seed) {
      SheetTracker tracker({}, kUnit, scenes::kernels());
      tracker.reserve(20000, false, false);
      double height_m = 0;
      std::shared_ptr<const NeighbourSearch> frame = plane(height_m, sigma, seed);
      tracker.keep(frame);
      SheetUpdate update = tracker.requery({Vec3(0, kUnit, 0), false});
      for (unsigned k = 1; k <= 6; ++k) {
        height_m = 0.001 * k;
        frame = plane(height_m, sigma, 100 * k + seed);
        update = tracker.on_frame(frame, {Vec3(0, height_m + kUnit, 0), true}, 1.0 / 30);
      }
      ASSERT_TRUE(update.points) << sigma;
      const Shown raw = shown_of(*frame, height_m, 3 * sigma * kUnit),
                  clean = shown_of(*update.points, height_m, 3 * sigma * kUnit);
      EXPECT_GE(clean.count, 0.97 * raw.count) << sigma << ", seed " << seed;
      EXPECT_LE(clean.rms_m, 0.35 * raw.rms_m) << sigma << ", seed " << seed;
    }
}

// Few points whose noise is distributed evenly: by chance, their profile has valleys at many heights.
TEST(SheetTracker, ChanceMakesNoSecondSheetOfFewPointsSpreadEvenly) {
  constexpr double kSpacing_m = 0.004, kReach_m = 0.09, kSigma = 1.5;
  for (unsigned seed = 1; seed <= 50; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> even(-std::sqrt(3.0), std::sqrt(3.0));  // standard deviation 1
    const auto noisy = [&](double height_m) {
      PointCloud cloud;
      for (double z = -kReach_m; z <= kReach_m; z += kSpacing_m)
        for (double x = -kReach_m; x <= kReach_m; x += kSpacing_m) {
          const double x_off = even(random), y_off = even(random), z_off = even(random);
          cloud.append(Vec3(x, height_m, z) + kSigma * kUnit * Vec3(x_off, y_off, z_off));
        }
      return cloud;
    };
    SheetTracker tracker({}, kUnit, scenes::kernels(), SheetTracker::Shows::points);
    tracker.keep(std::make_shared<BruteForceSearch>(noisy(0)));
    tracker.requery({Vec3(0, kUnit, 0), false});
    for (int k = 1; k <= 4; ++k) {
      const double height_m = 0.001 * k;
      const PointCloud cloud = noisy(height_m);
      tracker.on_frame(std::make_shared<BruteForceSearch>(cloud), {Vec3(0, height_m + kUnit, 0), true},
                       1.0 / 30);
      ASSERT_TRUE(tracker.changes_points()) << "seed " << seed;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (std::hypot(cloud.x[i], cloud.z[i]) > 3 * kUnit) continue;
        EXPECT_EQ(tracker.shown(cloud.point(i)).kind, ShownPoint::Kind::sheet) << "seed " << seed;
      }
    }
  }
}

TEST(SheetTracker, LeavesASheetWithoutNoiseAsItIs) {
  SheetTracker tracker({}, kUnit, scenes::kernels());
  tracker.reserve(20000, false, false);
  tracker.keep(plane(0, 0, 1));
  tracker.requery({Vec3(0, kUnit, 0), false});
  const auto frame = plane(0.001, 0, 2);
  EXPECT_EQ(tracker.on_frame(frame, {Vec3(0, kUnit, 0), true}, 1.0 / 30).points, frame);
  EXPECT_FALSE(tracker.changes_points());
}

// --- for tools: the points one by one ---

TEST(SheetTracker, ReportsHowFarTheNewestFrameMovedTheSheet) {
  SheetTracker tracker({}, kUnit, scenes::kernels(), SheetTracker::Shows::points);
  tracker.keep(plane(0, 0, 1));
  tracker.requery({Vec3(0, kUnit, 0), false});
  EXPECT_TRUE(std::isnan(tracker.moved(Vec3::Zero()))) << "seen once";
  tracker.on_frame(plane(0.004, 0, 2), {Vec3(0, kUnit, 0), true}, 1.0 / 30);
  for (const Vec3& p_W : {Vec3(0, 0, 0), Vec3(0.02, 0.01, 0), Vec3(-0.01, -0.002, 0.02)}) {
    EXPECT_NEAR(tracker.moved(p_W), 0.004 / kUnit, 1e-3);
    EXPECT_NEAR(tracker.clearance(p_W), (p_W.y() - 0.004) / kUnit, 1e-3);
  }
  tracker.on_frame(plane(0.004, 0, 2), {Vec3(0, 0.004 + kUnit, 0), true}, 1.0 / 30);
  EXPECT_EQ(tracker.moved(Vec3::Zero()), 0) << "at rest";
}

TEST(SheetTracker, ShowsAPointOnTheSheetOrNotAtAll) {
  const double sigma = 0.4;
  SheetTracker tracker({}, kUnit, scenes::kernels(), SheetTracker::Shows::points);
  tracker.keep(plane(0, sigma, 1));
  tracker.requery({Vec3(0, kUnit, 0), false});
  for (unsigned k = 1; k <= 4; ++k) tracker.on_frame(plane(0, sigma, k), {Vec3(0, kUnit, 0), true}, 1.0 / 30);
  ASSERT_TRUE(tracker.changes_points());
  const Vec3 noisy_W(0.01, sigma * kUnit, -0.01);
  const ShownPoint shown = tracker.shown(noisy_W);
  ASSERT_EQ(shown.kind, ShownPoint::Kind::sheet);
  EXPECT_NEAR(shown.p_W.y(), 0, 0.1 * sigma * kUnit);
  EXPECT_NEAR((shown.p_W - noisy_W).cwiseProduct(Vec3(1, 0, 1)).norm(), 0, 0.05 * sigma * kUnit) << "along y";
  EXPECT_GT(shown.normal_W.y(), 0.999);
  EXPECT_NEAR(shown.residual, sigma, 0.1 * sigma);
  EXPECT_EQ(tracker.shown(Vec3(0.01, 3.5 * kUnit, 0)).kind, ShownPoint::Kind::stray);
  EXPECT_EQ(tracker.shown(Vec3(0.05, 0, 0)).kind, ShownPoint::Kind::outside);
}

}  // namespace
}  // namespace remote_touch::sheet_tracker_test
