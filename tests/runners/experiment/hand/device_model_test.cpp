#include "runners/experiment/hand/device_model.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "core/points/vector.h"

namespace remote_touch::device_model_test {
namespace {

// A device that lacks some motors, in any orientation of its handle.

Vec3 direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vec3(normal(random), normal(random), normal(random)).normalized();
}

TEST(DeviceMotors, ADeviceWithAllOfThemExertsWhatIsCommanded) {
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    const Wrench commanded{5 * direction(random), direction(random)};
    const Wrench device_wrench = exerted({}, rotation(3 * direction(random)), commanded);
    EXPECT_EQ(device_wrench.force_N, commanded.force_N);
    EXPECT_LT((device_wrench.torque_Nm - commanded.torque_Nm).norm(), 4e-15);
  }
}

// The torque about the missing axis of the handle is zero and that about the other two is as commanded, in
// every orientation.
TEST(DeviceMotors, TorquesAreRemovedAboutTheHandleAxes) {
  std::mt19937 random(2);
  for (int missing = 0; missing < 3; ++missing) {
    MotorSettings motors;
    (missing == 0 ? motors.torque_x : missing == 1 ? motors.torque_y : motors.torque_z) = false;
    for (int i = 0; i < 50; ++i) {
      const Eigen::Quaterniond handle_W = rotation(3 * direction(random));
      const Wrench commanded{direction(random), direction(random)};
      const Wrench device_wrench = exerted(motors, handle_W, commanded);
      EXPECT_EQ(device_wrench.force_N, commanded.force_N);
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 axis_W = handle_W.toRotationMatrix().col(axis);
        EXPECT_NEAR(device_wrench.torque_Nm.dot(axis_W),
                    axis == missing ? 0 : commanded.torque_Nm.dot(axis_W), 4e-15);
      }
    }
  }
}

// The x axis of a handle that is turned by 90 degrees is the y axis of the base.
TEST(DeviceMotors, TheRollOfATurnedHandleIsAnotherAxisOfTheBase) {
  MotorSettings motors;
  motors.torque_x = false;
  const Eigen::Quaterniond quarter(Eigen::AngleAxisd(0.5 * 3.14159265358979323846, Vec3::UnitZ()));
  EXPECT_LT((exerted(motors, quarter, {Vec3::Zero(), {1, 2, 3}}).torque_Nm - Vec3(1, 0, 3)).norm(), 4e-15);
}

TEST(DeviceMotors, ForcesAreRemovedAlongTheBaseAxes) {
  std::mt19937 random(3);
  MotorSettings motors;
  motors.force_x = motors.force_z = false;
  const Wrench device_wrench = exerted(motors, rotation(direction(random)), {{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(device_wrench.force_N, Vec3(0, 2, 0));
  EXPECT_LT((device_wrench.torque_Nm - Vec3(4, 5, 6)).norm(), 1e-14);
  motors.force_y = false;
  EXPECT_EQ(exerted(motors, rotation(direction(random)), {{1, 2, 3}, {0, 0, 0}}).force_N, Vec3::Zero());
}

TEST(DeviceMotors, LongerWrenchesAreCutAndShorterOnesLeft) {
  std::mt19937 random(4);
  MotorSettings motors;
  motors.max_force_N = 3, motors.max_torque_Nm = 0.2;
  for (int i = 0; i < 20; ++i) {
    const Eigen::Quaterniond handle_W = rotation(3 * direction(random));
    const Vec3 f = direction(random), t = direction(random);
    const Wrench cut = exerted(motors, handle_W, {(3.1 + i) * f, (0.21 + i) * t});
    EXPECT_LT((cut.force_N - 3 * f).norm(), 1e-14);
    EXPECT_LT((cut.torque_Nm - 0.2 * t).norm(), 4e-15);
    const Wrench left = exerted(motors, handle_W, {2.9 * f, 0.19 * t});
    EXPECT_EQ(left.force_N, 2.9 * f);
    EXPECT_LT((left.torque_Nm - 0.19 * t).norm(), 4e-15);
  }
}

TEST(DeviceMotors, AZeroIsNoLimit) {
  EXPECT_EQ(exerted({}, Eigen::Quaterniond::Identity(), {{1e6, 0, 0}, {0, 1e6, 0}}).force_N, Vec3(1e6, 0, 0));
  EXPECT_EQ(exerted({}, Eigen::Quaterniond::Identity(), {{1e6, 0, 0}, {0, 1e6, 0}}).torque_Nm,
            Vec3(0, 1e6, 0));
}

// A simulated device: what it measures and exerts.

constexpr double kTick_s = 0.001;

Wrench pull(double x_N) {
  return {{x_N, 0, 0}, Vec3::Zero()};
}

TEST(DeviceModel, WithoutSettingsMeasuresAndExertsExactly) {
  DeviceModel device({}, kTick_s);
  DeviceState hand{{0.123456789, -2, 3}, rotation({0.1, 0.2, 0.3})};
  hand.buttons = 3;
  const DeviceState seen = device.measured(hand);
  EXPECT_EQ(seen.position_W, hand.position_W);
  EXPECT_EQ(seen.orientation_W.coeffs(), hand.orientation_W.coeffs());
  EXPECT_EQ(seen.buttons, 3u);
  const Wrench exerted = device.exerted_for({{1, 2, 3}, {4, 5, 6}});
  EXPECT_EQ(exerted.force_N, Vec3(1, 2, 3));
  EXPECT_TRUE(exerted.torque_Nm.isApprox(Vec3(4, 5, 6), 1e-15));
}

TEST(DeviceModel, RoundsThePoseToItsResolution) {
  DeviceSettings s;
  s.position_resolution_m = 0.001, s.angle_resolution_deg = 2;
  DeviceModel device(s, kTick_s);
  const DeviceState seen =
      device.measured({{0.00249, -0.00251, 0}, rotation({0, 0.9 * std::numbers::pi / 180, 0.05})});
  EXPECT_NEAR(seen.position_W.x(), 0.002, 1e-15);
  EXPECT_NEAR(seen.position_W.y(), -0.003, 1e-15);
  EXPECT_EQ(seen.position_W.z(), 0);
  const Vec3 turn_deg = rotation_vector(seen.orientation_W) * 180 / std::numbers::pi;  // 0.05 rad = 2.86 deg
  EXPECT_NEAR((turn_deg - Vec3(0, 0, 2)).norm(), 0, 1e-12);
}

TEST(DeviceModel, ExertsACommandAfterItsDelay) {
  for (const int delay : {0, 1, 5}) {
    DeviceSettings s;
    s.delay_ticks = delay;
    DeviceModel device(s, kTick_s);
    for (int tick = 0; tick < 12; ++tick) {
      device.measured({});
      const double expected = tick < delay ? 0 : 1 + tick - delay;
      EXPECT_EQ(device.exerted_for(pull(1 + tick)).force_N.x(), expected) << delay << " " << tick;
    }
  }
}

TEST(DeviceModel, DampsACommandWithAForceOnly) {
  DeviceSettings s;
  s.contact_damping_Ns_per_m = 2, s.velocity_ticks = 3;
  DeviceModel device(s, kTick_s);
  const double positions[] = {0, 0.001, 0.003, 0.006, 0.010};
  const double velocities[] = {0, 1, 1.5, 2, 3};  // over three ticks, over fewer at the begin
  for (int tick = 0; tick < 5; ++tick) {
    device.measured({{positions[tick], 0, 0}});
    EXPECT_NEAR(device.exerted_for(pull(10)).force_N.x(), 10 - 2 * velocities[tick], 1e-12) << tick;
  }
  device.measured({{1, 0, 0}});
  EXPECT_EQ(device.exerted_for({}).force_N, Vec3::Zero());
}

// The motors limit what arrives, not what was commanded.
TEST(DeviceModel, LimitsWhatArrives) {
  DeviceSettings s;
  s.motors.max_force_N = 3, s.motors.force_y = false, s.delay_ticks = 1;
  DeviceModel device(s, kTick_s);
  device.measured({});
  EXPECT_EQ(device.exerted_for({{8, 8, 0}, Vec3::Zero()}).force_N, Vec3::Zero());
  device.measured({});
  EXPECT_NEAR((device.exerted_for({}).force_N - Vec3(3, 0, 0)).norm(), 0, 1e-15);
}

TEST(DeviceSettings, RefuseAVelocityThatNothingUses) {
  DeviceSettings s;
  EXPECT_EQ(validate(s), "");
  s.velocity_ticks = 4;
  EXPECT_NE(validate(s).find("contact_damping_Ns_per_m"), std::string::npos);
  s.contact_damping_Ns_per_m = 1;
  EXPECT_EQ(validate(s), "");
}

}  // namespace
}  // namespace remote_touch::device_model_test
