// Comparison of the closed form with the method's rules, followed frame by frame in one dimension.
#include "analysis/theory/first_touch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace remote_touch::first_touch_test {
namespace {

constexpr double kR1_m = 0.00499, kR2_m = 0.00501, kR3_m = 0.01;

// A proxy over a plane of points that rises, by the rules of 4.2 alone. Heights are along the plane's normal.
struct Proxy {
  double beside_m, frame_rate_hz;
  double height_m = 0, velocity_m_per_s = 0;
  bool has_normal = false;

  double rest_m() const {
    const double rc_m = 0.5 * (kR1_m + kR2_m);
    return std::sqrt(rc_m * rc_m - beside_m * beside_m);
  }
  double nearest_m(double plane_m) const { return std::hypot(height_m - plane_m, beside_m); }

  // Processes one frame with the hand at height 0. Returns false if the plane has passed the centre.
  bool sees(double plane_m) {
    height_m += velocity_m_per_s / frame_rate_hz;  // (4.3)
    if (height_m < plane_m) return false;
    double step_m = 0;
    if (nearest_m(plane_m) < kR1_m)
      step_m = plane_m + rest_m() - height_m;  // (4.10)
    else if (nearest_m(plane_m) > kR2_m)
      step_m = std::max(0.0, plane_m + rest_m()) - height_m;  // (4.9)
    height_m += step_m;
    const double felt_m = has_normal ? step_m : 0;  // (4.13) uses the normal from before the frame
    velocity_m_per_s = std::max(0.0, velocity_m_per_s + felt_m * frame_rate_hz);
    has_normal = has_normal || nearest_m(plane_m) < kR3_m;
    return true;
  }
};

bool is_lost(double beside_m, double frame_rate_hz, double velocity, double phase) {
  Proxy proxy{beside_m, frame_rate_hz};
  const double moved_m = velocity / frame_rate_hz;
  for (int frame = 0; frame < 40; ++frame)
    if (!proxy.sees(-(30 - frame + phase) * moved_m)) return true;
  return false;
}

double followed(double beside_m, double frame_rate_hz, double velocity, int phases) {
  int lost = 0;
  for (int i = 0; i < phases; ++i)
    lost += is_lost(beside_m, frame_rate_hz, velocity, (i + 0.5) / phases) ? 1 : 0;
  return static_cast<double>(lost) / phases;
}

// The lost phases are one interval, so the number of phases in it differs by less than one.
TEST(FirstTouch, FractionIsThatOfTheRulesFollowedFrameByFrame) {
  constexpr int kPhases = 2000;
  for (const double rate_hz : {15.0, 30.0, 90.0})
    for (const double beside_m : {0.0, 0.00075, 0.0010606601717798212})
      for (double moved_m = 0.0045; moved_m < 0.0105; moved_m += 0.00017) {
        const double velocity = moved_m * rate_hz;
        const FirstTouch touch{kR1_m, kR2_m, beside_m, rate_hz};
        EXPECT_NEAR(lost_at_first_touch(touch, velocity), followed(beside_m, rate_hz, velocity, kPhases),
                    1.0 / kPhases)
            << moved_m << ", " << beside_m << ", " << rate_hz;
      }
}

TEST(FirstTouch, NoneIsLostUpToTheFirstVelocityAndAllFromTwiceTheSecond) {
  const FirstTouch touch{kR1_m, kR2_m, 0.0010606601717798212, 30};
  const double first = max_first_touch_velocity(touch), touched = max_touched_velocity(touch);
  EXPECT_NEAR(first, 0.14628, 5e-6);
  EXPECT_NEAR(touched, 0.14659, 5e-6);
  EXPECT_EQ(lost_at_first_touch(touch, first), 0);
  EXPECT_GT(lost_at_first_touch(touch, 1.001 * first), 0);
  EXPECT_LT(lost_at_first_touch(touch, 1.999 * touched), 1);
  EXPECT_EQ(lost_at_first_touch(touch, 2 * touched), 1);
  EXPECT_EQ(lost_at_first_touch(touch, 1.0), 1);
  for (const double velocity : {0.16, 0.2, 0.28})
    EXPECT_NEAR(lost_at_first_touch(touch, velocity), 2 * (1 - touched / velocity), 1e-12);
}

// The hand has brought the proxy to its rest height over the plane before the frame.
TEST(FirstTouch, AHandThatTouchesBetweenFramesLosesAboveItsOwnVelocity) {
  for (const double beside_m : {0.0, 0.0010606601717798212}) {
    const FirstTouch touch{kR1_m, kR2_m, beside_m, 30};
    for (const double velocity :
         {0.9999 * max_touched_velocity(touch), 1.0001 * max_touched_velocity(touch)}) {
      Proxy proxy{beside_m, 30, 0, 0, true};
      proxy.height_m = -0.1 + proxy.rest_m();
      bool kept = true;
      for (int frame = 1; frame < 10 && kept; ++frame) kept = proxy.sees(-0.1 + frame * velocity / 30);
      EXPECT_EQ(kept, velocity < max_touched_velocity(touch)) << velocity;
    }
  }
}

}  // namespace
}  // namespace remote_touch::first_touch_test
