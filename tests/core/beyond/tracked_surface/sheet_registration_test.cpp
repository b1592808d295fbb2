// Registration of a frame's sheet to that of the frame before, from points alone.
#include "core/beyond/tracked_surface/sheet_registration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "tests/support/scenes.h"

namespace remote_touch::sheet_registration_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::sheet_registration_test
