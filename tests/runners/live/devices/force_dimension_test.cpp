// The adapter of Force Dimension's DHD, with a test double: what it does beyond the contract of all adapters.
#include <gtest/gtest.h>

#include "runners/live/devices/device_table.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/support/test_files.h"

namespace remote_touch::force_dimension_test {
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

}  // namespace
}  // namespace remote_touch::force_dimension_test
