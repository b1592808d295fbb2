// The motion of a run's device: by the script alone, or by a hand that feels the forces of the device.
#include "runners/experiment/hand/simulated_hand.h"

#include <gtest/gtest.h>

#include "core/geometry/rotation.h"
#include "core/rendering/renderer.h"

namespace remote_touch::simulated_hand_test {
namespace {

constexpr double kTick_s = 0.001;

DeviceState at(const Vec3& p_W, const Vec3& turn = Vec3::Zero()) {
  return {p_W, rotation(turn)};
}

TEST(SimulatedHand, FollowsTheScriptExactlyIfThereIsNoOperator) {
  SimulatedHand hand({}, {}, kTick_s);
  RenderOutput out;
  out.force_N = {100, 0, 0};
  for (int i = 0; i < 5; ++i) {
    DeviceState path = at({0.1 * i, 0, 0}, {0, 0.2, 0});
    path.buttons = 5;
    const DeviceState d = hand.move(path, i * kTick_s);
    EXPECT_EQ(d.position_W, path.position_W);
    EXPECT_EQ(d.orientation_W.coeffs(), path.orientation_W.coeffs());
    EXPECT_EQ(d.buttons, 5u);
    hand.apply(rendered_wrench(out));
    EXPECT_FALSE(hand.state());
  }
}

// The force of one tick moves the hand in the next, as far as the device has motors.
TEST(SimulatedHand, FeelsWhatTheDeviceExerts) {
  DeviceSettings device;
  device.motors.force_y = device.motors.torque_x = false;
  SimulatedHand hand(OperatorSettings{}, device, kTick_s);
  RenderOutput out;
  out.force_N = {1, 2, 0};
  out.tool.emplace().torque_Nm = {0.1, 0, 0.2};
  hand.move(at({0, 0, 0}), 0);
  EXPECT_EQ(hand.state()->force_N, Vec3::Zero());
  hand.apply(rendered_wrench(out));
  EXPECT_EQ(hand.state()->force_N, Vec3(1, 0, 0));
  EXPECT_EQ(hand.state()->torque_Nm, Vec3(0, 0, 0.2));
  EXPECT_EQ(hand.state()->intended_W, Vec3::Zero());
  const DeviceState next = hand.move(at({0, 0, 0}), kTick_s);
  EXPECT_GT(next.position_W.x(), 0);
  EXPECT_EQ(next.position_W.y(), 0);
  const Vec3 turn = rotation_vector(next.orientation_W);
  EXPECT_EQ(turn.x(), 0);
  EXPECT_GT(turn.z(), 0);
}

// A renderer of three degrees of freedom has no torque, so that of the tick before is cleared.
TEST(SimulatedHand, FeelsNoTorqueWithoutATool) {
  SimulatedHand hand(OperatorSettings{}, {}, kTick_s);
  hand.move(at({0, 0, 0}), 0);
  RenderOutput out;
  out.tool.emplace().torque_Nm = {1, 0, 0};
  hand.apply(rendered_wrench(out));
  EXPECT_EQ(hand.state()->torque_Nm, Vec3(1, 0, 0));
  hand.apply({});
  EXPECT_EQ(hand.state()->torque_Nm, Vec3::Zero());
}

}  // namespace
}  // namespace remote_touch::simulated_hand_test
