// Comparison of the closed forms with the least energy that is found by trying poses.
#include "analysis/theory/tool_rest.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace remote_touch::tool_rest_test {
namespace {

const EvenSpring kSpring{600, 0.03};
constexpr double kTurning = 600 * 0.03 * 0.03;

TEST(ToolRest, ABlockOnALineHasTheLeastEnergy) {
  constexpr double a = 0.02, b = 0.005;
  for (const double angle : {0.05, -0.05, 0.2, 0.5})
    for (const double depth_m : {-0.001, 0.0005, 0.003, 0.01}) {
      const double height_m = a * std::sin(std::abs(angle)) + b * std::cos(angle) - depth_m;
      double least = 1e9, at_y = 0, at_phi = 0;
      for (double phi = -1; phi < 1; phi += 2e-5) {
        const double touching_m = a * std::abs(std::sin(phi)) + b * std::cos(phi);
        const double y = std::max(height_m, touching_m);
        const double energy =
            300 * (y - height_m) * (y - height_m) + 0.5 * kTurning * (phi - angle) * (phi - angle);
        if (energy < least) least = energy, at_y = y, at_phi = phi;
      }
      const RestingWrench wrench = block_on_line(a, b, kSpring, height_m, angle);
      EXPECT_NEAR(wrench.force_N.y(), 600 * (at_y - height_m), 1e-3) << angle << ", " << depth_m;
      EXPECT_NEAR(wrench.torque_Nm, kTurning * (at_phi - angle), 3e-5) << angle << ", " << depth_m;
      EXPECT_EQ(wrench.force_N.x(), 0);
    }
}

// The torque is only that of the force at the corner.
TEST(ToolRest, TheTorqueIsThatOfTheForceAtTheCorner) {
  constexpr double a = 0.02, b = 0.005, angle = 0.3;
  const RestingWrench wrench = block_on_line(a, b, kSpring, 0.007, angle);
  const double phi = angle + wrench.torque_Nm / kTurning;
  ASSERT_GT(phi, 0.01);
  EXPECT_NEAR(wrench.torque_Nm, -wrench.force_N.y() * (a * std::cos(phi) - b * std::sin(phi)), 1e-12);
}

TEST(ToolRest, ABallInAGrooveHasTheLeastEnergy) {
  constexpr double radius_m = 0.01;
  for (const double slope : {0.2, 0.6, 1.0})
    for (const double x : {-0.012, -0.001, 0.0, 0.004})
      for (const double y : {-0.01, 0.004, 0.03}) {
        double least = 1e9;
        Eigen::Vector2d rest(0, 0);
        for (double px = -0.03; px <= 0.03; px += 1e-5) {
          const double lowest = std::abs(px) * std::tan(slope) + radius_m / std::cos(slope);
          const Eigen::Vector2d p(px, std::max(y, lowest));
          const double squared = (p - Eigen::Vector2d(x, y)).squaredNorm();
          if (squared < least) least = squared, rest = p;
        }
        const RestingWrench wrench = ball_in_groove(radius_m, slope, kSpring, {x, y});
        EXPECT_NEAR((wrench.force_N - 600 * (rest - Eigen::Vector2d(x, y))).norm(), 0, 0.015)
            << slope << ", " << x << ", " << y;
      }
}

TEST(ToolRest, ABarInASlotTurnsUntilItsCornersTouch) {
  const double stop = stop_angle_rad(0.04, 0.005, 0.02);
  EXPECT_NEAR(0.04 * std::sin(stop) + 0.005 * std::cos(stop), 0.02, 1e-15);
  EXPECT_NEAR(stop * 180 / M_PI, 22.62, 0.001);
  EXPECT_EQ(bar_in_slot(0.04, 0.005, 0.02, kSpring, 0.9 * stop).torque_Nm, 0);
  EXPECT_NEAR(bar_in_slot(0.04, 0.005, 0.02, kSpring, -stop - 0.1).torque_Nm, 0.1 * kTurning, 1e-12);
}

}  // namespace
}  // namespace remote_touch::tool_rest_test
