// A simulated device: what it measures and exerts.
#include "runners/experiment/hand/device_model.h"

#include <gtest/gtest.h>

#include <numbers>

#include "core/geometry/rotation.h"

namespace remote_touch::device_model_test {
namespace {

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
