#include "core/dissertation/tool/dynamics/tool_pose.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace remote_touch::tool_pose_test {
namespace {

Vec3 draw(std::mt19937& random, double half_width) {
  std::uniform_real_distribution<double> along(-half_width, half_width);
  const double x = along(random), y = along(random), z = along(random);
  return {x, y, z};
}

TEST(ToolPose, TheExponentialIsTheRotationOfTheVector) {
  const Vec3 rotated = rotation({0, 0, 0.5 * M_PI}) * Vec3::UnitX();
  EXPECT_LT((rotated - Vec3::UnitY()).norm(), 1e-15);
}

// displacement() leads from one pose to the other, with the shorter rotation.
TEST(ToolPose, MovingByTheDisplacementReachesTheTarget) {
  std::mt19937 random(2);
  for (int i = 0; i < 2000; ++i) {
    const ToolPose from{draw(random, 1), rotation(draw(random, 3))},
        to{draw(random, 1), rotation(draw(random, 3))};
    const Vector6 a_gu = displacement(from, to);
    EXPECT_LE(a_gu.tail<3>().norm(), M_PI + 1e-12);
    const ToolPose there = moved(from, a_gu);
    EXPECT_LT((there.p_W - to.p_W).norm(), 1e-14);
    EXPECT_GT(std::abs(there.q_WT.dot(to.q_WT)), 1 - 1e-14);
  }
}

// Rotation into the tool's axes and back keeps lengths, so a bound of the displacement holds in either frame.
TEST(ToolPose, ATurnedDisplacementIsTheSameInOtherAxes) {
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Quaterniond q = rotation(draw(random, 3));
    Vector6 a_g;
    a_g << draw(random, 0.1), draw(random, 1);
    const Vector6 other = rotated(q, a_g);
    EXPECT_LT((other.head<3>() - q.toRotationMatrix() * a_g.head<3>()).norm(), 1e-15);
    EXPECT_LT((other.tail<3>() - q.toRotationMatrix() * a_g.tail<3>()).norm(), 1e-14);
    EXPECT_LT((rotated(q.conjugate(), other) - a_g).norm(), 1e-14);
    EXPECT_NEAR(max_point_displacement_m(other, 0.05), max_point_displacement_m(a_g, 0.05), 1e-15);
  }
}

// No point of the tool moves farther than max_point_displacement_m() returns.
TEST(ToolPose, TheWayBoundsTheWayOfEveryPoint) {
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const ToolPose pose{draw(random, 1), rotation(draw(random, 3))};
    Vector6 a_g;
    a_g << draw(random, 0.1), draw(random, 1);
    const Vec3 p_T = 0.05 * draw(random, 1).normalized();
    const ToolPose there = moved(pose, a_g);
    const double went = (there.p_W + there.q_WT * p_T - pose.p_W - pose.q_WT * p_T).norm();
    EXPECT_LE(went, max_point_displacement_m(a_g, 0.05) + 1e-14);
    const Vector6 shorter = capped(a_g, 0.05, 0.001);
    EXPECT_LE(max_point_displacement_m(shorter, 0.05), 0.001 * (1 + 1e-12));
    EXPECT_LT((shorter.normalized() - a_g.normalized()).norm(), 1e-12);
  }
  const Vector6 small = Vector6::Constant(1e-6);
  EXPECT_EQ(capped(small, 0.05, 0.001), small);
}

}  // namespace
}  // namespace remote_touch::tool_pose_test
