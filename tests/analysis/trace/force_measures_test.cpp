// The force as it is felt: its changes, how it settles, and what a hand perceives of it.
#include "analysis/trace/force_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "analysis/trace/measures.h"
#include "tests/analysis/trace/example_traces.h"

namespace remote_touch::force_measures_test {
namespace {

using namespace example_traces;

// A run with a new frame every frame_ticks ticks, whose force has these values, or points up with these
// sizes.
Trace run_with(const std::vector<Vec3>& force_N, int frame_ticks) {
  std::vector<Tick> ticks;
  for (std::size_t i = 0; i < force_N.size(); ++i)
    ticks.push_back({.force_N = force_N[i], .frame = static_cast<int>(i) / frame_ticks});
  return run_of(ticks);
}
Trace run_up(const std::vector<double>& size_N, int frame_ticks) {
  std::vector<Vec3> force_N;
  for (const double each_N : size_N) force_N.emplace_back(0, each_N, 0);
  return run_with(force_N, frame_ticks);
}
template <class Force>
Trace run_along(int ticks, Force&& force_N) {
  std::vector<Vec3> all_N;
  for (int i = 0; i < ticks; ++i) all_N.push_back(force_N(i));
  return run_with(all_N, 33);
}
template <class Size>
Trace run_up_along(int ticks, Size&& size_N) {
  return run_along(ticks, [&](int i) { return Vec3(0, size_N(i), 0); });
}

// --- changes ---

// The force changes at frame updates from 0 to 5, 6 to 9, 8 to 4, 0 to 0 and 0 to 7 N, and between them by 1,
// 1, 2 and 2 N. The torque of a tool is measured like the force, and guidance is no part of it.
TEST(ForceChange, IsMeasuredAtUpdatesAndBetweenThem) {
  const std::vector<Tick> ticks = {pushed(0, 0), pushed(5, 1), pushed(6, 1), pushed(9, 2), pushed(8, 2),
                                   pushed(4, 3), pushed(2, 3), pushed(0, 3), pushed(0, 4), pushed(7, 5)};
  std::vector<Tick> turned = ticks, guided = ticks;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    turned[i].torque_Nm = ticks[i].force_N, turned[i].force_N = Vec3(1, 1, 1);
    guided[i].guidance_N = Vec3(std::pow(2.0, static_cast<double>(i % 5)), 8, -4);
    guided[i].force_N += *guided[i].guidance_N;
  }
  const double rms_jump = std::sqrt((25.0 + 9 + 16 + 49) / 4), noise = std::sqrt((1.0 + 1 + 4 + 4) / 4);
  for (const auto& of_force : {ticks, guided})
    expect_values(run_of(of_force),
                  {{"max_force_jump", 7}, {"rms_force_jump", rms_jump}, {"force_noise", noise}});
  expect_values(run_of(turned),
                {{"max_torque_jump", 7}, {"rms_torque_jump", rms_jump}, {"torque_noise", noise}});
  for (const auto measure : {max_torque_jump_Nm, rms_torque_jump_Nm, torque_noise_Nm})
    EXPECT_TRUE(std::isnan(measure(run_of(ticks))));
}

TEST(ForceChange, IsTheLengthOfTheDifferenceAlsoIfTheForceTurnsOrIsLost) {
  expect_values(run_of({pushed(3, 0), pushed(8, 0), pushed(0, 1), pushed(0, 2)}),
                {{"max_force_jump", 8}, {"rms_force_jump", 8}});
  const std::vector<Vec3> turns = {{3, 0, 0}, {0, 0, 4}};
  EXPECT_EQ(force_noise_N(run_with(turns, 2)), 5);
  EXPECT_EQ(max_force_jump_N(run_with(turns, 1)), 5);
}

TEST(ForceChange, IsNanIfNoChangeCounts) {
  for (const auto& ticks : {std::vector<Tick>{}, {pushed(1, 0)}, {pushed(0, 0), pushed(0, 1), pushed(0, 1)}})
    for (const auto measure : {max_force_jump_N, rms_force_jump_N, force_noise_N})
      EXPECT_TRUE(std::isnan(measure(run_of(ticks)))) << ticks.size();
  EXPECT_TRUE(std::isnan(max_force_jump_N(run_of({pushed(1, 0), pushed(2, 0)}))));
  EXPECT_TRUE(std::isnan(force_noise_N(run_of({pushed(1, 0), pushed(2, 1)}))));
}

// --- how a force settles ---

// A force of this size, over time, from the tick at 0.2 s on. The first frame comes then.
template <class Size>
Trace step_response(Size&& size_N, double until_s = 1) {
  std::vector<Tick> ticks;
  for (int i = 0; 0.001 * i < until_s; ++i)
    ticks.push_back(pushed(i < 200 ? 0 : size_N(0.001 * (i - 200)), 0));
  return run_of(ticks);
}

// A damped oscillation about 4 N, from 0 at its start. With the damping ratio zeta, its first overshoot is
// exp(-pi zeta / sqrt(1 - zeta^2)) of the final value, after half a period.
TEST(ForceChange, OvershootAndSettlingTimeAreThoseOfADampedOscillator) {
  constexpr double kFrequency = 60;  // rad/s, undamped
  for (const double zeta : {0.2, 0.3, 0.5}) {
    const double damped = std::sqrt(1 - zeta * zeta);
    const auto part_at = [&](double t) {  // part of the final value that is missing
      return std::exp(-zeta * kFrequency * t) *
             (std::cos(damped * kFrequency * t) + zeta / damped * std::sin(damped * kFrequency * t));
    };
    const Trace trace = step_response([&](double t) { return 4 * (1 - part_at(t + 0.001)); });
    EXPECT_NEAR(value("force_overshoot", trace), std::exp(-M_PI * zeta / damped), 0.002) << zeta;
    int last_outside = 0;
    for (int i = 0; i < 700; ++i)
      if (std::abs(part_at(0.001 * i)) > kSettledBand) last_outside = i;
    EXPECT_NEAR(value("force_settling_time", trace), 0.001 * last_outside, 0.0011) << zeta;
  }
}

TEST(ForceChange, AForceThatDoesNotExceedItsEndHasNoOvershoot) {
  for (int i = 1; i < 200; ++i) {  // the mean of equal forces is rounded up or down
    const Trace constant = step_response([&](double) { return 0.07 * i; }, 0.4);
    EXPECT_EQ(force_overshoot(constant), 0) << i;
    EXPECT_EQ(force_settling_time_s(constant), 0) << i;
  }
  const Trace rises = step_response([](double t) { return 3 * std::min(1.0, t / 0.3 + 0.001); });
  EXPECT_EQ(force_overshoot(rises), 0);
  EXPECT_NEAR(force_settling_time_s(rises), 0.95 * 0.3, 0.002);
}

TEST(ForceChange, ARunThatIsNotSteadyAtItsEndDoesNotSettle) {
  const std::vector<Trace> unsteady = {
      step_response([](double t) { return 1 + 10 * t; }),
      step_response([](double) { return 0.0; }),
      step_response([](double t) { return t < 0.75 ? 3.0 : 0.0; }),
      step_response([](double) { return 3.0; }, 0.25),
      step_response([](double t) { return t > 0.3 && t < 0.302 ? std::nan("") : 3.0; }),
      Trace()};
  for (const Trace& trace : unsteady) expect_no_values(trace, {"force_overshoot", "force_settling_time"});
}

// Each threshold belongs to a measure of the same unit, with a meaning and a source that ends with its year.
TEST(PerceptionThresholds, BelongToMeasuresAndHaveASource) {
  std::set<std::string> names;
  for (const PerceptionThreshold& threshold : perception_thresholds()) {
    const Measure& measure = measure_named(threshold.measure);
    EXPECT_EQ(measure.unit, threshold.unit) << threshold.measure;
    EXPECT_TRUE(measure.better == Better::smaller || measure.better == Better::near_zero)
        << threshold.measure;
    EXPECT_TRUE(is_below(threshold, -0.99 * threshold.value) && is_below(threshold, 0)) << threshold.measure;
    EXPECT_FALSE(is_below(threshold, threshold.value) || is_below(threshold, -threshold.value) ||
                 is_below(threshold, kUnknown))
        << threshold.measure;
    EXPECT_TRUE(names.insert(threshold.measure).second) << threshold.measure << " appears twice";
    EXPECT_FALSE(std::string(threshold.meaning).empty());
    const std::string source = threshold.source;
    ASSERT_GT(source.size(), 4u);
    EXPECT_TRUE(std::all_of(source.end() - 4, source.end(), [](char c) { return c >= '0' && c <= '9'; }))
        << source;
  }
  EXPECT_TRUE(names.contains("apparent_friction") && names.contains("max_relative_jump"));
}

// --- jumps that are felt, and packets ---

// Every tick has a frame update. The force changes by 5 % (4 to 4.2), 7.1 % (to 4.5) and -11 % (to 4), ends,
// and begins again. The pair without any force (0 to 0) does not count.
TEST(PerceivedForce, AJumpExceedsTheFractionOfTheForceBefore) {
  const Trace trace = run_up({4, 4.2, 4.5, 4, 0, 0, 1}, 1);
  EXPECT_EQ(felt_jump_fraction(trace, 0.04), 1);
  EXPECT_EQ(felt_jump_fraction(trace, 0.06), 0.8);
  EXPECT_EQ(felt_jump_fraction(trace, 1), 0.2);  // a force that begins is above any fraction
  expect_values(trace, {{"jump_fraction_5", felt_jump_fraction(trace, 0.05)},
                        {"jump_fraction_10", 0.6},
                        {"jump_fraction_20", 0.4}});
  expect_values(run_up({1, 9, 9, 1}, 2), {{"jump_fraction_20", 0}});
  for (const Trace& none : {run_up({1, 9}, 2), run_up({0, 0}, 1), Trace()})
    expect_no_values(none, {"jump_fraction_20"});
}

// A force that turns by an angle a changes by 2 sin(a / 2) times its magnitude.
TEST(PerceivedForce, AForceThatTurnsChanges) {
  const double angle = 0.15;
  const Trace trace = run_with({{2, 0, 0}, {2 * std::cos(angle), 2 * std::sin(angle), 0}}, 1);
  EXPECT_EQ(felt_jump_fraction(trace, 2 * std::sin(angle / 2) - 1e-9), 1);
  EXPECT_EQ(felt_jump_fraction(trace, 2 * std::sin(angle / 2) + 1e-9), 0);
}

// The force is exp(a t). A packet is sent when the force has grown by the factor 1 + d, so every ceil(ln(1 +
// d) / a) ticks.
TEST(PerceivedForce, ExponentialForceSendsPacketsAtEqualTimes) {
  const double per_tick = 0.003;
  const Trace trace = run_up_along(1000, [&](int i) { return std::exp(per_tick * i); });
  for (const int percent : {5, 10, 20}) {
    const int between = static_cast<int>(std::ceil(std::log1p(percent / 100.) / per_tick));
    EXPECT_NEAR(value("packet_rate_" + std::to_string(percent), trace), 1 + 999 / between, 1e-9) << percent;
  }
}

// If two forces alternate, every tick is a packet if they differ by more than the fraction, else only the
// first.
TEST(PerceivedForce, AForceThatEndsIsSentOnceAndNoMore) {
  const auto packets = [](double weber, auto&& size_N) {
    return 0.1 * deadband_packets_per_s(run_up_along(100, size_N), weber);
  };
  const auto alternating = [](int i) { return i % 2 ? 1.0 : 1.3; };
  EXPECT_NEAR(packets(0.1, [](int i) { return i < 50 ? 1.0 : 0.0; }), 2, 1e-10);
  EXPECT_NEAR(packets(0.1, [](int) { return 0.0; }), 1, 1e-10);
  EXPECT_NEAR(packets(0.2, alternating), 100, 1e-10);
  EXPECT_NEAR(packets(0.31, alternating), 1, 1e-10);
  EXPECT_TRUE(std::isnan(deadband_packets_per_s(run_up({1}, 1), 0.1)));
}

// --- Weber fractions ---

TEST(WeberFraction, IsTheLargestChangeRelativeToTheForceBefore) {
  // Updates at ticks 2 and 4: 4 to 5 N (0.25) and 5 to 4 N (0.2). The largest other change is 4 to 4.4 N
  // (0.1).
  expect_values(run_up({4, 4, 5, 5, 4, 4.4}, 2), {{"max_relative_jump", 0.25}, {"max_relative_change", 0.1}});
  // The end of a force and a turn count, but not the begin.
  EXPECT_EQ(max_relative_jump(run_up({3, 0, 9}, 1)), 1);
  EXPECT_NEAR(max_relative_jump(run_with({{2, 0, 0}, {0, 2, 0}}, 1)), std::sqrt(2.0), 1e-15);
}

// The force grows by 0.5 N in each tick, and by 0.3 N more with the frame at tick 3.
TEST(WeberFraction, OfAJumpIsWithoutTheChangeOfAMovingHand) {
  expect_values(run_up({1, 1.5, 2, 2.8, 3.3}, 3),
                {{"max_relative_jump", 0.3 / 2}, {"max_relative_change", 0.5}}, 1e-12);
  EXPECT_NEAR(max_relative_jump(run_up({0, 1, 2}, 2)), 1, 1e-12) << "a force begins";
}

TEST(WeberFraction, NeedsTheLeastForceBeforeTheChange) {
  EXPECT_NEAR(max_relative_jump(run_up({kMinWeberForce_N, 5}, 1)), 49, 1e-12);
  for (const Trace& none : {run_up({0.99 * kMinWeberForce_N, 5}, 1), run_up({1, 2}, 2), Trace()})
    EXPECT_TRUE(std::isnan(max_relative_jump(none)));
  EXPECT_TRUE(std::isnan(max_relative_change(run_up({1, 2}, 1))));
}

// --- friction ---

Tick slide(const Vec3& hip_m, const Vec3& force_N, const Vec3& normal = Vec3::UnitY()) {
  return {.force_N = force_N, .hip_m = hip_m, .normal = normal};
}

// Coulomb friction on a leaning plane: the hand wanders along it, and in and out of it.
TEST(ApparentFriction, IsTheCoefficientOfCoulombFriction) {
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  const Eigen::Quaterniond lean = rotation(Vec3(0.3, -0.7, 0.5));
  for (const double mu : {0.0, 0.15, 0.8, -0.1}) {
    std::vector<Tick> ticks;
    Vec3 hip(0.1, 0, 0.2);
    for (int i = 0; i < 200; ++i) {
      const Vec3 step(1e-4 * gauss(random), 0, 1e-4 * gauss(random));
      hip += step + Vec3(0, 1e-5 * gauss(random), 0);
      const double newtons = 1 + std::abs(gauss(random));
      const Vec3 force_N = newtons * (Vec3::UnitY() - mu * step.normalized());
      ticks.push_back(slide(lean * hip, lean * force_N, lean * Vec3::UnitY()));
    }
    EXPECT_NEAR(apparent_friction(run_of(ticks)), mu, 1e-9) << mu;
  }
}

// The force tilts by 0.2 to the left and right of the path in turn: the hand feels no friction.
TEST(ApparentFriction, IsNoneIfTheForceTiltsAcrossOrToBothSides) {
  std::vector<Tick> across, both;
  for (int i = 0; i < 101; ++i) {
    const double side = i % 2 ? 0.2 : -0.2;
    across.push_back(slide({1e-4 * i, 0, 0}, {0, 1, side}));
    both.push_back(slide({1e-4 * i, 0, 0}, {side, 1, 0}));
  }
  EXPECT_NEAR(apparent_friction(run_of(across)), 0, 1e-12);
  EXPECT_NEAR(apparent_friction(run_of(both)), 0, 1e-12);
}

TEST(ApparentFriction, UsesTicksThatSlideInContact) {
  const double slow_m = 0.9 * kSliding_m_per_s * 0.001, fast_m = 1.1 * kSliding_m_per_s * 0.001;
  const Vec3 large_N(-9, 1, 0);
  Tick free = slide({1, 0, 0}, large_N);
  free.state = ContactState::free;
  expect_values(run_of({slide({0, 0, 0}, large_N),                     // has no tick before it
                        slide({slow_m, 0, 0}, large_N),                // too slow
                        slide({slow_m + fast_m, 0, 0}, {-0.5, 1, 0}),  // counts
                        free, slide({2, 0, 0}, large_N, kUnknownVector),
                        slide({3, 0, 0}, {-9, -1, 0}),  // pulls into the surface
                        slide({3, 1, 0}, large_N)}),    // moves along the normal
                {{"apparent_friction", 0.5}});
  expect_no_values(run_of({slide({0, 0, 0}, large_N)}), {"apparent_friction"});
}

// --- ripple ---

// The mean of a sine over an odd number of ticks is its middle times sin(n a / 2) / (n sin(a / 2)), with a
// the phase of a tick.
double ripple_factor(double frequency_Hz) {
  const int ticks = 101;
  const double half_phase = M_PI * frequency_Hz * 0.001;
  return std::abs(1 - std::sin(ticks * half_phase) / (ticks * std::sin(half_phase)));
}

TEST(Ripple, OfASineIsItsRmsTimesTheFactorOfItsFrequency) {
  for (const double frequency_Hz : {2.0, 5.0, 10.0, 25.0, 90.0}) {
    const auto wave = [&](int i) { return std::sin(2 * M_PI * frequency_Hz * 0.001 * i); };
    // 1000 of the 1100 ticks have a whole window: whole periods.
    const Trace trace = run_along(1100, [&](int i) { return Vec3(0, 3, 0.5 * wave(i)); });
    const double rms = 0.5 * std::sqrt(0.5) * ripple_factor(frequency_Hz);
    EXPECT_NEAR(force_ripple_N(trace), rms, 1e-11) << frequency_Hz;
  }
}

TEST(Ripple, IsNoneForAForceThatIsLinearInTime) {
  const Trace trace = run_along(400, [](int i) { return Vec3(1 + 0.01 * i, 2, 3 - 0.002 * i); });
  expect_values(trace, {{"force_ripple", 0}, {"relative_ripple", 0}}, 1e-12);
}

// A window of 101 ticks has 51 with the sign of its middle, and 50 with the other one.
TEST(Ripple, IsRelativeToTheMeanForce) {
  const Trace trace = run_up_along(300, [](int i) { return i % 2 ? 4.1 : 3.9; });
  const double ripple = 0.1 * (1 - 1.0 / 101);
  expect_values(trace, {{"force_ripple", ripple}, {"relative_ripple", ripple / 4}}, 1e-12);
}

// Contacts of 90 and 120 ticks: only 20 ticks of the second one have a whole window, and a window has at
// least three ticks.
TEST(Ripple, CountsOnlyWholeWindowsInContact) {
  const auto force_N = [](int i) { return i < 90 || (i >= 200 && i < 320) ? 2.0 : 0.0; };
  const auto constant_N = [](int) { return 1.0; };
  EXPECT_EQ(force_ripple_N(run_up_along(400, force_N)), 0);
  EXPECT_EQ(force_ripple_N(run_up_along(101, constant_N)), 0);
  const Trace slow = run_of(std::vector<Tick>(50, pushed(2)), 0.06);
  for (const Trace& none : {run_up_along(100, force_N), run_up_along(100, [](int) { return 0.0; }),
                            run_up_along(99, constant_N), slow, Trace()})
    expect_no_values(none, {"force_ripple", "relative_ripple"});
}

}  // namespace
}  // namespace remote_touch::force_measures_test
