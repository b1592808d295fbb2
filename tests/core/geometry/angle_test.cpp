#include "core/geometry/angle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace remote_touch::angle_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(AngleBetween, IsThatOfTheLibraryForRandomVectors) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 a(normal(random), normal(random), normal(random));
    const Vec3 b(normal(random), normal(random), normal(random));
    const double expected = std::atan2(a.cross(b).norm(), a.dot(b));
    ASSERT_NEAR(angle_between(1e-3 * a, 1e3 * b), expected, 2e-15) << i;
    ASSERT_EQ(angle_between(a, b), angle_between(b, a));
  }
}

// Acos of the dot product would lose half of the digits at both ends.
TEST(AngleBetween, IsExactAtBothEnds) {
  for (const double angle : {1e-12, 1e-8, 1e-4, 0.1, kPi / 2, 3.0}) {
    const Vec3 a(2, 0, 0), b(std::cos(angle), std::sin(angle), 0);
    EXPECT_NEAR(angle_between(a, b), angle, 2e-15) << angle;
    EXPECT_NEAR(angle_between(a, -b), kPi - angle, 2e-15) << angle;
  }
  EXPECT_EQ(angle_between(Vec3(1, 2, 3), Vec3(2, 4, 6)), 0);
  EXPECT_NEAR(angle_between(Vec3(1, 2, 3), Vec3(-1, -2, -3)), kPi, 2e-15);
  EXPECT_NEAR(angle_between(Vec3(1, 0, 0), Vec3(0, 1, 0)), kPi / 2, 2e-15);
}

}  // namespace
}  // namespace remote_touch::angle_test
