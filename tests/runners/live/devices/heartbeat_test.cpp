// The rule by which a loop that hangs loses its device.
#include "runners/live/devices/heartbeat.h"

#include <gtest/gtest.h>

#include "tests/doubles/simulated_clock.h"

namespace remote_touch::heartbeat_test {
namespace {

class CountingDevice final : public HapticDevice {
 public:
  using HapticDevice::HapticDevice;
  int release_count = 0;

  DeviceFault read(DeviceReading&) noexcept override { return {}; }
  DeviceFault write(const Wrench&) noexcept override { return {}; }
  void release() noexcept override { ++release_count; }
};

class HeartbeatTest : public testing::Test {
 protected:
  SimulatedClock clock_;
  CountingDevice device_{clock_};
  Heartbeat heartbeat_{device_, 0.01};
};

TEST_F(HeartbeatTest, ExpectsNoBeatBeforeTheFirst) {
  heartbeat_.check(ms(1000));
  EXPECT_EQ(device_.release_count, 0);
}

TEST_F(HeartbeatTest, ReleasesTheDeviceAfterMoreThanItsTime) {
  EXPECT_TRUE(heartbeat_.beat(ms(5)));
  heartbeat_.check(ms(15));
  EXPECT_EQ(device_.release_count, 0);
  heartbeat_.check(ms(15) + 1);
  EXPECT_EQ(device_.release_count, 1);
  EXPECT_EQ(heartbeat_.stalls(), 1);
}

TEST_F(HeartbeatTest, ReleasesOnceAStallAndSaysSoAtTheNextBeat) {
  heartbeat_.beat(0);
  for (int i = 1; i < 100; ++i) heartbeat_.check(ms(i));
  EXPECT_EQ(device_.release_count, 1);
  EXPECT_FALSE(heartbeat_.beat(ms(100)));
  EXPECT_TRUE(heartbeat_.beat(ms(101)));
  for (int i = 102; i < 200; ++i) heartbeat_.check(ms(i));
  EXPECT_EQ(device_.release_count, 2);
  EXPECT_EQ(heartbeat_.stalls(), 2);
}

TEST_F(HeartbeatTest, ExpectsNoBeatAfterTheLast) {
  heartbeat_.beat(0);
  heartbeat_.rest();
  heartbeat_.check(ms(1000));
  EXPECT_EQ(device_.release_count, 0);
}

TEST_F(HeartbeatTest, IsCheckedFiveTimesInItsTime) {
  EXPECT_DOUBLE_EQ(heartbeat_.period_s(), 0.002);
}

}  // namespace
}  // namespace remote_touch::heartbeat_test
