#include "runners/experiment/hand/scripted_motions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/simulated/grid_scenes.h"
#include "tests/support/scenes.h"

namespace remote_touch::scripted_motions_test {
namespace {

const double kDegree = std::acos(-1.0) / 180;

Poses poses(std::vector<double> rows) {
  return Poses({std::move(rows)}, FlatGrid({}, NoiseKey{}, scenes::kernels()));
}

void expect_at(const DeviceState& got, const Vec3& place, const Eigen::Quaterniond& orientation) {
  EXPECT_LT((got.position_W - place).norm(), 1e-15) << got.position_W.transpose();
  EXPECT_LT(got.orientation_W.angularDistance(orientation), 1e-7) << got.orientation_W;
  EXPECT_LT((got.orientation_W.toRotationMatrix() - orientation.toRotationMatrix()).norm(), 2e-15);
  EXPECT_NEAR(got.orientation_W.norm(), 1, 4e-16);
}

Eigen::Quaterniond about(const Vec3& axis, double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * kDegree, axis.normalized()));
}

TEST(Poses, GoStraightAndTurnEvenly) {
  const Poses device = poses({0,   0.1,  0, 0,  0,   0, 9,    //
                              0,   -0.1, 0, 0,  0,   0, 2,    //
                              0,   -0.1, 0, 0,  30,  0, 3,    //
                              0.3, 0,    0, 0,  -60, 0, 0.5,  //
                              1,   1,    1, 90, 0,   0, 0});
  EXPECT_EQ(device.duration_s(), 5.5);
  const Vec3 y = Vec3::UnitY();
  expect_at(device.at(-1), {0, 0.1, 0}, about(y, 0));
  expect_at(device.at(0.5), {0, 0.05, 0}, about(y, 0));
  expect_at(device.at(2), {0, -0.1, 0}, about(y, 0));
  expect_at(device.at(3), {0, -0.1, 0}, about(y, 10));
  expect_at(device.at(5), {0, -0.1, 0}, about(y, 30));
  expect_at(device.at(5.25), {0.15, -0.05, 0}, about(y, -15));
  expect_at(device.at(5.5), {1, 1, 1}, about(Vec3::UnitX(), 90));  // jumped, and stays
  expect_at(device.at(99), {1, 1, 1}, about(Vec3::UnitX(), 90));
}

// Slerp turns from one orientation to the other about a fixed axis.
TEST(Poses, TakeTheShorterWayRound) {
  const Poses device = poses({0, 0, 0, 20, -50, 80, 0, 0, 0, 0, -100, 30, 10, 1, 0, 0, 0, 0, 0, 200, 1});
  const Eigen::Quaterniond a = about({20, -50, 80}, Vec3(20, -50, 80).norm());
  const Eigen::Quaterniond b = about({-100, 30, 10}, Vec3(-100, 30, 10).norm());
  for (double fraction = 0; fraction < 1; fraction += 0.07)
    expect_at(device.at(fraction), {0, 0, 0}, a.slerp(fraction, b));
  // 200 degrees are 160 the other way.
  const Eigen::Quaterniond c = about({0, 0, 1}, -160);
  for (double fraction = 0; fraction < 1; fraction += 0.07)
    expect_at(device.at(1 + fraction), {0, 0, 0}, b.slerp(fraction, c));
  // The rotation has a constant rate.
  const double first = device.at(0.3).orientation_W.angularDistance(device.at(0.31).orientation_W);
  const double later = device.at(0.7).orientation_W.angularDistance(device.at(0.71).orientation_W);
  EXPECT_NEAR(first, later, 1e-8);
}

TEST(Poses, RefuseWhatIsNotUnique) {
  EXPECT_EQ(validate(Poses::Settings{}), "");
  EXPECT_NE(validate(Poses::Settings{{}}), "");
  EXPECT_NE(validate(Poses::Settings{{0, 0, 0, 0, 0, 0, -1}}), "");
  const auto turned = [](double degrees, double duration) {
    return validate(Poses::Settings{{0, 0, 0, 0, 10, 0, 0, 0, 0, 0, 0, 10 + degrees, 0, duration}});
  };
  EXPECT_EQ(turned(179, 1), "");
  EXPECT_NE(turned(180, 1), "");
  EXPECT_NE(turned(-180, 1), "");
  EXPECT_EQ(turned(180, 0), "") << "a jump goes no way";
  EXPECT_EQ(turned(360, 1), "");
}

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
}  // namespace remote_touch::scripted_motions_test
