// Force at a haptic device when a part of a live run fails. Test doubles replace the vendors' libraries, the
// force is measured at the device's side, and all times are those of a simulated clock.
#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "tests/runners/live/loop/simulated_run.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_failure_test {
namespace {

// A live run whose device is pressed into the table until the moment of trouble and after it.
class PressedDevice : public testing::TestWithParam<const VendorDevice*> {
 protected:
  static constexpr double kTrouble_s = 0.3;

  void SetUp() override {
    hold(kAbove_m);
    clock_.at(kPressed_s, [&] { hold(kBelow_m); });
  }
  LiveResult run(double duration_s = 0.5) {
    run_.options.duration_s = duration_s;
    return run_.run();
  }
  void at(double moment_s, std::function<void(DeviceDouble&)> what) {
    clock_.at(moment_s, [this, what = std::move(what)] { what(*double_); });
  }
  // Puts the centre of the device this far above the table.
  void hold(double above_m) { put(*double_, *GetParam(), {0, height_m_ + above_m, 0}); }
  ForceOverTime force() const { return force_of(*double_); }
  // Checks that the hand is pressed until then, and that there is no force from then on.
  void expect_gone_at(std::int64_t moment_ns) const {
    EXPECT_EQ(force().force_end_ns(), moment_ns);
    EXPECT_GT(force().at(moment_ns - 1), 1);
  }

  SimulatedClock clock_;
  DoubleInstalled double_{*GetParam(), &clock_};
  const double height_m_ = table_height_m();
  SimulatedRun run_{clock_, press_experiment(),
                    [](const Experiment&, Clock& clock) { return GetParam()->open("", clock); }};
};

// The user's part of the run would see the stop or the end at 310 ms: the loop checks them itself, because
// that part may be held up.
TEST_P(PressedDevice, AStopEndsTheForceInTheNextTick) {
  std::atomic<bool> stop = false;
  run_.options.stop = &stop;
  clock_.at(0.303, [&] { stop = true; });
  const LiveResult result = run();
  expect_gone_at(ms(303));
  EXPECT_FALSE(result.failed);
  EXPECT_EQ(result.ended, "stopped by a signal");
  EXPECT_FALSE(double_->now().has_motors_on);
}

TEST_P(PressedDevice, TheEndOfItsDurationEndsTheForceInTheNextTick) {
  const LiveResult result = run(0.303);
  expect_gone_at(ms(303));
  EXPECT_EQ(result.ended, "its duration has elapsed");
  EXPECT_EQ(result.log.missed_ticks, 0);
  EXPECT_EQ(result.log.trace.length(), 303u);
}

// The tick of 300 ms hangs in the vendor's call. The watch checks every 2 ms and finds more than 10 ms at 312
// ms. A call of the adapter is given 5 ms to end, but the call of OpenHaptics' scheduler is no such call.
// Then the motors are off. The call that hung continues at 380 ms. The force then begins as at the start: it
// waits while the hand is pressed in.
TEST_P(PressedDevice, AHangingLoopIsReleasedAndTheForceBeginsGently) {
  at(kTrouble_s, [](DeviceDouble& device) { device.hang_next(DeviceDouble::write_force); });
  at(0.38, [](DeviceDouble& device) { device.release(); });
  clock_.at(0.5, [&] { hold(kAbove_m); });
  clock_.at(0.6, [&] { hold(kBelow_m); });
  const LiveResult result = run(0.8);
  const std::int64_t off_ns = ms(GetParam()->drives_itself ? 312 : 317);
  EXPECT_GT(force().at(off_ns - 1), 1);
  EXPECT_EQ(force().max_in(off_ns, ms(600)), 0);
  EXPECT_GT(force().at(ms(700)), 1);
  EXPECT_EQ(result.counts.stalls, 1);
  EXPECT_FALSE(result.failed);
}

// The watch releases the device by 317 ms. The user's part sees this at 320 ms and reports it when it has
// lasted for more than 0.2 s.
TEST_P(PressedDevice, ALongHangIsReportedWhileItLasts) {
  at(kTrouble_s, [](DeviceDouble& device) { device.hang_next(DeviceDouble::write_force); });
  at(0.7, [](DeviceDouble& device) { device.release(); });
  run(0.8);
  ASSERT_EQ(run_.reported().size(), 2u);
  EXPECT_EQ(run_.reported()[0].line, "force is off: the haptic loop hangs, and the device was released");
  EXPECT_EQ(run_.reported()[0].at_ns, ms(530));
  EXPECT_EQ(run_.reported()[1].line, "re-armed: the force starts again when the hand is in free space");
}

TEST_P(PressedDevice, TheForceKeepsItsLimitsWhateverTheHandDoes) {
  for (int i = 0; i < 40; ++i)
    clock_.at(kTrouble_s + 0.01 * i, [this, i] { hold(i % 2 == 0 ? -0.2 : kAbove_m); });
  run(kTrouble_s + 0.45);
  const auto pieces = force().pieces;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    EXPECT_LE(pieces[i].force_N, SafetyLimits{}.max_force_N * (1 + 1e-9));
    EXPECT_LE(std::abs(pieces[i].force_N - pieces[i - 1].force_N),
              SafetyLimits{}.force_slew_N_per_s * 1e-3 * (1 + 1e-9));
  }
  EXPECT_DOUBLE_EQ(force().max_in(ms(300), ms(700)), SafetyLimits{}.max_force_N);
}

INSTANTIATE_TEST_SUITE_P(Vendors, PressedDevice, kVendors, vendor_name);

// OpenHaptics alone reports how stiff a device can be.
class StiffnessOfADevice : public PressedDevice {};

TEST_P(StiffnessOfADevice, IsNotExceeded) {
  constexpr double kLimit_N_per_m = 300, kRendered_N_per_m = 600;
  double_->set([](DeviceDouble::State& state) { state.max_stiffness = kLimit_N_per_m / 1000; });  // N/mm
  const LiveResult result = run();
  EXPECT_EQ(result.force_scale, kLimit_N_per_m / kRendered_N_per_m);
  ASSERT_EQ(run_.reported().size(), 1u);
  EXPECT_HAS(run_.reported()[0].line,
             "the maximum stiffness of the device is 300 N/m: forces and torques are scaled by 0.5");
  EXPECT_NEAR(force().at(ms(499)), 0.5 * result.log.trace.force_N.back().norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Vendors, StiffnessOfADevice, testing::Values(&kOpenHaptics), vendor_name);

// An adapter, or its vendor's library, that stops calling ticks.
class DeviceThatLeaves final : public HapticDevice {
 public:
  using HapticDevice::HapticDevice;
  void run(const DeviceTick& tick) override {
    for (int i = 0; i < 50 && tick(); ++i) clock().sleep_s(1e-3);
  }
  DeviceFault read(DeviceReading&) noexcept override { return {}; }
  DeviceFault write(const Wrench&) noexcept override { return {}; }
  void release() noexcept override {}
};

TEST(DeviceLoop, EndsTheRunIfItEndsByItself) {
  SimulatedClock clock;
  SimulatedRun run(clock, press_experiment(), [](const Experiment&, Clock& of_device) {
    return std::make_unique<DeviceThatLeaves>(of_device);
  });
  run.options.duration_s = 1;
  const LiveResult result = run.run();
  EXPECT_EQ(result.ended, "the device's loop ended by itself");
  EXPECT_TRUE(result.failed);
  EXPECT_EQ(clock.now_ns(), ms(50));
}

}  // namespace
}  // namespace remote_touch::live_failure_test
