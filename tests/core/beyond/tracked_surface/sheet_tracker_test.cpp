// A tracked sheet: what is shown of it, its registration to the frame before, and how it is found in one
// frame.
#include "core/beyond/tracked_surface/sheet_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <utility>

#include "core/beyond/tracked_surface/height_fit.h"
#include "tests/support/scenes.h"

namespace remote_touch::sheet_tracker_test {
namespace {

constexpr double kUnit = 0.005;

// Planes y = -depth + slope x of (2 n + 1)^2 points, 1.5 mm apart, with noise of standard deviation sigma in
// contact radii.
PointCloud planes(const std::vector<double>& depths_m, double sigma, unsigned seed, double slope, int n) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  PointCloud cloud;
  for (const double depth : depths_m)
    for (int j = -n; j <= n; ++j)
      for (int i = -n; i <= n; ++i) {
        const Vec3 off(normal(random), normal(random), normal(random));
        cloud.append(Vec3(0.0015 * i, -depth + slope * 0.0015 * i, 0.0015 * j) + sigma * kUnit * off);
      }
  return cloud;
}

std::shared_ptr<const NeighbourSearch> plane(double height_m, double sigma, unsigned seed) {
  return std::make_shared<BruteForceSearch>(planes({-height_m}, sigma, seed, 0, 60));
}

void begin(SheetTracker& tracker, std::shared_ptr<const NeighbourSearch> frame) {
  tracker.keep(std::move(frame));
  tracker.requery({Vec3(0, kUnit, 0), false});
}

// Shows the next frame to a tracker whose proxy is held one contact radius above the plane.
SheetUpdate follow(SheetTracker& tracker, std::shared_ptr<const NeighbourSearch> frame, double height_m = 0) {
  return tracker.on_frame(std::move(frame), {Vec3(0, height_m + kUnit, 0), true}, 1.0 / 30);
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
      begin(tracker, plane(0, sigma, seed));
      std::shared_ptr<const NeighbourSearch> frame;
      SheetUpdate update;
      for (unsigned k = 1; k <= 6; ++k) {
        frame = plane(0.001 * k, sigma, 100 * k + seed);
        update = follow(tracker, frame, 0.001 * k);
      }
      ASSERT_TRUE(update.points) << sigma;
      const double most_m = 3 * sigma * kUnit;
      const Shown raw = shown_of(*frame, 0.006, most_m), clean = shown_of(*update.points, 0.006, most_m);
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
    begin(tracker, std::make_shared<BruteForceSearch>(noisy(0)));
    for (int k = 1; k <= 4; ++k) {
      const PointCloud cloud = noisy(0.001 * k);
      follow(tracker, std::make_shared<BruteForceSearch>(cloud), 0.001 * k);
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
  begin(tracker, plane(0, 0, 1));
  const auto frame = plane(0.001, 0, 2);
  EXPECT_EQ(follow(tracker, frame).points, frame);
  EXPECT_FALSE(tracker.changes_points());
}

TEST(SheetTracker, ReportsHowFarTheNewestFrameMovedTheSheet) {
  SheetTracker tracker({}, kUnit, scenes::kernels(), SheetTracker::Shows::points);
  begin(tracker, plane(0, 0, 1));
  EXPECT_TRUE(std::isnan(tracker.moved(Vec3::Zero()))) << "seen once";
  follow(tracker, plane(0.004, 0, 2));
  for (const Vec3& p_W : {Vec3(0, 0, 0), Vec3(0.02, 0.01, 0), Vec3(-0.01, -0.002, 0.02)}) {
    EXPECT_NEAR(tracker.moved(p_W), 0.004 / kUnit, 1e-3);
    EXPECT_NEAR(tracker.clearance(p_W), (p_W.y() - 0.004) / kUnit, 1e-3);
  }
  follow(tracker, plane(0.004, 0, 2), 0.004);
  EXPECT_EQ(tracker.moved(Vec3::Zero()), 0) << "at rest";
}

TEST(SheetTracker, ShowsAPointOnTheSheetOrNotAtAll) {
  const double sigma = 0.4;
  SheetTracker tracker({}, kUnit, scenes::kernels(), SheetTracker::Shows::points);
  begin(tracker, plane(0, sigma, 1));
  for (unsigned k = 1; k <= 4; ++k) follow(tracker, plane(0, sigma, k));
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

constexpr double kHalfRange = 8;
constexpr double kStandardError = 0.029;  // standard error of a mean over some 1200 points, in sigma
const PatchPlace kProxy{0, 0, 1};

// A sheet at height + slope_u u + slope_v v with noise, and a second one below it if second_below is not 0.
PatchPoints sheet(double height, double slope_u, double slope_v, double sigma, unsigned seed,
                  double second_below = 0) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  PatchPoints points(scenes::kernels());
  points.reserve(10000);
  for (double v = -7; v <= 7; v += 0.3)
    for (double u = -7; u <= 7; u += 0.3)
      for (const double below : {0.0, second_below}) {
        const double h = height + slope_u * u + slope_v * v - below + sigma * normal(random);
        points.add({PatchFrame::rounded(u), PatchFrame::rounded(v), PatchFrame::rounded(h)}, true);
        if (second_below == 0) break;
      }
  return points;
}

HeightMap flat_map() {
  HeightMap map;
  map.set_plane(0, 0, 0, 12);
  return map;
}

// Shift of `now` against the frame before, in which the same sheets lie at height 0.
SheetShift shift_of(PatchPoints now, double gate, double sigma, double second_below = 0) {
  PatchPoints before = sheet(0, 0, 0, sigma, 99, second_below);
  before.set_residuals(flat_map());
  const HeightProfile profile = before.profile_near(kProxy, kRegistrationReach, kHalfRange).smoothed(0.1);
  now.set_residuals(flat_map());
  return register_sheet(now, profile, kProxy, gate, kHalfRange, sigma);
}

TEST(SheetRegistration, FindsHowFarASheetMovedAndTurned) {
  for (const double height : {-2.5, -0.4, 0.0, 1.7, 2.8}) {
    const SheetShift shift = shift_of(sheet(height, 0.05, -0.1, 0, 1), 3, 0);
    EXPECT_NEAR(shift.height, height, 2e-3);
    EXPECT_NEAR(shift.slope_u, 0.05, 1e-3);
    EXPECT_NEAR(shift.slope_v, -0.1, 1e-3);
  }
}

// The height is a mean over n points, with the standard error sigma / sqrt(n). One of ten draws is off by
// four standard errors in 1 of 1500 cases.
TEST(SheetRegistration, NoiseMovesItByItsStandardErrorAlone) {
  for (unsigned seed = 1; seed <= 10; ++seed)
    EXPECT_NEAR(shift_of(sheet(1.3, 0, 0, 1, seed), 3, 1).height, 1.3, 4 * kStandardError) << seed;
}

// The sheets rise by 2.5 contact radii, so the lower one, which is 3 below, comes close to where the upper
// one was.
TEST(SheetRegistration, ASecondSheetAtThePositionOfTheFirstIsRejected) {
  EXPECT_NEAR(shift_of(sheet(2.5, 0, 0, 0.1, 1, 3), 3, 0.1, 3).height, 2.5, 4 * 0.1 * kStandardError);
}

// Points on a line do not determine the slope across it. A few points determine no slope at all.
TEST(SheetRegistration, PointsThatDetermineNoPlaneGiveNoSlope) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  PatchPoints line(scenes::kernels()), few(scenes::kernels());
  line.reserve(100), few.reserve(100);
  for (double u = -4; u <= 4; u += 0.1)
    line.add(
        {PatchFrame::rounded(u), PatchFrame::rounded(0.5 * u), PatchFrame::rounded(1 + 0.3 * normal(random))},
        true);
  for (const double u : {-3.0, 0.0, 3.0})
    for (const double v : {-3.0, 0.0, 3.0}) few.add({u, v, PatchFrame::rounded(1 + 0.2 * u)}, true);
  for (PatchPoints* points : {&line, &few}) {
    const SheetShift shift = shift_of(std::move(*points), 3, 0.3);
    EXPECT_NEAR(shift.height, 1, 4 * 0.3 / std::sqrt(81));  // four standard errors of the line's 81 points
    EXPECT_EQ(shift.slope_u, 0);
    EXPECT_EQ(shift.slope_v, 0);
  }
}

TEST(SheetRegistration, FindsNoMotionIfThereAreNoPoints) {
  const SheetShift shift = shift_of(PatchPoints(scenes::kernels()), 3, 0.1);
  EXPECT_EQ(shift.slope_u, 0);
  EXPECT_EQ(shift.slope_v, 0);
  EXPECT_EQ(shift.height, 0);
}

std::set<std::uint32_t> found(const NeighbourSearch& search, const Ball& ball) {
  const GatheredPoints out = scenes::gathered(search, ball);
  std::set<std::uint32_t> numbers;
  for (std::size_t i = 0; i < out.size(); ++i) EXPECT_TRUE(numbers.insert(out.index()[i]).second);
  return numbers;
}

// If all points of the region are shown where they are, SheetSearch finds what the frame's search finds.
TEST(SheetSearch, FindsThePointsOfTheFrameIfNoneIsMoved) {
  PointCloud cloud = scenes::random_cloud(3000, 0.08, 3);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.fixture_radius_m.push_back(i % 7 == 0 ? 0.004 : 0);
    cloud.stiffness_N_per_m.push_back(100.0 + static_cast<double>(i));
  }
  const std::shared_ptr<const NeighbourSearch> frame = make_search(cloud);
  const PatchRegion region{PatchFrame(Vec3(0.01, 0, -0.01), Vec3(1, 2, 3).normalized(), kUnit), 8, 6};
  const GatheredPoints gathered = scenes::gathered(*frame, region.around());
  PatchPoints points(scenes::kernels());
  points.reserve(gathered.size());
  points.set_points(gathered, region);
  ASSERT_GT(points.size(), 100u);
  SheetSearch shown;
  shown.reserve(frame->size(), true, true);
  const auto buffer = std::make_shared<GatheredPoints>();
  buffer->reserve(frame->size(), true, true);
  shown.start(region, frame, buffer);
  for (std::size_t i = 0; i < points.size(); ++i) shown.add(points.place(i), gathered, points.source(i));
  shown.finish();
  shown.reserve(2 * frame->size(), true, true);  // keeps the shown points
  for (int i = 0; i < 200; ++i) {
    // Shown positions are rounded to a micrometre, so balls that are 3 um smaller and larger bound the
    // result.
    const Ball ball{Vec3(0.0007 * (i % 100) - 0.03, 0.0003 * i - 0.03, 0.001 * (i % 50) - 0.02),
                    0.004 + 0.0002 * (i % 90)};
    const auto less = found(*frame, {ball.centre, ball.radius - 3e-6}),
               more = found(*frame, {ball.centre, ball.radius + 3e-6}), here = found(shown, ball);
    for (const std::uint32_t number : less) EXPECT_TRUE(here.contains(number)) << i;
    for (const std::uint32_t number : here) EXPECT_TRUE(more.contains(number)) << i;
  }
}

TEST(SheetSearch, ContainsOnlyAddedPointsInTheRegion) {
  const std::shared_ptr<const NeighbourSearch> frame = make_search(scenes::flat_grid(100));
  const PatchRegion region{PatchFrame(Vec3::Zero(), Vec3::UnitY(), kUnit), 8, 4};
  const auto buffer = std::make_shared<GatheredPoints>();
  buffer->reserve(frame->size(), true, true);
  SheetSearch shown;
  shown.reserve(frame->size(), false, false);
  shown.start(region, frame, buffer);
  shown.finish();
  EXPECT_TRUE(found(shown, {Vec3::Zero(), 0.03}).empty());
  EXPECT_TRUE(found(shown, {Vec3(std::nan(""), 0, 0), 1}).empty());
  const auto outside = found(shown, {Vec3(0.05, 0, 0), 0.03});
  EXPECT_FALSE(outside.empty());
  const PointCloud cloud = scenes::flat_grid(100);
  for (const std::uint32_t number : outside) EXPECT_GE(cloud.point(number).norm(), 0.04 - 1e-5);
}

TEST(PatchFrame, PositionsSurviveARoundTrip) {
  const PatchFrame frame(Vec3(0.1, -0.2, 0.3), Vec3(-1, 0.5, 2).normalized(), kUnit);
  for (const Vec3& p : {Vec3(0.11, -0.19, 0.31), Vec3(0.1, -0.2, 0.3), Vec3(0.05, -0.25, 0.28)})
    EXPECT_LT((frame.world(frame.place(p)) - p).norm(), 2e-6);
  EXPECT_NEAR(frame.place(frame.origin_W() + 2 * kUnit * frame.normal_W()).h, 2, 1e-3);
  // A slope of 1 along u leans the normal by 45 degrees against u.
  EXPECT_NEAR(frame.normal_W(1, 0).dot(frame.normal_W()), std::sqrt(0.5), 1e-12);
}

TEST(StrayPoints, ASecondSheetIsASurfaceAndScatteredPointsAreNot) {
  PatchPoints points(scenes::kernels());
  points.reserve(4000);
  const auto add = [&](double u, double v, double h, bool member) { points.add({u, v, h}, member); };
  for (double v = -6; v < 6; v += 0.3)
    for (double u = -6; u < 6; u += 0.3) {
      add(u, v, 0, true);
      if (u > 0) add(u, v, -3, false);
    }
  for (int i = 0; i < 40; ++i) add(-5 + 0.12 * i, 3 - 0.15 * i, 1.5 + 0.06 * i, false);
  StrayPoints strays;
  strays.count(points, {PatchFrame(), 8, 6}, 0.1, 11);
  EXPECT_TRUE(strays.is_surface({3, 1, -3}));
  EXPECT_FALSE(strays.is_surface({-3, 0.5, 2.5}));
  EXPECT_FALSE(strays.is_surface({-4, 0, -3}));
}

PointCloud slanted(const std::vector<double>& depths_m, double sigma, unsigned seed) {
  return planes(depths_m, sigma, seed, 0.3, 40);
}

std::optional<FoundSheet> acquired(const PointCloud& cloud, const Vec3& proxy_W) {
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
    const auto sheet = acquired(slanted({0}, sigma, 3), Vec3(0, 0.01, 0));
    ASSERT_TRUE(sheet) << sigma;
    EXPECT_GT(sheet->frame.normal_W().dot(kNormal), std::cos(0.1)) << sigma;
    EXPECT_NEAR(height_above(*sheet, 0), 0, 0.02 + 0.2 * sigma) << sigma;
    EXPECT_NEAR(sheet->sigma.value_or(-1), sigma, 0.01 + 0.2 * sigma) << sigma;
  }
}

TEST(SheetAcquisition, FacesDownIfItIsFoundFromBelow) {
  const auto sheet = acquired(slanted({0}, 0.2, 3), Vec3(0, -0.01, 0));
  ASSERT_TRUE(sheet);
  EXPECT_LT(sheet->frame.normal_W().dot(kNormal), -std::cos(0.1));
}

// Two planes, 4 contact radii apart: the sheet is the one that is nearer to the proxy.
TEST(SheetAcquisition, TheNearerOfTwoIsTheSheet) {
  const PointCloud cloud = slanted({0, 0.02}, 0.2, 5);
  const auto upper = acquired(cloud, Vec3(0, 0.006, 0)), lower = acquired(cloud, Vec3(0, -0.028, 0));
  ASSERT_TRUE(upper && lower);
  EXPECT_NEAR(height_above(*upper, 0), 0, 0.1);
  EXPECT_NEAR(height_above(*lower, 0.02), 0, 0.1);
}

TEST(SheetAcquisition, FindsNoSheetIfThereIsNoSurface) {
  EXPECT_FALSE(acquired(PointCloud(), Vec3::Zero()));
  EXPECT_FALSE(acquired(slanted({0}, 0, 1), Vec3(0, 0.5, 0))) << "too far away";
  PointCloud few;
  for (const Vec3& p : {Vec3(0, 0, 0), Vec3(0.001, 0, 0), Vec3(0, 0, 0.001)}) few.append(p);
  EXPECT_FALSE(acquired(few, Vec3(0, 0.005, 0)));
  PointCloud lost;
  for (int i = 0; i < 100; ++i) lost.append(Vec3::Constant(std::nan("")));
  EXPECT_FALSE(acquired(lost, Vec3::Zero()));
}

}  // namespace
}  // namespace remote_touch::sheet_tracker_test
