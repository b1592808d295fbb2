// SheetSearch: a frame's points outside a tracked sheet's region, and the points shown within it.
// StrayPoints: stray points that form a surface.
#include "core/beyond/tracked_surface/sheet_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/beyond/tracked_surface/patch_points.h"
#include "core/beyond/tracked_surface/stray_points.h"
#include "tests/support/scenes.h"

namespace remote_touch::sheet_search_test {
namespace {

constexpr double kUnit = 0.005;

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

}  // namespace
}  // namespace remote_touch::sheet_search_test
