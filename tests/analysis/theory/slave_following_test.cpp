// The distances of a slave from its command, against an integration of its equation of motion in small steps.
#include "analysis/theory/slave_following.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace remote_touch::slave_following_test {
namespace {

constexpr double kStep_s = 1e-5;

// Calls seen(time, command, slave) after each step until it returns false. The command is 0 before the start.
void follow(double natural_frequency_hz, double duration_s, const std::function<double(double)>& command,
            const std::function<bool(double, double, double)>& seen) {
  const double w = 2 * std::numbers::pi * natural_frequency_hz;
  double x = command(0), v = 0, before = x;
  for (double t = kStep_s; t < duration_s; t += kStep_s) {
    const double c = command(t);
    v += kStep_s * (w * w * (c - x) + 2 * w * ((c - before) / kStep_s - v));
    x += kStep_s * v, before = c;
    if (!seen(t, c, x)) return;
  }
}

TEST(FollowingError, IsThatOfTheIntegratedMotion) {
  for (const FollowedShake& shake :
       {FollowedShake{0.02, 0.5, 2, 0.1}, FollowedShake{0.01, 1, 1, 0}, FollowedShake{0.02, 2, 10, 0.2}}) {
    const double u = 2 * std::numbers::pi * shake.hz;
    double largest = 0;
    follow(
        shake.natural_frequency_hz, 6,
        [&](double t) { return shake.amplitude_m * std::sin(u * (t - shake.age_s)); },
        [&](double t, double, double x) {
          if (t > 4) largest = std::max(largest, std::abs(shake.amplitude_m * std::sin(u * t) - x));
          return true;
        });
    EXPECT_NEAR(following_error_m(shake), largest, 0.01 * largest);
  }
}

TEST(FirstImpact, IsThatOfTheIntegratedMotion) {
  for (const Approach& a : {Approach{0.2, 0.05, 0, 1}, Approach{0.2, 0.1, 0.005, 1},
                            Approach{0.4, 0.08, -0.02, 3}, Approach{0.1, 0.05, -1e-4, 8}}) {
    double time_s = 0, speed = 0, last = a.way_m + a.gap_m;
    follow(
        a.natural_frequency_hz, 5,
        [&](double t) { return std::max(a.gap_m, a.gap_m + a.way_m - a.speed_m_per_s * t); },
        [&](double t, double, double x) {
          time_s = t, speed = (last - x) / kStep_s, last = x;
          return x > 0;
        });
    const std::optional<Impact> touch = first_impact(a);
    ASSERT_TRUE(touch);
    EXPECT_NEAR(touch->time_s, time_s, 1e-3);
    EXPECT_NEAR(touch->speed_m_per_s, speed, 0.02 * a.speed_m_per_s);
  }
}

// The slave passes the end of the command by at most v / (e w).
TEST(FirstImpact, HappensOnlyIfTheOvershootExceedsTheGap) {
  const double overshoot_m = 0.2 / (std::numbers::e * 2 * std::numbers::pi * 2);
  EXPECT_TRUE(first_impact({0.2, 1, 0.99 * overshoot_m, 2}));
  EXPECT_FALSE(first_impact({0.2, 1, 1.01 * overshoot_m, 2}));
}

TEST(FirstImpact, AtTheEndOfTheCommandIsLaterByTheClosedForm) {
  const double w = 2 * std::numbers::pi, stop_s = 0.25;
  const std::optional<Impact> touch = first_impact({0.2, 0.05, 0, 1});
  ASSERT_TRUE(touch);
  EXPECT_NEAR(touch->time_s, stop_s / (1 - std::exp(-w * stop_s)), 1e-6);
}

TEST(ImpactForce, StopsTheMass) {
  const double push_N = 3, K = 30000, m = 2, speed = 0.2;
  const double depth_m = impact_force_N(push_N, K, m, speed) / K;
  EXPECT_NEAR(m * speed * speed / 2 + push_N * depth_m, K * depth_m * depth_m / 2, 1e-12);
  EXPECT_DOUBLE_EQ(impact_force_N(0, K, m, speed), speed * std::sqrt(K * m));
}

}  // namespace
}  // namespace remote_touch::slave_following_test
