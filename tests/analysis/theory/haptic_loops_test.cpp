// Haptic loops: a slave that follows, impacts, sampled walls and delays, against integrations of their
// equations, closed forms and eigenvalues.
#include "analysis/theory/haptic_loops.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

namespace remote_touch::haptic_loops_test {
namespace {

constexpr double kPi = std::numbers::pi, kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStep_s = 1e-5;

// Calls seen(time, command, slave) after each step until it returns false. The command is 0 before the start.
void follow(double natural_frequency_hz, double duration_s, const std::function<double(double)>& command,
            const std::function<bool(double, double, double)>& seen) {
  const double w = 2 * kPi * natural_frequency_hz;
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
    const double u = 2 * kPi * shake.hz;
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
  const double overshoot_m = 0.2 / (std::numbers::e * 2 * kPi * 2);
  EXPECT_TRUE(first_impact({0.2, 1, 0.99 * overshoot_m, 2}));
  EXPECT_FALSE(first_impact({0.2, 1, 1.01 * overshoot_m, 2}));
}

TEST(ImpactForce, StopsTheMass) {
  const double push_N = 3, K = 30000, m = 2, speed = 0.2;
  const double depth_m = impact_force_N(push_N, K, m, speed) / K;
  EXPECT_NEAR(m * speed * speed / 2 + push_N * depth_m, K * depth_m * depth_m / 2, 1e-12);
  EXPECT_DOUBLE_EQ(impact_force_N(0, K, m, speed), speed * std::sqrt(K * m));
}

// The largest stable stiffness of a sampled wall: the law where it holds, and the simulated device beyond it.

// The correction of the law to first order, see wall_law_N_per_m().
double corrected_law(const SampledWall& w) {
  const double t = (0.5 + w.delay_ticks) * w.tick_s, t_B = t + 0.5 * w.velocity_ticks * w.tick_s;
  const double law = wall_law_N_per_m(w);
  return law *
         (1 + law * t * t / (6 * w.mass_kg) - w.wall_damping_Ns_per_m * t_B * t_B / (2 * w.mass_kg * t));
}

TEST(SampledWall, TheLawAndItsCorrectionHoldForAHeavyHand) {
  for (const double mass_kg : {1.0, 3.0, 10.0})
    for (const double b : {0.1, 0.5, 2.0})
      for (const double B : {0.0, 0.5, 10.0})
        for (const int delay : {0, 1, 5})
          for (const int ticks : {1, 5}) {
            const SampledWall wall{mass_kg, b, B, 0, delay, ticks};
            const double correction = std::abs(corrected_law(wall) / wall_law_N_per_m(wall) - 1);
            if (correction > 0.1) continue;
            EXPECT_NEAR(exact_wall_limit_N_per_m(wall) / corrected_law(wall), 1,
                        8 * correction * correction + 0.002)
                << mass_kg << " " << b << " " << B << " " << delay << " " << ticks;
          }
}

// The law promises 3429 N/m here.
TEST(SampledWall, TheLawIsTooHighForALightHandWithALateDamper) {
  const SampledWall wall{.mass_kg = 0.1,
                         .damping_Ns_per_m = 2,
                         .wall_damping_Ns_per_m = 10,
                         .delay_ticks = 3,
                         .velocity_ticks = 5};
  EXPECT_NEAR(wall_law_N_per_m(wall), 3428.6, 0.1);
  EXPECT_NEAR(exact_wall_limit_N_per_m(wall), 2000, 50);
  const SampledWall later{
      .mass_kg = 0.01, .damping_Ns_per_m = 0.1, .wall_damping_Ns_per_m = 10, .delay_ticks = 5};
  EXPECT_EQ(exact_wall_limit_N_per_m(later), 0) << "the damper makes every wall unstable";
}

// Masses, dampers and stiffnesses have a common factor: it has no meaning. A spring of the hand makes the
// oscillation faster, which a wall without a damper hardly notices.
TEST(SampledWall, ScalesWithTheMass) {
  EXPECT_NEAR(exact_wall_limit_N_per_m({0.3, 1, 0, 0.25, 5}) / exact_wall_limit_N_per_m({0.3, 1, 0, 0, 5}), 1,
              0.01);
  for (const double factor : {0.001, 7.0}) {
    const SampledWall a{0.2, 1, 3, 0.25, 2, 4};
    const SampledWall b{factor * 0.2, factor * 1, factor * 3, 0.25, 2, 4};
    EXPECT_NEAR(exact_wall_limit_N_per_m(b) / exact_wall_limit_N_per_m(a), factor, 1e-6 * factor);
  }
}

// --- delayed force, against closed forms and an integration of the delay differential equation ---

using State = std::array<double, 4>;  // x, x', x_s, x_s'

// Growth of the oscillation, per second, after the other modes have decayed: the loop in steps of kStep_s
// with the rule of Runge and Kutta. The hand feels the force of `delay` steps before, linear between steps,
// or held for `held` steps if that is not 0.
double growth_per_s(const PositionForceLoop& l, int delay, int held, double frequency_hz) {
  const double w = 2 * kPi * l.slave_natural_frequency_hz, ks = l.slave_mass_kg * w * w,
               bs = 2 * l.slave_damping_ratio * l.slave_mass_kg * w;
  State state{0.001, 0, 0, 0};
  std::vector<double> forces;  // of the environment, one for each step
  const auto force = [&](const State& s) {
    return l.environment_stiffness_N_per_m * s[2] + l.environment_damping_Ns_per_m * s[3];
  };
  const auto felt = [&](double share) {
    const int now = static_cast<int>(forces.size()) - 1, at = now - delay - (held > 0 ? now % held : 0);
    if (at < 0) return 0.0;
    const auto i = static_cast<std::size_t>(at);
    return held > 0 || share == 0 ? forces[i] : forces[i] + share * (forces[i + 1] - forces[i]);
  };
  const auto slope = [&](const State& s, double share) {
    const double hand =
        -l.feedback_gain * felt(share) - l.damping_Ns_per_m * s[1] - l.stiffness_N_per_m * s[0];
    const double slave = ks * (s[0] - s[2]) + bs * (s[1] - s[3]) - force(s);
    return State{s[1], hand / l.mass_kg, s[3], slave / l.slave_mass_kg};
  };
  const auto moved = [&](const State& k, double share) {
    State s = state;
    for (std::size_t i = 0; i < s.size(); ++i) s[i] += share * kStep_s * k[i];
    return s;
  };
  const auto peak = [&](int steps) {  // the largest |x| in the next steps
    double largest = 0;
    for (int step = 0; step < steps; ++step) {
      forces.push_back(force(state));
      const State k1 = slope(state, 0), k2 = slope(moved(k1, 0.5), 0.5), k3 = slope(moved(k2, 0.5), 0.5),
                  k4 = slope(moved(k3, 1), 1);
      for (std::size_t i = 0; i < state.size(); ++i)
        state[i] += kStep_s / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
      largest = std::max(largest, std::abs(state[0]));
    }
    return largest;
  };
  const int period = static_cast<int>(1 / (frequency_hz * kStep_s));
  peak(25 * period);
  const double before = peak(2 * period);
  peak(13 * period);
  return std::log(peak(2 * period) / before) / (15 * period * kStep_s);
}

int steps(double time_s) {
  return static_cast<int>(std::lround(time_s / kStep_s));
}

std::vector<PositionForceLoop> loops() {
  return {
      {0.5, 300, 5, 2, 5, 1, 3000, 20, 0.3},                                      // slow slave, scaled force
      {0.5, 300, 10, 1, 20, 0.7, 1000, 5, 1},   {1, 0, 20, 2, 10, 1, 200, 0, 1},  // a free hand
      {0.2, 100, 4, 0.5, 15, 0.5, 200, 2, 0.8}, {0.5, 600, 12, 2, 5, 1, 30000, 20, 0.1},
  };
}

TEST(DelayedPositionForce, DecaysBelowTheOnsetAndGrowsAboveIt) {
  for (const PositionForceLoop& loop : loops()) {
    const DelayOnset onset = delay_onset(loop);
    ASSERT_GT(onset.round_trip_s, 0.001);
    ASSERT_LT(onset.round_trip_s, 1);
    const auto growth = [&](double share) {
      return growth_per_s(loop, steps(share * onset.round_trip_s), 0, onset.frequency_hz);
    };
    EXPECT_LT(growth(0.98), 0) << onset.round_trip_s;
    EXPECT_GT(growth(1.02), 0) << onset.round_trip_s;
  }
}

// A hold of the force adds half a tick: the onset with the hold, found between two growths, is 4 ms earlier
// for a tick of 8 ms. The ignored gain of the hold moves it by less than a tenth of that.
TEST(DelayedPositionForce, AHoldActsLikeHalfATick) {
  const PositionForceLoop loop = loops()[0];
  const DelayOnset onset = delay_onset(loop);
  constexpr double kTick_s = 0.008;
  const double expected = onset.round_trip_s - held_round_trip(0, kTick_s, 1);
  const auto growth = [&](double round_trip_s) {
    return growth_per_s(loop, steps(round_trip_s), steps(kTick_s), onset.frequency_hz);
  };
  const double low = expected - 0.002, high = expected + 0.002;
  const double at_low = growth(low), at_high = growth(high);
  ASSERT_LT(at_low, 0);
  ASSERT_GT(at_high, 0);
  const double measured = low - at_low * (high - low) / (at_high - at_low);
  EXPECT_NEAR(measured, expected, 0.1 * 0.5 * kTick_s);
}

// The loop of a slave that is much faster than the hand: m s^2 + d s + k + g K e^(-s T).
PositionForceLoop with_fast_slave(double m, double k, double d, double K) {
  return {m, k, d, 1, 1e5, 1, K, 0, 1};
}

TEST(DelayedPositionForce, AFastSlaveHasTheOnsetOfADelayedSpring) {
  for (const double m : {0.1, 0.5})
    for (const double k : {0.0, 200.0})
      for (const double d : {2.0, 10.0}) {
        constexpr double K = 900;
        // m^2 y^2 + (d^2 - 2 k m) y + k^2 - K^2 = 0
        const double half = (d * d - 2 * k * m) / 2;
        const double y = (-half + std::sqrt(half * half - m * m * (k * k - K * K))) / (m * m),
                     u = std::sqrt(y);
        const double expected = std::atan2(d * u, m * y - k) / u;
        const DelayOnset onset = delay_onset(with_fast_slave(m, k, d, K));
        EXPECT_NEAR(onset.round_trip_s, expected, 1e-5 + 1e-4 * expected);  // the slave: 2 / w = 3e-6 s
        EXPECT_NEAR(onset.frequency_hz, u / (2 * kPi), 1e-4 * u);
      }
}

TEST(DelayedPositionForce, AWeakLoopIsStableWithAnyDelay) {
  EXPECT_EQ(delay_onset(with_fast_slave(0.5, 1000, 50, 900)).round_trip_s, kInfinity);  // d^2 > 2 k m, K < k
  PositionForceLoop loop = loops()[0];
  loop.feedback_gain = 0;
  EXPECT_EQ(delay_onset(loop).round_trip_s, kInfinity);
}

// The roots without delay are the eigenvalues of a companion matrix.
TEST(DelayedPositionForce, HasNoStableDelayWhereItIsUnstableWithoutOne) {
  int unstable = 0, stable = 0;
  for (const double K : {10.0, 300.0, 3000.0, 30000.0})
    for (const double g : {0.03, 0.3, 1.0, 3.0})
      for (const double hz : {1.0, 5.0, 20.0}) {
        const PositionForceLoop l{0.5, 300, 5, 2, hz, 1, K, 5, g};
        const double w = 2 * kPi * hz, ks = 2 * w * w, bs = 4 * w;
        Eigen::Matrix4d a = Eigen::Matrix4d::Zero();
        a << 0, 1, 0, 0, -300 / 0.5, -5 / 0.5, -g * K / 0.5, -g * 5 / 0.5, 0, 0, 0, 1, ks / 2, bs / 2,
            -(ks + K) / 2, -(bs + 5) / 2;
        const bool is_stable = a.eigenvalues().real().maxCoeff() < 0;
        ++(is_stable ? stable : unstable);
        EXPECT_EQ(delay_onset(l).round_trip_s > 0, is_stable) << K << " " << g << " " << hz;
      }
  EXPECT_GT(stable, 5);
  EXPECT_GT(unstable, 5);
}

}  // namespace
}  // namespace remote_touch::haptic_loops_test
