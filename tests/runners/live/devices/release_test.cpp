// The force of every adapter of a vendor's library: when it is off and how it goes, each with its test
// double.
#include <gtest/gtest.h>

#include <thread>

#include "tests/doubles/vendor_devices.h"

namespace remote_touch::release_test {
namespace {

void nap() {
  std::this_thread::sleep_for(std::chrono::microseconds(200));
}

class LettingGo : public testing::TestWithParam<const VendorDevice*> {
 protected:
  const VendorDevice& vendor() const { return *GetParam(); }
  std::unique_ptr<HapticDevice> open() const { return vendor().open(""); }

  // At the hand, from a moment on.
  double max_force_from(double start_s) const {
    double max = double_->now().force();
    for (const DeviceDouble::Event& event : double_->events())
      if (event.at_s > start_s) max = std::max(max, event.force());
    return max;
  }
  // How long the device takes to have no force, and then none.
  double time_to_release(HapticDevice& device) const {
    const double start_s = steady_s();
    device.release();
    EXPECT_EQ(double_->now().force(), 0);
    return steady_s() - start_s;
  }

  DoubleInstalled double_{vendor()};
};

// Reads and pushes in a thread of its own until it is told to stop.
class Pushing {
 public:
  explicit Pushing(HapticDevice& device)
      : cycle_([this, &device] {
          DeviceReading reading;
          device.read(reading);
          while (hangs_) nap();
          last_ = bool(device.write({Vec3(1, 2, 3), Vec3::Zero()}));
          ++ticks_;
          return !stops_;
        }),
        thread_([this, &device] { device.run(cycle_); }) {}
  ~Pushing() { stop(); }
  Pushing(const Pushing&) = delete;
  Pushing& operator=(const Pushing&) = delete;

  void wait_for(int more) const {
    for (const int before = ticks_; ticks_ < before + more;) nap();
  }
  void hang(bool hangs) { hangs_ = hangs; }
  // Whether the last write was a fault.
  bool stop() {
    stops_ = true, hangs_ = false;
    if (thread_.joinable()) thread_.join();
    return last_;
  }

 private:
  std::atomic<bool> stops_{false}, hangs_{false}, last_{false};
  std::atomic<int> ticks_{0};
  CallCycle cycle_;
  std::thread thread_;
};

TEST_P(LettingGo, NoForceBeforeTheFirstWrite) {
  const auto device = open();
  EXPECT_TRUE(double_->is_open());
  EXPECT_FALSE(double_->now().has_motors_on);
  run_ticks(*device, 3, [&](int) {
    DeviceReading reading;
    device->read(reading);
  });
  EXPECT_EQ(double_->now().has_motors_on, vendor().has_motors_on_to_read);
  for (const DeviceDouble::Event& event : double_->events()) EXPECT_EQ(event.force(), 0);
  run_ticks(*device, 3, [&](int) { EXPECT_FALSE(device->write({Vec3(1, 0, 0), Vec3::Zero()})); });
  EXPECT_TRUE(double_->now().has_motors_on);
  EXPECT_EQ(sent_forces(*double_).size(), 1u);
}

TEST_P(LettingGo, MotorsThatDoNotSwitchOnAreAFault) {
  const auto device = open();
  double_->set([&](DeviceDouble::State& state) { state.switching_error = vendor().error; });
  run_ticks(*device, 3, [&](int) {
    const DeviceFault fault = device->write({Vec3(1, 0, 0), Vec3::Zero()});
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault.code, vendor().sent_error);
  });
  EXPECT_FALSE(double_->now().has_motors_on);
  EXPECT_EQ(double_->now().force(), 0);
}

// Within 20 ms; the best of a few tries, since the machine may be busy.
TEST_P(LettingGo, WhileATickHangs) {
  double shortest_s = 1;
  for (int attempt = 0; attempt < 5 && shortest_s > 0.02; ++attempt) {
    double_->reset();
    const auto device = open();
    Pushing pushing(*device);
    pushing.wait_for(5);
    pushing.hang(true);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_GT(double_->now().force(), 0);
    const double start_s = steady_s();
    shortest_s = time_to_release(*device);
    pushing.hang(false);
    pushing.wait_for(5);
    EXPECT_TRUE(pushing.stop()) << "a write after letting go";
    EXPECT_EQ(max_force_from(start_s + shortest_s), 0);
  }
  EXPECT_LT(shortest_s, 0.02);
}

// The call that hangs tells its force in the end, and the hand feels none.
TEST_P(LettingGo, WhileTheVendorsCallHangs) {
  double shortest_s = 1;
  for (int attempt = 0; attempt < 5 && shortest_s > 0.02; ++attempt) {
    double_->reset();
    const auto device = open();
    Pushing pushing(*device);
    pushing.wait_for(5);
    double_->hang_next(DeviceDouble::reports_force);
    while (!double_->is_hanging()) nap();
    const double start_s = steady_s();
    shortest_s = time_to_release(*device);
    double_->release();
    pushing.wait_for(5);
    pushing.stop();
    EXPECT_EQ(max_force_from(start_s + shortest_s), 0);
  }
  EXPECT_LT(shortest_s, 0.02);
}

// The call that hangs switches the motors on in the end, after they were switched off.
TEST_P(LettingGo, WhileTheMotorsAreSwitchedOn) {
  double_->hang_next(DeviceDouble::switches_on);
  const auto device = open();
  Pushing pushing(*device);
  while (!double_->is_hanging()) nap();
  device->release();
  double_->release();
  pushing.wait_for(5);
  EXPECT_TRUE(pushing.stop()) << "a write after letting go";
  EXPECT_FALSE(double_->now().has_motors_on);
  EXPECT_TRUE(sent_forces(*double_).empty());
}

TEST_P(LettingGo, AtAnyTimeFromAnyThread) {
  for (int delay_us = 0; delay_us < 2500; delay_us += 50) {
    double_->reset();
    const auto device = open();
    Pushing pushing(*device);
    std::this_thread::sleep_for(std::chrono::microseconds(delay_us));
    std::thread other([&] { device->release(); });
    device->release();
    other.join();
    pushing.wait_for(2);
    EXPECT_EQ(double_->now().force(), 0) << delay_us;
    EXPECT_FALSE(double_->now().has_motors_on) << delay_us;
    pushing.stop();
    EXPECT_FALSE(double_->now().has_motors_on) << delay_us;
  }
}

TEST_P(LettingGo, BeforeTheFirstWrite) {
  const auto device = open();
  device->release();
  device->release();
  run_ticks(*device, 3, [&](int) {
    DeviceReading reading;
    device->read(reading);
    EXPECT_TRUE(device->write({Vec3(1, 0, 0), Vec3::Zero()}));
  });
  EXPECT_TRUE(sent_forces(*double_).empty());
  EXPECT_FALSE(double_->now().has_motors_on);
}

TEST_P(LettingGo, ClosesWithoutForce) {
  {
    const auto device = open();
    run_ticks(*device, 3, [&](int) { device->write({Vec3(1, 0, 0), Vec3(0, 1, 0)}); });
    EXPECT_TRUE(double_->now().has_motors_on);
  }
  EXPECT_FALSE(double_->now().has_motors_on);
  EXPECT_EQ(double_->now().told, (std::array<double, 6>{}));
  EXPECT_FALSE(double_->is_open());
}

INSTANTIATE_TEST_SUITE_P(Vendors, LettingGo, testing::Values(&kForceDimension, &kOpenHaptics, &kEntact),
                         [](const auto& tested) { return tested.param->name; });

}  // namespace
}  // namespace remote_touch::release_test
