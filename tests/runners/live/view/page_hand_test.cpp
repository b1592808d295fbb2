// The hand does not jump when another page receives it.
#include "runners/live/view/page_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "tests/doubles/simulated_clock.h"

namespace remote_touch::page_hand_test {
namespace {

Eigen::Quaterniond about_z(double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3::UnitZ()));
}

// The hand that the loop reads, and the page that moves it, as in a live run at 1 kHz.
class PageHandTest : public testing::Test {
 protected:
  DeviceReading read_after(int ticks) {
    DeviceReading reading;
    for (int i = 0; i < ticks; ++i) {
      clock_.sleep_s(0.001);
      EXPECT_FALSE(device_.read(reading));
    }
    return reading;
  }
  Vec3 after(int ticks) { return read_after(ticks).position_m; }
  void page_at(double x_m) { hand_.move({Vec3(x_m, 0, 0), about_z(0), 0}); }

  const std::shared_ptr<HandPoses> poses_ = std::make_shared<HandPoses>();
  PageHand hand_{poses_};
  SimulatedClock clock_;
  const DeviceState start_{.position_W = Vec3(0.1, 0.2, 0.3), .orientation_W = about_z(90)};
  BrowserDevice device_{poses_, start_, DevicePlacement(LiveSettings{}), 1000, clock_};
};

TEST_F(PageHandTest, TheFirstPoseOfAPageDoesNotMoveTheHand) {
  hand_.pass_on();
  hand_.move({Vec3(7, 7, 7), about_z(20), 0});
  const DeviceReading first = read_after(1000);
  EXPECT_NEAR((first.position_m - start_.position_W).norm(), 0, 1e-12);
  EXPECT_NEAR(first.orientation.angularDistance(about_z(90)), 0, 1e-7);
  hand_.move({Vec3(7, 7.01, 7), about_z(25), 2});
  const DeviceReading second = read_after(1000);
  EXPECT_NEAR((second.position_m - Vec3(0.1, 0.21, 0.3)).norm(), 0, 1e-9);
  EXPECT_NEAR(second.orientation.angularDistance(about_z(95)), 0, 1e-7);
  EXPECT_EQ(second.buttons, 2u);
}

TEST_F(PageHandTest, PassingOnStopsTheRotationAndReleasesTheButtons) {
  hand_.move({Vec3::Zero(), about_z(0), 0});
  hand_.move({Vec3::Zero(), about_z(90), 3});
  const DeviceReading turning = read_after(50);
  EXPECT_EQ(turning.buttons, 3u);
  EXPECT_GT(turning.orientation.angularDistance(start_.orientation_W), 0.1);
  hand_.pass_on();
  const DeviceReading stopped = read_after(500);
  EXPECT_NEAR(stopped.orientation.angularDistance(turning.orientation), 0, 1e-7);
  EXPECT_EQ(stopped.buttons, 0u);
}

// The pages are limited to 20 m of motion, and the hand begins at 0.1 m.
TEST_F(PageHandTest, NoPoseIsBeyondTheLimitOfPages) {
  page_at(-10), page_at(10);
  EXPECT_NEAR(after(12000).x(), kMaxHandDistance_m, 1e-9);
}

// A hand that presses keeps its depth, so the force does not jump.
TEST_F(PageHandTest, ATakeOverLeavesAHandAtRestWhereItIs) {
  after(1);
  page_at(0), page_at(0.02);
  const Vec3 pressed = after(1000);
  hand_.pass_on();
  page_at(-3);
  for (int i = 0; i < 500; ++i) EXPECT_NEAR((after(1) - pressed).norm(), 0, 1e-12) << i << " ms";
}

// A hand at its greatest speed v overshoots by v / (e w), as a critically damped spring does, and then
// returns.
TEST_F(PageHandTest, ATakeOverStopsAMovingHandWithoutAJump) {
  after(1);
  page_at(0), page_at(1);
  const Vec3 there = after(300);
  hand_.pass_on();
  page_at(-3);
  Vec3 before = there;
  double farthest_m = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 now = after(1);
    EXPECT_LE((now - before).norm(), 0.001 * BrowserDevice::kMaxSpeed_m_per_s + 1e-9);
    farthest_m = std::max(farthest_m, (now - there).norm());
    before = now;
  }
  EXPECT_LT(farthest_m, BrowserDevice::kMaxSpeed_m_per_s /
                            (std::numbers::e * BrowserDevice::kNaturalFrequency_rad_per_s));
  EXPECT_NEAR((before - there).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace remote_touch::page_hand_test
