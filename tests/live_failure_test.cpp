// What a haptic device feels when something of a live run fails: a test double of Force Dimension's library
// stands for the device, and its force is taken at the device's side.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <limits>
#include <thread>

#include "runners/live/live_run.h"
#include "runners/live/servo.h"
#include "runners/live/steady_clock.h"
#include "tests/scenes.h"
#include "tests/vendor_devices.h"

namespace remote_touch {
namespace {

constexpr double kPromise_s = 0.02;

const char* const kPress = R"({
  "scenario": {"name": "camera-scene"}, "renderer": {"name": "proxy"},
  "trajectory": {"name": "follow-surface"},
  "safety": {"ramp_s": 0.05}})";

void nap() {
  std::this_thread::sleep_for(std::chrono::microseconds(200));
}

bool wait_until(const std::function<bool()>& is_so) {
  for (const double until_s = steady_s() + 20; steady_s() < until_s; nap())
    if (is_so()) return true;
  return false;
}

// A live run whose device is pressed into the table.
class PressedDevice : public testing::Test {
 protected:
  void SetUp() override {
    const Experiment experiment = Experiment::from_json(kPress, "test");
    height_m_ = experiment.build_scenario(scenes::kernels())->surface_height(0, 0, 0);
    hold(0.03);
    options_.device = "fd:0";
    options_.kernels = &scenes::kernels();
    options_.stop = &stop_;
    options_.duration_s = 60;
    thread_ = std::thread([this] { result_ = run_live(Experiment::from_json(kPress, "test"), options_); });
    // The force begins in free space, and then there is something to feel.
    ASSERT_TRUE(wait_until([&] { return double_->events().size() > 300; }));
    hold(-0.002);
    ASSERT_TRUE(wait_until([&] { return double_->now().force() > 1; })) << "never touched";
  }
  void TearDown() override {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

  // The middle of the device so far above the table; the vendor's z is up.
  void hold(double above_m) {
    double_->set([&](DeviceDouble::State& state) { state.position = {0, 0, height_m_ + above_m}; });
  }
  // From now on until there is no force at the device.
  double time_to_nothing_s() const {
    const double start_s = steady_s();
    while (double_->now().force() > 0 && steady_s() - start_s < 1) nap();
    return steady_s() - start_s;
  }
  const LiveResult& ended() {
    thread_.join();
    return result_;
  }

  DoubleInstalled double_{kForceDimension};
  std::atomic<bool> stop_ = false;
  LiveOptions options_;
  double height_m_ = 0;
  LiveResult result_;
  std::thread thread_;
};

TEST_F(PressedDevice, UnpluggedItHasNoForceAndTheRunEndsSayingSo) {
  double_->set([](DeviceDouble::State& state) { state.is_unplugged = true; });
  const LiveResult& result = ended();
  EXPECT_TRUE(result.failed);
  EXPECT_NE(result.ended.find("the device failed"), std::string::npos) << result.ended;
}

TEST_F(PressedDevice, NoNumberFromItEndsTheForce) {
  double_->set(
      [](DeviceDouble::State& state) { state.position[1] = std::numeric_limits<double>::quiet_NaN(); });
  EXPECT_LT(time_to_nothing_s(), kPromise_s);
  EXPECT_TRUE(ended().failed);
}

TEST_F(PressedDevice, AStopEndsTheForce) {
  stop_ = true;
  EXPECT_LT(time_to_nothing_s(), kPromise_s);
  const LiveResult& result = ended();
  EXPECT_FALSE(result.failed);
  EXPECT_EQ(result.ended, "stopped by a signal");
  EXPECT_FALSE(double_->now().has_motors_on);
}

TEST_F(PressedDevice, AHangingLoopIsLetGoAndComesBackGently) {
  double_->hang_next(DeviceDouble::tells_force);
  ASSERT_TRUE(wait_until([&] { return double_->is_hanging(); }));
  EXPECT_LT(time_to_nothing_s(), kPromise_s);
  std::this_thread::sleep_for(std::chrono::milliseconds(80));
  double_->release();
  const double released_s = steady_s();
  // What hung may still be told; from then on it begins as at the start: pressed in, it waits.
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  for (const DeviceDouble::Event& event : double_->events()) {
    if (event.at_s > released_s + kPromise_s) {
      EXPECT_EQ(event.force(), 0);
    }
  }
  hold(0.03);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  hold(-0.002);
  EXPECT_TRUE(wait_until([&] { return double_->now().force() > 1; })) << "never came back";
  stop_ = true;
  EXPECT_GE(ended().stalls, 1);
}

TEST_F(PressedDevice, TheForceKeepsItsLimitsWhateverTheHandDoes) {
  for (int i = 0; i < 40; ++i) {
    hold(i % 2 == 0 ? -0.2 : 0.03);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  for (const DeviceDouble::Event& event : double_->events())
    EXPECT_LE(event.force(), SafetyLimits{}.largest_force_N * (1 + 1e-9));
}

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
}  // namespace remote_touch
