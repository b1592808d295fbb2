#include "runners/live/devices/haptic_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/doubles/simulated_clock.h"

namespace remote_touch::safety_gate_test {
namespace {

constexpr double kTick_s = 0.001;

// A loop at 1 kHz around a gate.
struct Loop {
  SafetyLimits limits;
  SafetyGate gate;
  double now_s = 0;
  DeviceReading reading;
  DeviceFault fault;

  explicit Loop(const SafetyLimits& l = {}) : limits(l), gate(l) {}
  Wrench tick(const Vec3& force_N, const Vec3& torque_Nm = Vec3::Zero(), double gap_s = kTick_s) {
    now_s += gap_s;
    return gate.pass(now_s, reading, fault, {force_N, torque_Nm}, now_s);
  }
  // Engaged and ramped up, with no force.
  void engage() {
    for (int i = 0; i < 600; ++i) tick(Vec3::Zero());
    ASSERT_EQ(gate.state(), GateState::engaged);
  }
};

bool begins(const Vec3& force_N, const Vec3& torque_Nm, const SafetyLimits& limits = {}) {
  Loop loop(limits);
  const Wrench out = loop.tick(force_N, torque_Nm);
  EXPECT_TRUE(out.force_N.isZero(0) && out.torque_Nm.isZero(0));
  EXPECT_TRUE(loop.gate.state() == GateState::ramping || loop.gate.state() == GateState::waiting);
  return loop.gate.state() == GateState::ramping;
}

TEST(SafetyGate, BeginsOnlyBelowTheThresholdAndThenRisesEvenly) {
  Loop loop;
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(loop.tick({1, 0, 0}).force_N.isZero(0));
  EXPECT_EQ(loop.gate.state(), GateState::waiting);
  EXPECT_TRUE(loop.tick({0.2, 0, 0}).force_N.isZero(0));
  EXPECT_EQ(loop.gate.state(), GateState::ramping);
  double before = 0;
  for (int i = 1; i < 500; ++i) {
    const double now = loop.tick({1, 0, 0}).force_N.x();
    EXPECT_NEAR(now, i * kTick_s / 0.5, 1e-9);
    EXPECT_GT(now, before);
    before = now;
  }
  for (int i = 0; i < 5; ++i) loop.tick({1, 0, 0});
  EXPECT_EQ(loop.gate.state(), GateState::engaged);
  EXPECT_NEAR(loop.tick({1, 0, 0}).force_N.x(), 1, 1e-12);
}

// The force falls to zero after a camera has stopped, and starts again gently when it comes back.
TEST(SafetyGate, AFrameThatIsTooOldEndsTheForceUntilTheNextOne) {
  SafetyLimits limits;
  limits.max_frame_age_s = 0.2;
  Loop loop(limits);
  loop.engage();
  const auto force = [&](double frame_age_s) {
    loop.now_s += kTick_s;
    const Wrench command{{1, 0, 0}, Vec3::Zero()};
    return loop.gate.pass(loop.now_s, {}, {}, command, loop.now_s, frame_age_s).force_N.x();
  };
  for (int i = 1; i <= 200; ++i) EXPECT_GT(force(i * kTick_s), 0) << i;
  for (int i = 201; i <= 210; ++i) force(i * kTick_s);
  EXPECT_EQ(force(0.211), 0);
  EXPECT_EQ(force(0), 0) << "the hand is still inside";
  EXPECT_EQ(loop.gate.state(), GateState::waiting);
  loop.tick(Vec3::Zero());
  EXPECT_EQ(loop.gate.state(), GateState::ramping);
}

// A ramp is not a limit: the state tells it.
TEST(SafetyGate, KnowsWhenItLimits) {
  Loop loop;
  EXPECT_FALSE(loop.gate.is_limiting());
  loop.tick(Vec3::Zero());
  for (int i = 0; i < 100; ++i) loop.tick({1, 0, 0});
  EXPECT_EQ(loop.gate.state(), GateState::ramping);
  EXPECT_FALSE(loop.gate.is_limiting());
  for (int i = 0; i < 600; ++i) loop.tick({1, 0, 0});
  EXPECT_FALSE(loop.gate.is_limiting());
  const double limit_N = loop.limits.max_force_N;
  for (int i = 0; i < 100; ++i) loop.tick({0.999 * limit_N, 0, 0});
  EXPECT_FALSE(loop.gate.is_limiting());
  loop.tick({1.1 * limit_N, 0, 0});
  EXPECT_TRUE(loop.gate.is_limiting());
  for (int i = 0; i < 100; ++i) loop.tick({0, 0, 0});
  EXPECT_FALSE(loop.gate.is_limiting());
  loop.tick({limit_N, 0, 0});
  EXPECT_TRUE(loop.gate.is_limiting()) << "it rises too fast";
  for (int i = 0; i < 100; ++i) loop.tick({limit_N, 0, 0});
  EXPECT_FALSE(loop.gate.is_limiting());
  loop.tick({limit_N, 0, 0}, {0, 2 * loop.limits.max_torque_Nm, 0});
  EXPECT_TRUE(loop.gate.is_limiting());
  loop.gate.latch({"a fault"});
  loop.tick({limit_N, 0, 0});
  EXPECT_FALSE(loop.gate.is_limiting());
}

// Both lengths must be below their thresholds. That of the torque is 0.3 / 5 of its limit, 12 mN m.
TEST(SafetyGate, ForceAndTorqueMustBothBeShorterThanTheirThresholds) {
  EXPECT_TRUE(begins({0.299, 0, 0}, {0, -0.0119, 0}));
  EXPECT_FALSE(begins({0.3, 0, 0}, Vec3::Zero()));
  EXPECT_FALSE(begins({0, -0.301, 0}, Vec3::Zero()));
  EXPECT_FALSE(begins({0.2, -0.2, 0.2}, Vec3::Zero())) << "0.35 N";
  EXPECT_FALSE(begins(Vec3::Zero(), {0, -0.0121, 0}));
  EXPECT_FALSE(begins(Vec3::Zero(), {0.1, 0, 0}));
  EXPECT_FALSE(begins(Vec3::Zero(), {0.008, -0.008, 0.008})) << "14 mN m";
}

// The limits have thresholds that are exact in binary: 0.25 N, and 0.25 / 4 of 0.5 N m.
TEST(SafetyGate, AForceOrTorqueEqualToItsThresholdDoesNotBegin) {
  SafetyLimits limits;
  limits.engage_force_N = 0.25, limits.max_force_N = 4, limits.max_torque_Nm = 0.5;
  const double torque_Nm = 0.03125;
  EXPECT_FALSE(begins({0.25, 0, 0}, Vec3::Zero(), limits));
  EXPECT_FALSE(begins(Vec3::Zero(), {0, torque_Nm, 0}, limits));
  EXPECT_TRUE(begins({std::nextafter(0.25, 0), 0, 0}, {0, std::nextafter(torque_Nm, 0), 0}, limits));
}

// A device that exerts torques only.
TEST(SafetyGate, ZeroTorqueBeginsForADeviceWithoutForces) {
  SafetyLimits limits;
  limits.max_force_N = 0;
  EXPECT_FALSE(begins(Vec3::Zero(), {0, 1e-6, 0}, limits));
  EXPECT_TRUE(begins(Vec3::Zero(), Vec3::Zero(), limits));
}

TEST(SafetyGate, ATorqueThatTheDeviceNeverGetsDoesNotKeepItWaiting) {
  SafetyLimits limits;
  limits.max_torque_Nm = 0;
  EXPECT_TRUE(begins(Vec3::Zero(), {0.1, 0, 0}, limits));
}

TEST(SafetyGate, CutsForceAndTorqueToTheirLargestLength) {
  Loop loop;
  loop.engage();
  Wrench out;
  for (int i = 0; i < 100; ++i) out = loop.tick({30, 40, 0}, {3, 0, 4});
  EXPECT_NEAR((out.force_N - Vec3(3, 4, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((out.torque_Nm - Vec3(0.12, 0, 0.16)).norm(), 0, 1e-12);
}

TEST(SafetyGate, ChangesNoFasterThanTheSlewRate) {
  Loop loop;
  loop.engage();
  Vec3 before = Vec3::Zero();
  for (int i = 0; i < 200; ++i) {
    const Vec3 now = loop.tick(i / 7 % 2 == 0 ? Vec3(5, 0, 0) : Vec3(0, -5, 0)).force_N;
    EXPECT_LE((now - before).norm(), loop.limits.force_slew_N_per_s * kTick_s * (1 + 1e-9));
    before = now;
  }
}

TEST(SafetyGate, LatchesOnFaultsUntilRearmed) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (int kind = 0; kind < 7; ++kind) {
    Loop loop;
    loop.engage();
    for (int i = 0; i < 20; ++i) loop.tick({2, 0, 0});
    Vec3 force(2, 0, 0), torque = Vec3::Zero();
    if (kind == 0) loop.fault = {"a fault"};
    if (kind == 1) loop.reading.position_m.x() = none;
    if (kind == 2) loop.reading.orientation.w() = none;
    if (kind == 3) loop.reading.velocity_m_per_s = Vec3(0, 3.1, 0);
    if (kind == 4) loop.reading.angular_velocity_rad_per_s = Vec3(0, 0, 41);
    if (kind == 5) force.y() = none;
    if (kind == 6) torque.z() = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(loop.tick(force, torque).force_N.isZero(0)) << kind;
    EXPECT_EQ(loop.gate.state(), GateState::latched) << kind;
    EXPECT_NE(loop.gate.reason().what, nullptr) << kind;
    loop.fault = {}, loop.reading = {};
    for (int i = 0; i < 1000; ++i) EXPECT_TRUE(loop.tick({0.1, 0, 0}).force_N.isZero(0));
    EXPECT_EQ(loop.gate.state(), GateState::latched) << kind;
    loop.gate.rearm();
    for (int i = 0; i < 600; ++i) loop.tick({0.1, 0, 0});
    EXPECT_EQ(loop.gate.state(), GateState::engaged) << kind;
    EXPECT_NEAR(loop.tick({0.1, 0, 0}).force_N.x(), 0.1, 1e-12) << kind;
  }
}

TEST(SafetyGate, RearmingWhileTheFaultLastsLatchesAgain) {
  Loop loop;
  loop.fault = {"a fault"};
  loop.tick(Vec3::Zero());
  loop.gate.rearm();
  loop.tick(Vec3::Zero());
  EXPECT_EQ(loop.gate.state(), GateState::latched);
}

TEST(SafetyGate, AnOldCommandIsSlewedToNothing) {
  Loop loop;
  loop.engage();
  for (int i = 0; i < 50; ++i) loop.tick({5, 0, 0});
  const double command_time_s = loop.now_s;
  Wrench out;
  int ticks = 0;
  for (; ticks < 100; ++ticks) {
    loop.now_s += kTick_s;
    out = loop.gate.pass(loop.now_s, {}, {}, {{5, 0, 0}, Vec3::Zero()}, command_time_s);
    if (out.force_N.isZero(0)) break;
  }
  EXPECT_GE(ticks, 20);  // not stale before
  EXPECT_LE(ticks, 20 + 10);
  EXPECT_EQ(loop.gate.state(), GateState::waiting);
}

TEST(SafetyGate, BeginsAnewAfterALongPause) {
  Loop loop;
  loop.engage();
  for (int i = 0; i < 50; ++i) loop.tick({5, 0, 0});
  loop.tick({5, 0, 0}, Vec3::Zero(), 0.08);
  EXPECT_EQ(loop.gate.state(), GateState::waiting);
  for (int i = 0; i < 20; ++i) loop.tick({5, 0, 0});
  EXPECT_TRUE(loop.tick({5, 0, 0}).force_N.isZero(0));
}

// The device holds the last command through a pause. The tick after it changes the command by no more than
// the slew rates allow in 2 ms, whether the command has turned round meanwhile or is too old to count.
TEST(SafetyGate, TheTickAfterAPauseMakesNoLargerStep) {
  for (const double gap_s : {0.0005, 0.001, 0.002, 0.003, 0.015, 0.03, 10.0}) {
    Loop loop;
    loop.engage();
    for (int i = 0; i < 50; ++i) loop.tick({5, 0, 0}, {0, 0, 0.2});
    const Wrench after = loop.tick({-5, 0, 0}, {0, 0, -0.2}, gap_s);
    const double slewed_s = std::min(gap_s, 0.002);
    EXPECT_NEAR((after.force_N - Vec3(5 - 1000 * slewed_s, 0, 0)).norm(), 0, 1e-9) << gap_s;
    EXPECT_NEAR((after.torque_Nm - Vec3(0, 0, 0.2 - 40 * slewed_s)).norm(), 0, 1e-9) << gap_s;
  }
}

TEST(SafetyGate, ARestartLeavesNoForce) {
  Loop loop;
  loop.engage();
  for (int i = 0; i < 50; ++i) loop.tick({5, 0, 0});
  loop.gate.restart();
  EXPECT_TRUE(loop.tick({5, 0, 0}).force_N.isZero(0));
  EXPECT_EQ(loop.gate.state(), GateState::waiting);
}

TEST(SafetyLimits, AreCappedByTheDevice) {
  DeviceTraits traits;
  EXPECT_EQ(limits_for({}, traits).max_force_N, SafetyLimits{}.max_force_N);
  traits.max_force_N = 3.3, traits.max_torque_Nm = 0.1;
  EXPECT_NEAR(limits_for({}, traits).max_force_N, 0.9 * 3.3, 1e-12);
  EXPECT_NEAR(limits_for({}, traits).max_torque_Nm, 0.09, 1e-12);
}

// The rule by which a loop that hangs loses its device.

class CountingDevice final : public HapticDevice {
 public:
  using HapticDevice::HapticDevice;
  int release_count = 0;

  DeviceFault read(DeviceReading&) noexcept override { return {}; }
  DeviceFault write(const Wrench&) noexcept override { return {}; }
  void release() noexcept override { ++release_count; }
};

class HeartbeatTest : public testing::Test {
 protected:
  SimulatedClock clock_;
  CountingDevice device_{clock_};
  Heartbeat heartbeat_{device_, 0.01};
};

TEST_F(HeartbeatTest, ExpectsNoBeatBeforeTheFirst) {
  heartbeat_.check(ms(1000));
  EXPECT_EQ(device_.release_count, 0);
}

TEST_F(HeartbeatTest, ReleasesTheDeviceAfterMoreThanItsTime) {
  EXPECT_TRUE(heartbeat_.beat(ms(5)));
  heartbeat_.check(ms(15));
  EXPECT_EQ(device_.release_count, 0);
  heartbeat_.check(ms(15) + 1);
  EXPECT_EQ(device_.release_count, 1);
  EXPECT_EQ(heartbeat_.stalls(), 1);
}

TEST_F(HeartbeatTest, ReleasesOnceAStallAndSaysSoAtTheNextBeat) {
  heartbeat_.beat(0);
  for (int i = 1; i < 100; ++i) heartbeat_.check(ms(i));
  EXPECT_EQ(device_.release_count, 1);
  EXPECT_FALSE(heartbeat_.beat(ms(100)));
  EXPECT_TRUE(heartbeat_.beat(ms(101)));
  for (int i = 102; i < 200; ++i) heartbeat_.check(ms(i));
  EXPECT_EQ(device_.release_count, 2);
  EXPECT_EQ(heartbeat_.stalls(), 2);
}

TEST_F(HeartbeatTest, ExpectsNoBeatAfterTheLast) {
  heartbeat_.beat(0);
  heartbeat_.rest();
  heartbeat_.check(ms(1000));
  EXPECT_EQ(device_.release_count, 0);
}

TEST_F(HeartbeatTest, IsCheckedFiveTimesInItsTime) {
  EXPECT_DOUBLE_EQ(heartbeat_.period_s(), 0.002);
}

}  // namespace
}  // namespace remote_touch::safety_gate_test
