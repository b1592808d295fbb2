// The adapter of Entact's EntactAPI, with a test double: what it does beyond the contract of all adapters.
#include <gtest/gtest.h>

#include <algorithm>

#include "runners/live/devices/device_table.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/support/test_files.h"

namespace remote_touch::entact_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::entact_test
