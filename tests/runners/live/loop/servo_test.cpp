// The tick of the live loop by itself, with a device that a test scripts.
#include "runners/live/loop/servo.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <thread>
#include <vector>

#include "runners/live/timing/steady_clock.h"

namespace remote_touch::servo_test {
namespace {

constexpr double kRate_hz = 1000, kStall_s = 0.01;

void sleep_ms(int ms) {
  std::this_thread::sleep_for(std::chrono::milliseconds(ms));
}

// Ticks without a pause, until it is told to stop or has done so many.
class ScriptedDevice final : public HapticDevice {
 public:
  std::function<DeviceFault()> on_read, on_write;
  int max_ticks = 100;
  int held_again = 0;

  const DeviceTraits& traits() const override { return traits_; }
  void run(DeviceCycle& cycle) override {
    for (int i = 0; i < max_ticks && cycle.tick(); ++i) {
    }
  }
  DeviceFault read(DeviceReading&) noexcept override { return on_read ? on_read() : DeviceFault{}; }
  DeviceFault write(const Wrench&) noexcept override { return on_write ? on_write() : DeviceFault{}; }
  void release() noexcept override { ++times_released_; }
  int release_count() const { return times_released_; }
  bool rearm() noexcept override {
    ++held_again;
    return true;
  }

 private:
  DeviceTraits traits_;
  std::atomic<int> times_released_ = 0;  // by the heartbeat's thread too
};

class CountingRenderer final : public Renderer {
 public:
  int max_steps = 1 << 30, steps = 0;
  void on_frame(const Frame&) override {}
  RenderOutput step(const DeviceState&, double) override {
    if (++steps > max_steps) throw std::bad_alloc();
    return {};
  }
};

class ServoTest : public testing::Test {
 protected:
  void run(double ends_s = std::numeric_limits<double>::infinity()) {
    servo_ = std::make_unique<Servo>(ServoLinks{device_, renderer_, frames_, rows_, stop_, &signal_, ends_s},
                                     DevicePlacement({}), SafetyLimits{}, kRate_hz, start_s_, kStall_s);
    device_.run(*servo_);
  }
  std::vector<LiveTick> rows() {
    std::vector<LiveTick> rows;
    for (; const LiveTick* row = rows_.oldest(); rows_.pop()) rows.push_back(*row);
    return rows;
  }

  const double start_s_ = steady_s();
  ScriptedDevice device_;
  CountingRenderer renderer_;
  TripleBuffer<LiveFrame> frames_;
  Ring<LiveTick> rows_{1 << 10};
  std::atomic<bool> stop_ = false, signal_ = false;
  std::unique_ptr<Servo> servo_;
};

// A recording of it would not be the same run again.
TEST_F(ServoTest, ATickThatHungWhileTheDeviceWasReadIsNotBeforeTheFrameItTakes) {
  double captured_s = 0;
  device_.max_ticks = 5;
  device_.on_read = [&, calls = 0]() mutable {
    if (++calls != 3) return DeviceFault{};
    sleep_ms(30);
    captured_s = frames_.back().frame.captured_s = steady_s() - start_s_;
    frames_.publish();
    return DeviceFault{};
  };
  run();
  const std::vector<LiveTick> ticks = rows();
  ASSERT_EQ(ticks.size(), 5u);
  ASSERT_GE(ticks[2].taken, 0);
  EXPECT_GE(static_cast<double>(ticks[2].number) / kRate_hz, captured_s);
  for (std::size_t i = 1; i < ticks.size(); ++i) EXPECT_GT(ticks[i].number, ticks[i - 1].number);
}

TEST_F(ServoTest, AnEndIsNoStall) {
  device_.on_read = [&, calls = 0]() mutable {
    stop_ = ++calls == 50;
    return DeviceFault{};
  };
  run();
  sleep_ms(50);
  EXPECT_EQ(servo_->stalls(), 0);
}

TEST_F(ServoTest, AHangingReadIsAStallAndTheNextTickHoldsAgain) {
  device_.max_ticks = 5;
  device_.on_read = [calls = 0]() mutable {
    if (++calls == 3) sleep_ms(60);
    return DeviceFault{};
  };
  run();
  EXPECT_EQ(servo_->stalls(), 1);
  EXPECT_EQ(device_.held_again, 1);
}

TEST_F(ServoTest, ADeviceThatRefusedAForceIsNotHeldAgain) {
  device_.on_write = [calls = 0]() mutable {
    if (++calls != 3) return DeviceFault{};
    sleep_ms(60);  // long enough for the heartbeat to let go
    return DeviceFault{"refused"};
  };
  run();
  EXPECT_TRUE(servo_->has_failed());
  EXPECT_TRUE(servo_->is_latched());
  EXPECT_EQ(device_.held_again, 0);
}

// By what a fault says, not by where the text is: an adapter in a library of its own has its own copy.
TEST_F(ServoTest, ADeviceThatSaysItWasReleasedHasNotFailed) {
  const std::string said = kReleased.what;
  device_.on_read = [&, calls = 0]() mutable {
    return ++calls == 3 ? DeviceFault{said.c_str()} : DeviceFault{};
  };
  run();
  EXPECT_FALSE(servo_->has_failed());
  EXPECT_FALSE(servo_->is_latched());
  EXPECT_EQ(rows().size(), 100u);
}

// The thread that waits for the loop may be held up.
TEST_F(ServoTest, ASignalOrTheEndOfTheTimeEndsIt) {
  device_.on_read = [&, calls = 0]() mutable {
    if (++calls == 3) signal_ = true;
    return DeviceFault{};
  };
  run();
  EXPECT_EQ(rows().size(), 3u);
  EXPECT_GE(device_.release_count(), 1);
  signal_ = false;
  run(steady_s() - 1);
  EXPECT_EQ(rows().size(), 0u);
}

TEST_F(ServoTest, AnExceptionLetsTheDeviceGo) {
  renderer_.max_steps = 50;
  run();
  EXPECT_EQ(renderer_.steps, 51);
  EXPECT_TRUE(servo_->has_failed());
  EXPECT_STREQ(servo_->trouble(), "an exception in the haptic loop");
  EXPECT_GE(device_.release_count(), 1);
}

}  // namespace
}  // namespace remote_touch::servo_test
