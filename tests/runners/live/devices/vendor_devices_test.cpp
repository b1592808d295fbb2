// The adapter of Force Dimension's DHD, with a test double: what it does beyond the contract of all adapters.
#include <gtest/gtest.h>
#include <algorithm>

#include "runners/live/devices/device_table.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/support/test_files.h"

namespace remote_touch::vendor_devices_test {
namespace {

class ForceDimensionTest : public testing::Test {
 protected:
  SimulatedClock clock_;
  DoubleInstalled double_{kForceDimension, &clock_};
};

TEST_F(ForceDimensionTest, DevicesAreNumbered) {
  for (const char* address : {"x", "-1", "0x", "1.5", "128", " 0"})
    EXPECT_HAS(refusal([&] { open_force_dimension(address, clock_); }),
               std::string("fd:") + address + ": not the number of a device: expected 0 for the first");
  EXPECT_HAS(refusal([&] { open_force_dimension("1", clock_); }), "fd:1: no such device: expected 0 to 0");
  double_->set([](DeviceDouble::State& state) { state.devices = 2; });
  EXPECT_NO_THROW(open_force_dimension("1", clock_));
  EXPECT_EQ(force_dimension_availability().detail, std::string(kForceDimension.double_file) + ": 2 devices");
}

TEST_F(ForceDimensionTest, RefusesIfThereIsNoDevice) {
  double_->set([](DeviceDouble::State& state) { state.devices = 0; });
  EXPECT_HAS(refusal([&] { open_force_dimension("", clock_); }), "fd:0: no device is connected: expected ");
  EXPECT_FALSE(force_dimension_availability().found);
  EXPECT_HAS(force_dimension_availability().detail, "no device is connected");
}

TEST_F(ForceDimensionTest, ReportsARefusalOfTheLibrary) {
  double_->set([](DeviceDouble::State& state) { state.switching_error = 20; });
  EXPECT_HAS(refusal([&] { open_force_dimension("0", clock_); }),
             "fd:0: cannot be opened (the double's text): expected ");
}

TEST_F(ForceDimensionTest, LimitsThatAreNotSetAreUnknown) {
  double_->set([](DeviceDouble::State& state) { state.max_force = -1, state.max_torque = -1; });
  EXPECT_EQ(open_force_dimension("", clock_)->traits().max_force_N, 0);
  EXPECT_EQ(open_force_dimension("", clock_)->traits().max_torque_Nm, 0);
  double_->set([](DeviceDouble::State& state) { state.max_force = 12, state.max_torque = 0.4; });
  const auto device = open_force_dimension("", clock_);
  EXPECT_EQ(device->traits().name, "double.7");
  EXPECT_EQ(device->traits().max_force_N, 12);
  EXPECT_EQ(device->traits().max_torque_Nm, 0.4);
  EXPECT_EQ(device->traits().tick_rate_hz, 1000);
}

// A device without a wrist does not turn, whatever its library reports.
TEST_F(ForceDimensionTest, DoesNotTurnIfItHasNoWrist) {
  double_->set([](DeviceDouble::State& state) {
    state.sensed_axes = state.actuated_axes = 3;
    state.rotation = {};
  });
  const auto device = open_force_dimension("", clock_);
  const auto [reading, fault] = read_once(*device);
  EXPECT_FALSE(fault);
  EXPECT_EQ(device->traits().sensed_axes, 3);
  EXPECT_TRUE(reading.orientation.isApprox(Eigen::Quaterniond::Identity()));
}

// The adapter of Entact's EntactAPI, with a test double: what it does beyond the contract of all adapters.

class EntactTest : public testing::Test {
 protected:
  SimulatedClock clock_;
  DoubleInstalled double_{kEntact, &clock_};
};

TEST_F(EntactTest, DevicesHaveAddresses) {
  EXPECT_NO_THROW(open_entact("192.168.1.144", clock_));
  EXPECT_HAS(refusal([&] { open_entact("192.168.1.145", clock_); }),
             "entact:192.168.1.145: no device answers: expected ");
  EXPECT_EQ(open_entact("", clock_)->traits().name, "Double W5D");
}

TEST_F(EntactTest, IsHomedIfItIsNot) {
  double_->set([](DeviceDouble::State& state) { state.is_homed = false, state.failing_homings = 5; });
  EXPECT_NO_THROW(open_entact("", clock_));
  double_->set([](DeviceDouble::State& state) { state.is_homed = false, state.failing_homings = 1000; });
  EXPECT_HAS(refusal([&] { open_entact("", clock_); }),
             "entact: cannot be homed; hold the handle in its calibration position");
  EXPECT_FALSE(double_->is_open());
}

TEST_F(EntactTest, AReadingIsOneTickOld) {
  const auto device = open_entact("", clock_);
  run_ticks(*device, 10, [&](int i) {
    double_->set([&](DeviceDouble::State& state) { state.position = {0, 1000.0 * i, 0}; });
    DeviceReading reading;
    EXPECT_FALSE(device->read(reading));
    EXPECT_EQ(reading.position_m.x(), std::max(i - 1, 0));
    device->write({});
  });
}

// The adapter of OpenHaptics, with a test double: what it does beyond the contract of all adapters.

class OpenHapticsTest : public testing::Test {
 protected:
  SimulatedClock clock_;
  DoubleInstalled double_{kOpenHaptics, &clock_};
};

// No force remains after a tick without one, nor after the last tick.
TEST_F(OpenHapticsTest, SendsZeroForceAfterATickWithoutOneAndAfterTheLast) {
  const auto device = open_open_haptics("", clock_);
  std::array<double, 6> sent_in_between{1};
  int ticks = 0;
  device->run([&] {
    if (ticks == 2) sent_in_between = double_->now().sent;
    if (ticks != 1) device->write({Vec3(1, 0, 0), Vec3::Zero()});
    return ++ticks < 4;
  });
  EXPECT_EQ(sent_in_between, (std::array<double, 6>{}));
  EXPECT_EQ(double_->now().sent, (std::array<double, 6>{}));
  EXPECT_TRUE(double_->now().has_motors_on);
}

TEST_F(OpenHapticsTest, DevicesHaveNames) {
  EXPECT_NO_THROW(open_open_haptics("Default Device", clock_));
  EXPECT_NO_THROW(open_open_haptics("Left Device", clock_));
  EXPECT_HAS(refusal([&] { open_open_haptics("Right Device", clock_); }),
             "touch:Right Device: cannot be opened (the double's text, 770/-28): expected ");
}

TEST_F(OpenHapticsTest, HasTraitsInOurUnits) {
  double_->set([](DeviceDouble::State& state) {
    state.max_force = 3.3, state.continuous_force = 0.88;
    state.max_stiffness = 0.5, state.max_torque = 300;
  });
  const auto device = open_open_haptics("", clock_);
  const DeviceTraits& traits = device->traits();
  EXPECT_EQ(traits.name, "Double Touch");
  EXPECT_EQ(traits.sensed_axes, 6);
  EXPECT_EQ(traits.max_force_N, 3.3);
  EXPECT_EQ(traits.continuous_force_N, 0.88);
  EXPECT_EQ(traits.max_stiffness_N_per_m, 500);
  EXPECT_DOUBLE_EQ(traits.max_torque_Nm, 0.3);
}

// Each of the three calls that read the state leaves an error.
TEST_F(OpenHapticsTest, NoErrorOfATickReachesALaterOne) {
  const auto device = open_open_haptics("", clock_);
  std::vector<int> codes;
  run_ticks(*device, 4, [&](int i) {
    double_->set([i](DeviceDouble::State& state) { state.reading_error = i == 0 ? 0x0300 : 0; });
    DeviceReading reading;
    codes.push_back(device->read(reading).code);
  });
  EXPECT_EQ(codes, (std::vector<int>{0x0300, 0, 0, 0}));
}

// The cycle still runs without a scheduler: its ticks receive the reason as a fault, and decide when it ends.
void expect_fault_of_the_scheduler(HapticDevice& device, DeviceDouble& behind, int before, const char* what) {
  DeviceFault fault, written;
  run_ticks(device, before + 3, [&](int i) {
    DeviceReading reading;
    fault = device.read(reading);
    written = device.write({Vec3(1, 0, 0), Vec3::Zero()});
    if (i + 1 == before) behind.set([](DeviceDouble::State& state) { state.is_scheduler_silent = true; });
  });
  ASSERT_TRUE(fault && written);
  EXPECT_STREQ(fault.what, what);
  EXPECT_STREQ(written.what, what);
  EXPECT_FALSE(behind.now().has_motors_on);
}

TEST_F(OpenHapticsTest, ASchedulerThatDoesNotStartIsAFault) {
  double_->set([](DeviceDouble::State& state) { state.scheduler_error = 0x0304; });
  const auto device = open_open_haptics("", clock_);
  expect_fault_of_the_scheduler(*device, *double_, 0, "OpenHaptics: the scheduler has no timer");
}

// The fault is reported after more than a second without a call.
TEST_F(OpenHapticsTest, ASchedulerThatStopsCallingIsAFault) {
  const auto device = open_open_haptics("", clock_);
  expect_fault_of_the_scheduler(*device, *double_, 5, "OpenHaptics: the scheduler has stopped calling");
  EXPECT_GT(clock_.now_s(), 1.004);
  EXPECT_LT(clock_.now_s(), 1.02);
}

}  // namespace
}  // namespace remote_touch::vendor_devices_test
