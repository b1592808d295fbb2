// The hand of a user with a mouse, compared with the closed form of the spring that it follows.
#include "runners/live/devices/device_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "runners/experiment/sessions/session_file.h"
#include "tests/doubles/simulated_clock.h"

namespace remote_touch::browser_device_test {
namespace {

constexpr double kRate_hz = 1000;

class BrowserDeviceTest : public testing::Test {
 protected:
  DeviceReading after(int ticks) {
    DeviceReading reading;
    for (int i = 0; i < ticks; ++i) {
      clock_.sleep_s(1 / kRate_hz);
      EXPECT_FALSE(device_.read(reading));
    }
    return reading;
  }
  void want(const DeviceState& pose) { request({{start_.position_W, start_.orientation_W, 0}, pose}); }
  void request(const HandMotion& motion) {
    poses_->back() = motion;
    poses_->publish();
  }

  const std::shared_ptr<HandPoses> poses_ = std::make_shared<HandPoses>();
  SimulatedClock clock_;
  const DeviceState start_{.position_W = Vec3(0.1, 0.2, 0.3)};
  BrowserDevice device_{poses_, start_, DevicePlacement(LiveSettings{}), kRate_hz, clock_};
};

TEST_F(BrowserDeviceTest, IsAtItsStartUntilItIsMoved) {
  EXPECT_EQ(after(50).position_m, start_.position_W);
}

// x(t) = d (1 - (1 + w t) e^(-w t)), as long as that is slower than the limit. Steps of a millisecond, the
// velocity first, are ahead of it by at most a third of w times the step, 2 % of d.
constexpr double kAhead = BrowserDevice::kNaturalFrequency_rad_per_s * 0.001 / 3;
TEST_F(BrowserDeviceTest, FollowsAsACriticallyDampedSpringWould) {
  const double d = 0.004, w = BrowserDevice::kNaturalFrequency_rad_per_s;
  after(1);
  want({start_.position_W + Vec3(0, d, 0)});
  for (int ms = 1; ms <= 200; ++ms) {
    const double t = 1e-3 * ms, expected = d * (1 - (1 + w * t) * std::exp(-w * t));
    EXPECT_NEAR(after(1).position_m.y() - start_.position_W.y(), expected, kAhead * d) << ms << " ms";
  }
  EXPECT_NEAR(after(300).position_m.y(), start_.position_W.y() + d, 1e-9);
}

TEST_F(BrowserDeviceTest, IsNeverFasterThanItsLimits) {
  after(1);
  DeviceState far{start_.position_W + Vec3(1, 0, 0)};
  far.orientation_W = Eigen::AngleAxisd(3, Vec3::UnitZ());
  want(far);
  DeviceReading before = after(1);
  double fastest = 0, turning = 0;
  for (int i = 0; i < 1000; ++i) {
    const DeviceReading now = after(1);
    fastest = std::max(fastest, (now.position_m - before.position_m).norm() * kRate_hz);
    EXPECT_NEAR((now.position_m - before.position_m).norm() * kRate_hz, now.velocity_m_per_s.norm(), 1e-6);
    turning = std::max(turning, now.orientation.angularDistance(before.orientation) * kRate_hz);
    before = now;
  }
  EXPECT_NEAR(fastest, BrowserDevice::kMaxSpeed_m_per_s, 1e-6);
  EXPECT_NEAR(turning, BrowserDevice::kMaxTurning_rad_per_s, 1e-3);
  EXPECT_LT(fastest, 0.9 * SafetyLimits{}.max_speed_m_per_s) << "the safety gate does not mind";
}

TEST_F(BrowserDeviceTest, TurnsToThePoseAndReportsTheButtons) {
  DeviceState turned{start_.position_W};
  turned.orientation_W = Eigen::AngleAxisd(0.5, Vec3(1, 2, 2) / 3);
  turned.buttons = 3;
  want(turned);
  EXPECT_EQ(after(1).buttons, 3u);
  EXPECT_NEAR(after(1000).orientation.angularDistance(turned.orientation_W), 0, 1e-8);
}

// The stop and the first motion after it may reach the loop together.
TEST_F(BrowserDeviceTest, ANewStopHoldsTheHandWhereThatTickHasIt) {
  after(1);
  want({start_.position_W + Vec3(1, 0, 0)});
  const Vec3 there = after(300).position_m;
  request({{}, {Vec3(0, 0.01, 0)}, 1});
  EXPECT_NEAR((after(500).position_m - there - Vec3(0, 0.01, 0)).norm(), 0, 1e-9);
  request({{}, {Vec3(0, 0.03, 0)}, 1});
  EXPECT_NEAR((after(500).position_m - there - Vec3(0, 0.03, 0)).norm(), 0, 1e-9) << "the same stop";
}

TEST_F(BrowserDeviceTest, AStopTakesTheSpeedAway) {
  after(1);
  want({start_.position_W + Vec3(1, 0, 0)});
  const Vec3 there = after(300).position_m;
  request({{}, {}, 1});
  for (int i = 0; i < 50; ++i) EXPECT_NEAR((after(1).position_m - there).norm(), 0, 1e-12) << i;
}

// A loop that missed ticks finds the hand where it would be by then.
TEST_F(BrowserDeviceTest, MovesOnWhileTicksAreMissed) {
  after(1);
  want({start_.position_W + Vec3(0, 0.004, 0)});
  clock_.sleep_s(0.03);
  DeviceReading reading;
  device_.read(reading);
  const double t = 0.03, w = BrowserDevice::kNaturalFrequency_rad_per_s;
  EXPECT_NEAR(reading.position_m.y() - 0.2, 0.004 * (1 - (1 + w * t) * std::exp(-w * t)), kAhead * 0.004);
}

}  // namespace
}  // namespace remote_touch::browser_device_test
