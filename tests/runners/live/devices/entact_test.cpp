// The adapter of Entact's EntactAPI, with a test double: what it does beyond the contract of all adapters.
#include <gtest/gtest.h>

#include <algorithm>

#include "runners/live/devices/entact.h"
#include "tests/doubles/vendor_devices.h"
#include "tests/support/test_files.h"

namespace remote_touch::entact_test {
namespace {

class EntactTest : public testing::Test {
 protected:
  SimulatedClock clock_;
  DoubleInstalled double_{kEntact, &clock_};
};

// The handle is 10 mm towards the user, 20 mm to the right and 30 mm up. A quarter turn of the handle about
// the upward axis turns the axis that points to the user to the right.
TEST_F(EntactTest, ConvertsMillimetresAndRows) {
  double_->set([](DeviceDouble::State& state) {
    state.position = {10, 20, 30};
    state.rotation = {0, -1, 0, 1, 0, 0, 0, 0, 1};
  });
  const auto device = open_entact("", clock_);
  const auto [reading, fault] = read_once(*device);
  ASSERT_FALSE(fault);
  EXPECT_TRUE(reading.position_m.isApprox(Vec3(0.02, 0.03, 0.01), 1e-12));
  EXPECT_TRUE((reading.orientation * Vec3::UnitZ()).isApprox(Vec3::UnitX(), 1e-12));
  run_ticks(*device, 1, [&](int) { device->write({Vec3(1, 2, 3), Vec3(0.004, 0.005, 0.006)}); });
  EXPECT_EQ(double_->now().sent, (std::array<double, 6>{3, 1, 2, 6, 4, 5}));
}

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
