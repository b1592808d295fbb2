// The force of every adapter of a vendor's library, with test doubles: when it is off and how it ends.
#include <gtest/gtest.h>

#include <thread>

#include "tests/doubles/vendor_devices.h"

namespace remote_touch::release_test {
namespace {

const Wrench kPush = {Vec3(1, 2, 3), Vec3::Zero()};

using Vendors = testing::TestWithParam<const VendorDevice*>;

// The device runs on a simulated clock.
class Release : public Vendors {
 protected:
  const VendorDevice& vendor() const { return *GetParam(); }
  std::unique_ptr<HapticDevice> open() { return vendor().open("", clock_); }

  // Greatest force that the hand feels from a moment on.
  double max_force_from(std::int64_t start_ns) const {
    double max = double_->now().force();
    for (const DeviceDouble::Event& event : double_->events())
      if (event.at_ns > start_ns) max = std::max(max, event.force());
    return max;
  }
  // Releases the device at that moment, beside the ticks, and stores the time when the release is done. No
  // force may follow.
  void release_at(HapticDevice& device, double moment_s) {
    clock_.at(moment_s, [&] {
      EXPECT_GT(double_->now().force(), 0);
      device.release();
      EXPECT_EQ(double_->now().force(), 0);
      released_ns_ = clock_.now_ns();
    });
  }

  SimulatedClock clock_;
  DoubleInstalled double_{vendor(), &clock_};
  std::int64_t released_ns_ = 0;
};

TEST_P(Release, ThereIsNoForceBeforeTheFirstWrite) {
  const auto device = open();
  EXPECT_TRUE(double_->is_open());
  EXPECT_FALSE(double_->now().has_motors_on);
  run_ticks(*device, 3, [&](int) {
    DeviceReading reading;
    device->read(reading);
  });
  EXPECT_EQ(double_->now().has_motors_on, vendor().has_motors_on_to_read);
  for (const DeviceDouble::Event& event : double_->events()) EXPECT_EQ(event.force(), 0);
  run_ticks(*device, 3, [&](int) { EXPECT_FALSE(device->write(kPush)); });
  EXPECT_TRUE(double_->now().has_motors_on);
  EXPECT_EQ(sent_forces(*double_).size(), 1u);
}

TEST_P(Release, MotorsThatDoNotSwitchOnAreAFault) {
  const auto device = open();
  double_->set(&DeviceDouble::State::switching_error, vendor().error);
  run_ticks(*device, 3, [&](int) {
    const DeviceFault fault = device->write(kPush);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault.code, vendor().fault_code);
  });
  EXPECT_FALSE(double_->now().has_motors_on);
  EXPECT_EQ(double_->now().force(), 0);
}

// A tick that hangs between two calls of the vendor's library does not delay the release. A call in progress
// may end, and has 5 ms for it. If it ends later, it sends its force while the motors are off, and the hand
// feels none. OpenHaptics sends a force at the end of its frame, after the call of the tick, so the release
// does not wait.
TEST_P(Release, IsImmediateAndNeedsFiveMillisecondsOnlyWhileTheVendorsCallHangs) {
  for (const bool is_in_call : {false, true}) {
    double_->reset();
    const auto device = open();
    const double start_s = clock_.now_s();
    release_at(*device, start_s + 0.0205);
    clock_.at(start_s + 0.1, [&] { double_->release(); });
    DeviceFault last;
    run_ticks(*device, 40, [&](int i) {
      DeviceReading reading;
      device->read(reading);
      if (i == 20 && is_in_call) double_->hang_next(DeviceDouble::write_force);
      if (i == 20 && !is_in_call) clock_.sleep_s(0.1);
      last = device->write(kPush);
    });
    EXPECT_NEAR(1e-9 * static_cast<double>(released_ns_) - start_s,
                is_in_call && !vendor().drives_itself ? 0.0255 : 0.0205, 1e-9);
    EXPECT_EQ(max_force_from(released_ns_), 0);
    EXPECT_TRUE(last) << "a write after letting go";
  }
}

// The call that hangs switches the motors on in the end, after they were switched off.
TEST_P(Release, LeavesTheMotorsOffIfTheyWereBeingSwitchedOn) {
  double_->hang_next(DeviceDouble::switch_on);
  const auto device = open();
  clock_.at(0.005, [&] { device->release(); });
  clock_.at(0.1, [&] { double_->release(); });
  DeviceFault last;
  run_ticks(*device, 10, [&](int) { last = TickOnce(*device, kPush).written; });
  EXPECT_TRUE(last) << "a write after letting go";
  EXPECT_FALSE(double_->now().has_motors_on);
  EXPECT_TRUE(sent_forces(*double_).empty());
}

TEST_P(Release, HoldsAgainAsAtTheStart) {
  const auto device = open();
  device->release();
  device->release();
  run_ticks(*device, 3, [&](int) { EXPECT_TRUE(TickOnce(*device, kPush).written) << "the first write"; });
  EXPECT_TRUE(sent_forces(*double_).empty());
  EXPECT_FALSE(double_->now().has_motors_on);
  EXPECT_TRUE(device->rearm());
  run_ticks(*device, 9, [&](int i) {
    if (i == 3) device->release();
    if (i == 6) {
      EXPECT_TRUE(device->rearm());
      EXPECT_EQ(double_->now().force(), 0);
    }
    EXPECT_EQ(bool(TickOnce(*device, kPush).written), i >= 3 && i < 6) << i;
  });
  EXPECT_TRUE(double_->now().has_motors_on);
}

TEST_P(Release, ClosesWithoutForce) {
  {
    const auto device = open();
    run_ticks(*device, 3, [&](int) { device->write({Vec3(1, 0, 0), Vec3(0, 1, 0)}); });
    EXPECT_TRUE(double_->now().has_motors_on);
  }
  EXPECT_FALSE(double_->now().has_motors_on);
  EXPECT_EQ(double_->now().sent, (std::array<double, 6>{}));
  EXPECT_FALSE(double_->is_open());
}

// --- with threads: nothing here depends on how long anything takes ---

using ReleaseBesideTicks = Vendors;

// Reads and pushes in a thread of its own until it is stopped.
class Pushing {
 public:
  explicit Pushing(HapticDevice& device)
      : thread_([this, &device] {
          device.run([this, &device] {
            TickOnce(device, kPush);
            ++ticks_;
            return !stops_;
          });
        }) {}
  ~Pushing() { stop(); }
  Pushing(const Pushing&) = delete;
  Pushing& operator=(const Pushing&) = delete;

  void wait_for(int more) const {
    for (const int before = ticks_; ticks_ < before + more;) std::this_thread::yield();
  }
  void stop() {
    stops_ = true;
    if (thread_.joinable()) thread_.join();
  }

 private:
  std::atomic<bool> stops_{false};
  std::atomic<int> ticks_{0};
  std::thread thread_;
};

TEST_P(ReleaseBesideTicks, EndsTheForceAtAnyTimeFromAnyThread) {
  const DoubleInstalled behind(*GetParam());
  for (int delay_us = 0; delay_us < 2500; delay_us += 50) {
    behind->reset();
    const auto device = GetParam()->open("", steady_clock());
    Pushing pushing(*device);
    std::this_thread::sleep_for(std::chrono::microseconds(delay_us));
    std::thread other([&] { device->release(); });
    device->release();
    other.join();
    pushing.wait_for(2);
    EXPECT_EQ(behind->now().force(), 0) << delay_us;
    EXPECT_FALSE(behind->now().has_motors_on) << delay_us;
    pushing.stop();
    EXPECT_FALSE(behind->now().has_motors_on) << delay_us;
  }
}

INSTANTIATE_TEST_SUITE_P(Vendors, Release, kVendors, vendor_name);
INSTANTIATE_TEST_SUITE_P(Vendors, ReleaseBesideTicks, kVendors, vendor_name);

}  // namespace
}  // namespace remote_touch::release_test
