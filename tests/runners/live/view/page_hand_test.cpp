// The hand does not jump when another page receives it.
#include "runners/live/view/page_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "runners/live/view/page_message.h"
#include "tests/doubles/simulated_clock.h"

namespace remote_touch::page_hand_test {
namespace {

Eigen::Quaterniond about_z(double degrees) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3::UnitZ()));
}

class PageHandTest : public testing::Test {
 protected:
  HandPose newest() {
    EXPECT_TRUE(poses_->take());
    return poses_->front();
  }

  const std::shared_ptr<HandPoses> poses_ = std::make_shared<HandPoses>();
  PageHand hand_{poses_};
};

TEST_F(PageHandTest, TheFirstPoseOfAPageDoesNotMoveTheHand) {
  hand_.take({Vec3(0.1, 0, 0), about_z(90), 0});
  hand_.pass_on();
  EXPECT_FALSE(poses_->take()) << "nobody has moved the hand yet";
  hand_.move({Vec3(7, 7, 7), about_z(20), 0});
  const HandPose first = newest();
  EXPECT_NEAR((first.position_W - Vec3(0.1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(first.orientation_W.angularDistance(about_z(90)), 0, 1e-7);
  hand_.move({Vec3(7, 7.01, 7), about_z(25), 2});
  const HandPose second = newest();
  EXPECT_NEAR((second.position_W - Vec3(0.1, 0.01, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR(second.orientation_W.angularDistance(about_z(95)), 0, 1e-7);
  EXPECT_EQ(second.buttons, 2u);
}

// The hand is on its way to the newest pose. It stops where the newest tick has it.
TEST_F(PageHandTest, PassingOnStopsTheHandAndReleasesItsButtons) {
  hand_.take({Vec3::Zero(), about_z(0), 0});
  hand_.move({Vec3::Zero(), about_z(0), 0});
  hand_.move({Vec3(1, 0, 0), about_z(0), 3});
  hand_.take({Vec3(0.25, 0, 0), about_z(0), 3});
  hand_.pass_on();
  EXPECT_EQ(newest().position_W, Vec3(0.25, 0, 0));
  EXPECT_EQ(poses_->front().buttons, 0u);
}

TEST_F(PageHandTest, NoPoseIsBeyondTheLimitOfPages) {
  hand_.take({Vec3(9, 0, 0), about_z(0), 0});
  hand_.move({Vec3(-10, 0, 0), about_z(0), 0});
  hand_.move({Vec3(10, 0, 0), about_z(0), 0});
  EXPECT_EQ(newest().position_W.x(), kMaxHandDistance_m);
}

TEST_F(PageHandTest, BeforeTheFirstTickThePoseOfThePageCounts) {
  hand_.pass_on();
  hand_.move({Vec3(0.3, 0, 0), about_z(0), 0});
  EXPECT_EQ(newest().position_W, Vec3(0.3, 0, 0));
}

// The hand that the loop reads, and the page that moves it, as in a live run at 1 kHz.
class TakeOver : public PageHandTest {
 protected:
  // Returns the position of the hand after so many ticks.
  Vec3 after(int ticks) {
    DeviceReading reading;
    for (int i = 0; i < ticks; ++i) {
      clock_.sleep_s(0.001);
      EXPECT_FALSE(device_.read(reading));
      hand_.take({reading.position_m, reading.orientation, 0});
    }
    return reading.position_m;
  }
  void page_at(double x_m) { hand_.move({Vec3(x_m, 0, 0), about_z(0), 0}); }

  SimulatedClock clock_;
  BrowserDevice device_{
      poses_, {.position_W = Vec3(0.1, 0.2, 0.3)}, DevicePlacement(LiveSettings{}), 1000, clock_};
};

// A hand that presses keeps its depth, so the force does not jump.
TEST_F(TakeOver, LeavesAHandAtRestWhereItIs) {
  after(1);
  page_at(0), page_at(0.02);
  const Vec3 pressed = after(1000);
  hand_.pass_on();
  page_at(-3);
  for (int i = 0; i < 500; ++i) EXPECT_NEAR((after(1) - pressed).norm(), 0, 1e-12) << i << " ms";
}

// A hand at its greatest speed v overshoots by v / (e w), as a critically damped spring does, and then
// returns.
TEST_F(TakeOver, StopsAMovingHandWithoutAJump) {
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
