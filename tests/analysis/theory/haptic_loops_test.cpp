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

// The distances of a slave from its command, against an integration of its equation of motion in small steps.

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

// A spring of the hand makes the oscillation faster, which a wall without a damper hardly notices.
TEST(SampledWall, ASpringOfTheHandHardlyMatters) {
  const SampledWall without{0.3, 1, 0, 0, 5};
  SampledWall with = without;
  with.spring_share = 0.25;
  EXPECT_NEAR(exact_wall_limit_N_per_m(with) / exact_wall_limit_N_per_m(without), 1, 0.01);
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
}

// Masses, dampers and stiffnesses have a common factor: it has no meaning.
TEST(SampledWall, ScalesWithTheMass) {
  for (const double factor : {0.001, 7.0}) {
    const SampledWall a{0.2, 1, 3, 0.25, 2, 4};
    const SampledWall b{factor * 0.2, factor * 1, factor * 3, 0.25, 2, 4};
    EXPECT_NEAR(exact_wall_limit_N_per_m(b) / exact_wall_limit_N_per_m(a), factor, 1e-6 * factor);
  }
}

TEST(SampledWall, ADamperThatIsTooLateMakesEveryWallUnstable) {
  EXPECT_EQ(exact_wall_limit_N_per_m(
                {.mass_kg = 0.01, .damping_Ns_per_m = 0.1, .wall_damping_Ns_per_m = 10, .delay_ticks = 5}),
            0);
}

}  // namespace
}  // namespace remote_touch::haptic_loops_test

namespace remote_touch::delayed_position_force_test {
namespace {

// Comparison of the onsets with closed forms and with a direct integration of the delay differential
// equation.

constexpr double kPi = std::numbers::pi, kInfinity = std::numeric_limits<double>::infinity();
constexpr double kStep_s = 1e-5;

using State = std::array<double, 4>;  // x, x', x_s, x_s'

struct Delays {
  int command = 0, force = 0, held = 0;  // steps; held: the duration for which the hand's force is held
};

// The loop in steps of kStep_s with the rule of Runge and Kutta. Signals are linear between steps.
class Simulation {
 public:
  Simulation(const PositionForceLoop& l, const Delays& delays) : l_(l), delays_(delays) {
    const double w = 2 * kPi * l.slave_natural_frequency_hz;
    ks_ = l.slave_mass_kg * w * w, bs_ = 2 * l.slave_damping_ratio * l.slave_mass_kg * w;
    history_.resize(static_cast<std::size_t>(delays.command + delays.force + delays.held + 3));
    store();
  }

  void step() {
    const State k1 = slope(state_, 0), k2 = slope(moved(k1, 0.5), 0.5), k3 = slope(moved(k2, 0.5), 0.5),
                k4 = slope(moved(k3, 1), 1);
    for (int i = 0; i < 4; ++i) state_[i] += kStep_s / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    store();
  }

  // The largest |x| in the next steps.
  double peak(int steps) {
    double largest = 0;
    for (int i = 0; i < steps; ++i) step(), largest = std::max(largest, std::abs(state_[0]));
    return largest;
  }

 private:
  State& at(int i) { return history_[i % history_.size()]; }
  const State& at(int i) const { return history_[i % history_.size()]; }
  void store() { at(count_++) = state_; }

  State moved(const State& k, double share) const {
    State s = state_;
    for (int i = 0; i < 4; ++i) s[i] += share * kStep_s * k[i];
    return s;
  }

  State late(int steps, double share) const {
    const int i = count_ - 1 - steps;
    if (i < 0) return {};
    if (share == 0 || steps == 0) return at(i);
    State s = at(i);
    for (int j = 0; j < 4; ++j) s[j] += share * (at(i + 1)[j] - s[j]);
    return s;
  }

  double force(const State& s) const {
    return l_.environment_stiffness_N_per_m * s[2] + l_.environment_damping_Ns_per_m * s[3];
  }

  State slope(const State& s, double share) const {
    const State command = delays_.command > 0 ? late(delays_.command, share) : s;
    double f = force(delays_.force > 0 ? late(delays_.force, share) : s);
    if (delays_.held > 0) {
      const int since = (count_ - 1) % delays_.held;
      f = force(late(delays_.force + since, 0));
    }
    const double hand = -l_.feedback_gain * f - l_.damping_Ns_per_m * s[1] - l_.stiffness_N_per_m * s[0];
    const double slave = ks_ * (command[0] - s[2]) + bs_ * (command[1] - s[3]) - force(s);
    return {s[1], hand / l_.mass_kg, s[3], slave / l_.slave_mass_kg};
  }

  const PositionForceLoop l_;
  const Delays delays_;
  double ks_ = 0, bs_ = 0;
  State state_{0.001, 0, 0, 0};
  int count_ = 0;
  std::vector<State> history_;  // a ring
};

// Growth of the oscillation, per second, after the other modes have decayed.
double growth_per_s(const PositionForceLoop& loop, const Delays& delays, double frequency_hz) {
  Simulation simulation(loop, delays);
  const int period = static_cast<int>(1 / (frequency_hz * kStep_s));
  simulation.peak(25 * period);
  const double before = simulation.peak(2 * period);
  simulation.peak(13 * period);
  return std::log(simulation.peak(2 * period) / before) / (15 * period * kStep_s);
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
      return growth_per_s(loop, {0, steps(share * onset.round_trip_s)}, onset.frequency_hz);
    };
    EXPECT_LT(growth(0.98), 0) << onset.round_trip_s;
    EXPECT_GT(growth(1.02), 0) << onset.round_trip_s;
  }
}

TEST(DelayedPositionForce, OnlyTheRoundTripMatters) {
  const PositionForceLoop loop = loops()[0];
  const DelayOnset onset = delay_onset(loop);
  const int below = steps(0.98 * onset.round_trip_s), above = steps(1.02 * onset.round_trip_s);
  EXPECT_LT(growth_per_s(loop, {below / 3, below - below / 3}, onset.frequency_hz), 0);
  EXPECT_GT(growth_per_s(loop, {above / 3, above - above / 3}, onset.frequency_hz), 0);
}

// A hold of the force adds half a tick: the onset with the hold, found between two growths, is 4 ms earlier
// for a tick of 8 ms. The ignored gain of the hold moves it by less than a tenth of that.
TEST(DelayedPositionForce, AHoldActsLikeHalfATick) {
  const PositionForceLoop loop = loops()[0];
  const DelayOnset onset = delay_onset(loop);
  constexpr double kTick_s = 0.008;
  const double expected = onset.round_trip_s - held_round_trip(0, kTick_s, 1);
  const auto growth = [&](double round_trip_s) {
    return growth_per_s(loop, {0, steps(round_trip_s), steps(kTick_s)}, onset.frequency_hz);
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

// T = d / K for short delays: the line of T. Hulin et al. for a wall without damping.
TEST(DelayedPositionForce, AStiffWallAtAShortDelayHasHulinsLine) {
  const double tick_s = 0.001, d = 0.1, round_trip_s = held_round_trip(0.002, tick_s, 1);
  const double stiffness = d / round_trip_s;
  EXPECT_GT(delay_onset(with_fast_slave(0.1, 0, d, 0.99 * stiffness)).round_trip_s, round_trip_s);
  EXPECT_LT(delay_onset(with_fast_slave(0.1, 0, d, 1.01 * stiffness)).round_trip_s, round_trip_s);
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
}  // namespace remote_touch::delayed_position_force_test
