// A device that lacks some motors, in any orientation of its handle.
#include "runners/experiment/hand/device_motors.h"

#include <gtest/gtest.h>

#include <random>

#include "core/geometry/rotation.h"

namespace remote_touch::device_motors_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::device_motors_test
