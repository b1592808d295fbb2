// The safety gate before every write to a device, and the watch over the loop.
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

// Both lengths must be below their thresholds. That of the torque is 0.3 / 5 of its limit, 12 mN m. The exact
// limits have thresholds that are exact in binary: 0.25 N, and 0.25 / 4 of 0.5 N m. A torque that a device
// never gets does not keep it waiting.
TEST(SafetyGate, ForceAndTorqueMustBothBeShorterThanTheirThresholds) {
  SafetyLimits exact, no_force, no_torque;
  exact.engage_force_N = 0.25, exact.max_force_N = 4, exact.max_torque_Nm = 0.5;
  no_force.max_force_N = 0, no_torque.max_torque_Nm = 0;
  const double force_N = std::nextafter(0.25, 0), torque_Nm = std::nextafter(0.03125, 0);
  const Vec3 none = Vec3::Zero();
  struct Case {
    bool begins;
    Vec3 force_N, torque_Nm;
    SafetyLimits limits = {};
  };
  for (const Case& each :
       {Case{true, {0.299, 0, 0}, {0, -0.0119, 0}}, Case{false, {0.3, 0, 0}, none},
        Case{false, {0, -0.301, 0}, none}, Case{false, {0.2, -0.2, 0.2}, none},
        Case{false, none, {0, -0.0121, 0}}, Case{false, none, {0.1, 0, 0}},
        Case{false, none, {0.008, -0.008, 0.008}}, Case{false, {0.25, 0, 0}, none, exact},
        Case{false, none, {0, 0.03125, 0}, exact}, Case{true, {force_N, 0, 0}, {0, torque_Nm, 0}, exact},
        Case{false, none, {0, 1e-6, 0}, no_force}, Case{true, none, none, no_force},
        Case{true, none, {0.1, 0, 0}, no_torque}}) {
    Loop loop(each.limits);
    const Wrench out = loop.tick(each.force_N, each.torque_Nm);
    EXPECT_TRUE(out.force_N.isZero(0) && out.torque_Nm.isZero(0));
    EXPECT_EQ(loop.gate.state(), each.begins ? GateState::ramping : GateState::waiting)
        << each.force_N.transpose() << " N, " << each.torque_Nm.transpose() << " N m";
  }
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
  const double none = std::numeric_limits<double>::quiet_NaN(), infinite = HUGE_VAL;
  struct Trouble {
    DeviceFault fault;
    DeviceReading reading;
    Vec3 force_N = {2, 0, 0}, torque_Nm = Vec3::Zero();
  };
  Trouble all[7];
  all[0].fault = {"a fault"};
  all[1].reading.position_m.x() = none;
  all[2].reading.orientation.w() = none;
  all[3].reading.velocity_m_per_s = Vec3(0, 3.1, 0);
  all[4].reading.angular_velocity_rad_per_s = Vec3(0, 0, 41);
  all[5].force_N.y() = none, all[6].torque_Nm.z() = infinite;
  for (const Trouble& trouble : all) {
    SCOPED_TRACE(&trouble - all);
    Loop loop;
    loop.engage();
    for (int i = 0; i < 20; ++i) loop.tick({2, 0, 0});
    for (int times = 0; times < 2; ++times) {  // re-arming while the fault lasts latches again
      loop.fault = trouble.fault, loop.reading = trouble.reading;
      EXPECT_TRUE(loop.tick(trouble.force_N, trouble.torque_Nm).force_N.isZero(0));
      EXPECT_EQ(loop.gate.state(), GateState::latched);
      EXPECT_NE(loop.gate.reason().what, nullptr);
      if (times == 0) loop.gate.rearm();
    }
    loop.fault = {}, loop.reading = {};
    for (int i = 0; i < 1000; ++i) EXPECT_TRUE(loop.tick({0.1, 0, 0}).force_N.isZero(0));
    EXPECT_EQ(loop.gate.state(), GateState::latched);
    loop.gate.rearm();
    for (int i = 0; i < 600; ++i) loop.tick({0.1, 0, 0});
    EXPECT_EQ(loop.gate.state(), GateState::engaged);
    EXPECT_NEAR(loop.tick({0.1, 0, 0}).force_N.x(), 0.1, 1e-12);
  }
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

// The device holds the last command through a pause. The tick after it changes the command by no more than
// the slew rates allow in 2 ms, whether the command has turned round meanwhile or is too old to count. The
// force begins anew after a long pause, and after a restart.
TEST(SafetyGate, TheTickAfterAPauseMakesNoLargerStep) {
  for (const double gap_s : {0.0005, 0.001, 0.002, 0.003, 0.015, 0.03, 10.0}) {
    SCOPED_TRACE(gap_s);
    Loop loop;
    loop.engage();
    for (int i = 0; i < 50; ++i) loop.tick({5, 0, 0}, {0, 0, 0.2});
    const Wrench after = loop.tick({-5, 0, 0}, {0, 0, -0.2}, gap_s);
    const double slewed_s = std::min(gap_s, 0.002);
    EXPECT_NEAR((after.force_N - Vec3(5 - 1000 * slewed_s, 0, 0)).norm(), 0, 1e-9);
    EXPECT_NEAR((after.torque_Nm - Vec3(0, 0, 0.2 - 40 * slewed_s)).norm(), 0, 1e-9);
    if (gap_s < 0.02) loop.gate.restart();
    for (int i = 0; i < 20; ++i) loop.tick({5, 0, 0});
    EXPECT_EQ(loop.gate.state(), GateState::waiting);
    EXPECT_TRUE(loop.tick({5, 0, 0}).force_N.isZero(0));
  }
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

TEST_F(HeartbeatTest, ReleasesOnceAfterMoreThanItsTimeAndSaysSoAtTheNextBeat) {
  heartbeat_.check(ms(1000));  // no beat is expected before the first
  EXPECT_EQ(device_.release_count, 0);
  EXPECT_TRUE(heartbeat_.beat(ms(1005)));
  heartbeat_.check(ms(1015));
  EXPECT_EQ(device_.release_count, 0);
  heartbeat_.check(ms(1015) + 1);
  EXPECT_EQ(device_.release_count, 1);
  for (int i = 1016; i < 1100; ++i) heartbeat_.check(ms(i));
  EXPECT_EQ(device_.release_count, 1);
  EXPECT_FALSE(heartbeat_.beat(ms(1100)));
  EXPECT_TRUE(heartbeat_.beat(ms(1101)));
  for (int i = 1102; i < 1200; ++i) heartbeat_.check(ms(i));
  EXPECT_EQ(device_.release_count, 2);
  EXPECT_EQ(heartbeat_.stalls(), 2);
  heartbeat_.beat(ms(1200));
  heartbeat_.rest();  // nor after the last
  heartbeat_.check(ms(3000));
  EXPECT_EQ(device_.release_count, 2);
}

}  // namespace
}  // namespace remote_touch::safety_gate_test
