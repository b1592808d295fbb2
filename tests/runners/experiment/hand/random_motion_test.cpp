#include "runners/experiment/hand/random_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/synthetic/flat_grid.h"
#include "tests/support/scenes.h"

namespace remote_touch::random_motion_test {
namespace {

RandomMotion motion_of(const RandomMotion::Settings& settings) {
  return RandomMotion(settings, FlatGrid({}, NoiseKey{}, scenes::kernels()));
}

TEST(RandomMotion, StaysInItsBoxAndBelowItsSpeed) {
  RandomMotion::Settings s;
  s.centre_m = {1, 2, 3}, s.extent_m = {0.02, 0.05, 0.01}, s.max_rotation_deg = 40, s.duration_s = 200;
  const RandomMotion device = motion_of(s);
  Vec3 max_width = Vec3::Zero();
  double max_speed = 0, max_rotation = 0;
  for (double t = 0; t < s.duration_s; t += 0.01) {
    const DeviceState now = device.at(t), next = device.at(t + 0.001);
    max_width = max_width.cwiseMax((now.position_W - s.centre_m).cwiseAbs());
    max_speed = std::max(max_speed, (next.position_W - now.position_W).norm() / 0.001);
    max_rotation = std::max(max_rotation, now.orientation_W.angularDistance(Eigen::Quaterniond::Identity()));
    ASSERT_NEAR(now.orientation_W.norm(), 1, 4e-16);
    ASSERT_LT(now.orientation_W.angularDistance(next.orientation_W), 0.01) << "smooth";
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(max_width[axis], s.extent_m[axis]);
    EXPECT_GT(max_width[axis], 0.8 * s.extent_m[axis]);
  }
  EXPECT_LE(max_speed, s.speed_m_per_s * (1 + 1e-9));
  EXPECT_GT(max_speed, 0.5 * s.speed_m_per_s);
  const double degree = std::acos(-1.0) / 180;
  EXPECT_LE(max_rotation, s.max_rotation_deg * degree * (1 + 1e-9));
  EXPECT_GT(max_rotation, 0.5 * s.max_rotation_deg * degree);
}

TEST(RandomMotion, EverySeedIsAnotherMotion) {
  RandomMotion::Settings s;
  const RandomMotion one = motion_of(s), same = motion_of(s);
  s.seed = 2;
  const RandomMotion other = motion_of(s);
  for (const double t : {3.0, 0.0, 7.7}) {
    EXPECT_EQ(one.at(t).position_W, same.at(t).position_W);
    EXPECT_GT((one.at(t).position_W - other.at(t).position_W).norm(), 1e-3);
    EXPECT_GT(one.at(t).orientation_W.angularDistance(other.at(t).orientation_W), 1e-2);
  }
  EXPECT_EQ(one.at(10).position_W, one.at(1e9).position_W);
  EXPECT_EQ(one.duration_s(), 10);
}

TEST(RandomMotion, RefusesABoxThatIsTooSmall) {
  RandomMotion::Settings s;
  EXPECT_EQ(validate(s), "");
  s.extent_m = {1e-7, 0, 0};
  EXPECT_NE(validate(s), "");
  s.extent_m.setZero();
  EXPECT_NE(validate(s), "");
}

}  // namespace
}  // namespace remote_touch::random_motion_test
