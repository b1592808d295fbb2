// Comparison of the closed forms with heights that are computed position by position, and with random noise.
#include "analysis/theory/tool_jump.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace remote_touch::tool_jump_test {
namespace {

constexpr double kHalf_m = 0.02, kDegree = 0.017453292519943295;

// Lowest and highest position over the square, found by trying 401 x 401.
UnderPlate tried(const std::function<double(double x, double z)>& height_m) {
  UnderPlate under{-1, -1};
  for (int i = -200; i <= 200; ++i)
    for (int k = -200; k <= 200; ++k) {
      const double height = height_m(i * kHalf_m / 200, k * kHalf_m / 200);
      under.drop_m = std::max(under.drop_m, -height), under.rise_m = std::max(under.rise_m, height);
    }
  return under;
}

// The flanks are lines through the edge, so they stay lines when it turns.
TEST(ToolJump, AnEdgeThatTurnsRisesOnOneSideAndFallsOnTheOther) {
  for (const double slope : {0.0, 15.0, 30.0})
    for (const double turn : {0.0, 10.0, 40.0}) {
      const UnderPlate right = tried(
          [&](double x, double) { return x * std::tan((x > 0 ? turn - slope : turn + slope) * kDegree); });
      const UnderPlate under = under_edge(slope * kDegree, kHalf_m, turn * kDegree);
      EXPECT_NEAR(under.drop_m, right.drop_m, 1e-12) << slope << ", " << turn;
      EXPECT_NEAR(under.rise_m, right.rise_m, 1e-12) << slope << ", " << turn;
    }
}

TEST(ToolJump, ACornerFallsMostTowardsACornerOfThePlate) {
  for (const double slope : {10.0, 45.0, 70.0}) {
    const UnderPlate right = tried([&](double x, double z) {
      double height = 1;
      for (const double face : {90.0, 210.0, 330.0})
        height = std::min(height, -std::tan(slope * kDegree) *
                                      (x * std::cos(face * kDegree) + z * std::sin(face * kDegree)));
      return height;
    });
    EXPECT_NEAR(under_corner(slope * kDegree, kHalf_m).drop_m, right.drop_m, 1e-12) << slope;
  }
}

TEST(ToolJump, ABallFallsUpToTheCornersOfThePlateOrToItsMiddle) {
  for (const double radius_m : {0.03, 0.05, 0.2}) {
    const UnderPlate right =
        tried([&](double x, double z) { return std::sqrt(radius_m * radius_m - x * x - z * z) - radius_m; });
    EXPECT_NEAR(under_ball(radius_m, std::sqrt(2.0) * kHalf_m).drop_m, right.drop_m, 1e-12) << radius_m;
  }
  EXPECT_EQ(under_ball(0.01, 0.02).drop_m, 0.01);
}

// Returns the fraction of randomly drawn jumps after which no point is left in the plate.
double lost_fraction(double jump_m, double thickness_m, const std::vector<NoisyPoint>& points,
                     double sigma_m) {
  constexpr int kJumps = 2000;
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, sigma_m);
  std::uniform_real_distribution<double> chance(0, 1);
  int lost = 0;
  for (int jump = 0; jump < kJumps; ++jump) {
    double bottom_m = -1;
    bool left = false;
    for (const NoisyPoint& p : points)
      if (chance(random) < p.under_plate_probability)
        bottom_m = std::max(bottom_m, p.height_m + noise(random));
    for (const NoisyPoint& p : points) {
      const double place_m = p.height_m + jump_m + noise(random) - bottom_m;
      left |= chance(random) < p.under_plate_probability && place_m > 0 && place_m < thickness_m;
    }
    lost += left ? 0 : 1;
  }
  return static_cast<double>(lost) / kJumps;
}

// 2000 jumps determine a fraction within 0.04 (3.5 standard errors at one half). The closed form uses the
// median position of the plate, which scatters; this changes the fraction by less than 0.05 here.
TEST(ToolJump, HalfOfAllToolsAreLostAtTheJumpOfNoisyPoints) {
  std::vector<NoisyPoint> plane(400), slope, fading;
  for (int i = 0; i < 400; ++i) {
    slope.push_back({-0.00005 * i, 1});
    fading.push_back({-0.00005 * i, i < 200 ? 1 : 2 - 0.005 * i});
  }
  for (const auto& points : {plane, slope, fading})
    for (const double sigma_m : {0.0005, 0.002}) {
      const double jump_m = noisy_jump_m(0.01, points, sigma_m);
      EXPECT_NEAR(lost_fraction(jump_m, 0.01, points, sigma_m), 0.5, 0.09) << sigma_m;
      EXPECT_LT(lost_fraction(jump_m - 2 * sigma_m, 0.01, points, sigma_m), 0.15) << sigma_m;
      EXPECT_GT(lost_fraction(jump_m + 2 * sigma_m, 0.01, points, sigma_m), 0.85) << sigma_m;
    }
}

TEST(ToolJump, IsTheThicknessAndTheDropAtLittleNoise) {
  EXPECT_NEAR(noisy_jump_m(0.01, {{0}, {-0.002}, {-0.004}, {-0.006}}, 1e-7), 0.016, 1e-6);
}

}  // namespace
}  // namespace remote_touch::tool_jump_test
