// Time for which a lost target is remembered. All times are exact in binary.
#include "core/dissertation/guidance/guidance_presence.h"

#include <gtest/gtest.h>

namespace remote_touch::guidance_presence_test {
namespace {

constexpr std::size_t kMinPoints = 20;
constexpr double kHold_s = 0.125;

GuidanceTarget seen(std::size_t points, double x_m = 0) {
  GuidanceTarget target;
  target.points = points, target.mean_W = Vec3(x_m, 0, 0);
  return target;
}

TEST(GuidancePresence, HoldsFromTheArrivalOfTheFirstFrameWithoutIt) {
  GuidancePresence presence(kMinPoints, kHold_s, 0);
  presence.on_frame(seen(kMinPoints, 1), 0);
  EXPECT_NE(presence.target(1000), nullptr) << "seen still";
  presence.on_frame(seen(0), 2);
  presence.on_frame(seen(0), 2.0625);
  ASSERT_NE(presence.target(2 + 0.75 * kHold_s), nullptr);
  EXPECT_EQ(presence.target(2 + 0.75 * kHold_s)->mean_W.x(), 1);
  EXPECT_EQ(presence.target(2 + kHold_s), nullptr);
  presence.on_frame(seen(kMinPoints, 3), 4);
  presence.on_frame(seen(0), 5);
  ASSERT_NE(presence.target(5 + 0.75 * kHold_s), nullptr) << "and anew";
  EXPECT_EQ(presence.target(5)->mean_W.x(), 3);
}

TEST(GuidancePresence, FewerPointsLoseItAndTheLastGoodTargetIsHeld) {
  GuidancePresence presence(kMinPoints, kHold_s, 0);
  presence.on_frame(seen(kMinPoints, 1), 0);
  presence.on_frame(seen(kMinPoints - 1, 2), 1);
  ASSERT_NE(presence.target(1), nullptr);
  EXPECT_EQ(presence.target(1)->mean_W.x(), 1);
  EXPECT_EQ(presence.target(1 + kHold_s), nullptr);
}

TEST(GuidancePresence, ATargetThatNeverHadEnoughPointsIsNotHeld) {
  GuidancePresence presence(kMinPoints, kHold_s, 0);
  EXPECT_EQ(presence.target(0), nullptr);
  presence.on_frame(seen(kMinPoints - 1), 0);
  EXPECT_EQ(presence.target(0), nullptr);
}

// A schedule that falls to 0 says that the fixture has ended; nothing is lost.
TEST(GuidancePresence, ATargetOfStrengthZeroEndsItWithoutAHold) {
  for (const std::size_t points : {std::size_t{0}, kMinPoints}) {
    GuidancePresence presence(kMinPoints, kHold_s, 0);
    presence.on_frame(seen(kMinPoints, 1), 0);
    GuidanceTarget off = seen(points, 2);
    off.strength = 0;
    presence.on_frame(off, 1);
    EXPECT_EQ(presence.target(1), nullptr) << points;
    presence.on_frame(seen(0), 1.0625);
    EXPECT_EQ(presence.target(1.0625), nullptr) << "what was switched off is not held";
    presence.on_frame(seen(kMinPoints, 3), 2);
    ASSERT_NE(presence.target(2), nullptr);
    EXPECT_EQ(presence.target(2)->mean_W.x(), 3);
  }
}

// Ticks continue while the frame is on its way, so its time may be later than that of the tick it arrives in.
TEST(GuidancePresence, AFrameEndsItAtAnyTimeIfThereIsNoHold) {
  GuidancePresence presence(kMinPoints, 0, 0);
  presence.on_frame(seen(kMinPoints), 0);
  presence.on_frame(seen(0), 1);
  for (const double time_s : {0.5, 1.0, 1.5}) EXPECT_EQ(presence.target(time_s), nullptr) << time_s;
}

}  // namespace
}  // namespace remote_touch::guidance_presence_test
