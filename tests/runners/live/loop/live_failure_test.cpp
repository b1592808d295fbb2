// What a haptic device feels when something of a live run fails: test doubles of the vendors' libraries stand
// for the device, and the force is taken at the device's side.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "runners/live/loop/servo.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/runners/live/loop/background_run.h"
#include "tests/support/test_files.h"

namespace remote_touch::live_failure_test {
namespace {

// A live run whose device is pressed into the table.
class PressedDevice : public testing::TestWithParam<const VendorDevice*> {
 protected:
  void press(const std::function<void(DeviceDouble::State&)>& prepare = {}) {
    double_.reset();
    double_ = std::make_unique<DoubleInstalled>(*GetParam());
    if (prepare) device().set(prepare);
    run_.reset();
    press_in_again();
  }
  void press_in_again() {
    const auto start = [&] { return std::make_unique<BackgroundRun>(kPress, GetParam()->uri); };
    ASSERT_TRUE(
        press_in(run_, start,
                 {[&] { hold(0.03); }, [&] { hold(-kPressed_m); }, [&] { return device().now().force(); }}))
        << "never touched";
  }

  DeviceDouble& device() { return **double_; }
  // The middle of the device so far above the table.
  void hold(double above_m) {
    const Vec3 place = GetParam()->length_per_m * (GetParam()->axes * Vec3(0, height_m_ + above_m, 0));
    device().set([&](DeviceDouble::State& state) { Vec3::Map(state.position.data()) = place; });
  }
  double time_to_nothing_s() {
    return remote_touch::time_to_nothing_s([&] { return device().now().force(); });
  }

  static constexpr double kPressed_m = 0.002;
  const double height_m_ = table_height_m();
  std::unique_ptr<DoubleInstalled> double_;
  std::unique_ptr<BackgroundRun> run_;
};

TEST_P(PressedDevice, UnpluggedTheRunEndsSayingSo) {
  press();
  device().set([](DeviceDouble::State& state) { state.is_unplugged = true; });
  const LiveResult& result = run_->ended();
  EXPECT_TRUE(result.failed);
  EXPECT_HAS(result.ended, "the device failed: ");
}

TEST_P(PressedDevice, AReadingThatFailsEndsTheForceAndTheRun) {
  press();
  device().set([](DeviceDouble::State& state) { state.reading_error = GetParam()->error; });
  EXPECT_LT(time_to_nothing_s(), kPromise_s);
  const LiveResult& result = run_->ended();
  EXPECT_TRUE(result.failed);
  EXPECT_HAS(result.ended, "the device failed: ");
}

TEST_P(PressedDevice, NoNumberFromItEndsTheForce) {
  press();
  device().set(
      [](DeviceDouble::State& state) { state.position[1] = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_LT(time_to_nothing_s(), kPromise_s);
  EXPECT_TRUE(run_->ended().failed);
}

TEST_P(PressedDevice, AStopEndsTheForce) {
  press();
  run_->stop();
  EXPECT_LT(time_to_nothing_s(), kPromise_s);
  const LiveResult& result = run_->ended();
  EXPECT_FALSE(result.failed);
  EXPECT_EQ(result.ended, "stopped by a signal");
  EXPECT_FALSE(device().now().has_motors_on);
}

TEST_P(PressedDevice, AHangingLoopIsLetGoAndComesBackGently) {
  press();
  device().hang_next(DeviceDouble::reports_force);
  ASSERT_TRUE(wait_until([&] { return device().is_hanging(); }));
  EXPECT_LT(time_to_nothing_s(), kPromise_s);
  std::this_thread::sleep_for(std::chrono::milliseconds(80));
  device().release();
  const double released_s = steady_s();
  // What hung may still be told; from then on it begins as at the start: pressed in, it waits.
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  for (const DeviceDouble::Event& event : device().events()) {
    if (event.at_s > released_s + kPromise_s) {
      EXPECT_EQ(event.force(), 0);
    }
  }
  press_in_again();
  EXPECT_GE(run_->ended_by_stop().counts.stalls, 1);
}

TEST_P(PressedDevice, TheForceKeepsItsLimitsWhateverTheHandDoes) {
  press();
  for (int i = 0; i < 40; ++i) {
    hold(i % 2 == 0 ? -0.2 : 0.03);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  for (const DeviceDouble::Event& event : device().events())
    EXPECT_LE(event.force(), SafetyLimits{}.max_force_N * (1 + 1e-9));
}

INSTANTIATE_TEST_SUITE_P(Vendors, PressedDevice, testing::Values(&kForceDimension, &kOpenHaptics, &kEntact),
                         [](const auto& device) { return device.param->name; });

// OpenHaptics alone tells how stiff a device can be.
using StiffnessOfADevice = PressedDevice;

TEST_P(StiffnessOfADevice, IsNotExceeded) {
  const auto max_rendered_N = [](const LiveResult& result) {
    double max = 0;
    const Trace& trace = result.log.trace;
    for (std::size_t i = 0; i < trace.length(); ++i) max = std::max(max, trace.force_N[i].norm());
    return max;
  };
  const auto rendered_at_last_N = [](const LiveResult& result) {
    const Trace& trace = result.log.trace;
    return trace.force_N[trace.length() - 1].norm();
  };
  // At the device, once its force no longer rises; none where the machine has paused meanwhile.
  const auto resting_N = [&] {
    double force_N = 0;
    wait_until([&] {
      press_in_again();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      return (force_N = device().now().force()) > 0;
    });
    return force_N;
  };
  press();
  const double whole_N = resting_N();
  const LiveResult whole = run_->ended_by_stop();
  EXPECT_EQ(whole.force_scale, 1);
  EXPECT_EQ(run_->told().find("N/m"), std::string::npos);
  EXPECT_NEAR(whole_N, rendered_at_last_N(whole), 0.01 * whole_N);

  constexpr double kLimit_N_per_m = 300, kRendered_N_per_m = 600;
  press([&](DeviceDouble::State& state) { state.max_stiffness = kLimit_N_per_m / 1000; });  // N/mm
  const double limited_N = resting_N();
  const LiveResult limited = run_->ended_by_stop();
  EXPECT_EQ(limited.force_scale, kLimit_N_per_m / kRendered_N_per_m);
  EXPECT_HAS(run_->told(),
             "the maximum stiffness of the device is 300 N/m: forces and torques are scaled by 0.5");
  EXPECT_NEAR(limited_N, 0.5 * rendered_at_last_N(limited), 0.01 * limited_N);
  EXPECT_LT(limited.log.max_force_N, 0.5 * max_rendered_N(limited) * (1 + 1e-9));
}

INSTANTIATE_TEST_SUITE_P(Vendors, StiffnessOfADevice, testing::Values(&kOpenHaptics),
                         [](const auto& device) { return device.param->name; });

// --- a renderer that throws, against its contract ---

class Throwing final : public Renderer {
 public:
  void on_frame(const Frame&) override {}
  RenderOutput step(const DeviceState&, double time_s) override {
    if (time_s > 0.05) throw std::bad_alloc();
    return {};
  }
};

TEST(ServoTick, AnExceptionLetsTheDeviceGo) {
  DoubleInstalled device_double(kForceDimension);
  const auto device = kForceDimension.open("");
  Throwing renderer;
  TripleBuffer<LiveFrame> frames;
  Ring<LiveTick> rows(1000);
  const std::atomic<bool> stop = false;
  Servo servo({*device, renderer, frames, rows, stop}, DevicePlacement({}), {}, 1000, steady_s(), 0.01);
  device->run(servo);  // ends by itself
  EXPECT_TRUE(servo.has_failed());
  EXPECT_STREQ(servo.trouble(), "an exception in the haptic loop");
  EXPECT_FALSE(device_double->now().has_motors_on);
}

}  // namespace
}  // namespace remote_touch::live_failure_test
