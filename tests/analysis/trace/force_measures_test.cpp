#include "analysis/trace/force_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <vector>

#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "tests/analysis/trace/measure_named.h"

namespace remote_touch::force_measures_test {
namespace {

struct Tick {
  Vec3 force_N = Vec3::Zero();
  int frame = 0;
};

Trace trace_of(const std::vector<Tick>& ticks, bool tool = false) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.frame_index = tick.frame;
    out.force_N = tool ? Vec3(1, 1, 1) : tick.force_N;
    if (tool) out.tool.emplace().torque_Nm = tick.force_N;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out, {});
  }
  return trace;
}

Tick pushed(double force_y_N, int frame) {
  return {{0, force_y_N, 0}, frame};
}

// The force changes at frame updates from 0 to 5, 6 to 9, 8 to 4, 0 to 0 and 0 to 7 N, and between them by 1,
// 1, 2 and 2 N.
const std::vector<Tick> kTicks = {pushed(0, 0), pushed(5, 1), pushed(6, 1), pushed(9, 2), pushed(8, 2),
                                  pushed(4, 3), pushed(2, 3), pushed(0, 3), pushed(0, 4), pushed(7, 5)};

TEST(ForceChange, IsMeasuredAtUpdatesAndBetweenThem) {
  const Trace trace = trace_of(kTicks);
  EXPECT_EQ(max_force_jump_N(trace), 7);
  EXPECT_NEAR(rms_force_jump_N(trace), std::sqrt((25.0 + 9 + 16 + 49) / 4), 1e-15);
  EXPECT_NEAR(force_noise_N(trace), std::sqrt((1.0 + 1 + 4 + 4) / 4), 1e-15);
}

TEST(ForceChange, AForceThatIsLostAtAnUpdateIsAJump) {
  EXPECT_EQ(max_force_jump_N(trace_of({pushed(3, 0), pushed(8, 0), pushed(0, 1), pushed(0, 2)})), 8);
  EXPECT_EQ(rms_force_jump_N(trace_of({pushed(3, 0), pushed(8, 0), pushed(0, 1), pushed(0, 2)})), 8);
}

TEST(ForceChange, IsTheLengthOfTheDifferenceWhenTheForceTurns) {
  EXPECT_EQ(force_noise_N(trace_of({{{3, 0, 0}, 0}, {{0, 0, 4}, 0}})), 5);
  EXPECT_EQ(max_force_jump_N(trace_of({{{3, 0, 0}, 0}, {{0, 0, 4}, 1}})), 5);
}

TEST(ForceChange, IsNanIfNoChangeCounts) {
  for (const auto& ticks : {std::vector<Tick>{}, {pushed(1, 0)}, {pushed(0, 0), pushed(0, 1), pushed(0, 1)}})
    for (const auto measure : {max_force_jump_N, rms_force_jump_N, force_noise_N})
      EXPECT_TRUE(std::isnan(measure(trace_of(ticks)))) << ticks.size();
  EXPECT_TRUE(std::isnan(max_force_jump_N(trace_of({pushed(1, 0), pushed(2, 0)}))));
  EXPECT_TRUE(std::isnan(force_noise_N(trace_of({pushed(1, 0), pushed(2, 1)}))));
}

TEST(ForceChange, TheTorqueOfAToolIsMeasuredLikeTheForce) {
  const Trace trace = trace_of(kTicks, true);
  EXPECT_EQ(max_torque_jump_Nm(trace), 7);
  EXPECT_NEAR(rms_torque_jump_Nm(trace), std::sqrt((25.0 + 9 + 16 + 49) / 4), 1e-15);
  EXPECT_NEAR(torque_noise_Nm(trace), std::sqrt((1.0 + 1 + 4 + 4) / 4), 1e-15);
  for (const auto measure : {max_torque_jump_Nm, rms_torque_jump_Nm, torque_noise_Nm})
    EXPECT_TRUE(std::isnan(measure(trace_of(kTicks))));
}

// --- how a force settles ---

// A force of this size, over time, from the tick at 0.2 s on. The first frame comes then.
template <class Size>
Trace step_response(Size&& size_N, double until_s = 1) {
  std::vector<Tick> ticks;
  for (int i = 0; 0.001 * i < until_s; ++i)
    ticks.push_back(pushed(i < 200 ? 0 : size_N(0.001 * (i - 200)), 0));
  return trace_of(ticks);
}

// A damped oscillation about 4 N, from 0 at its start. With the damping ratio zeta, its first overshoot is
// exp(-pi zeta / sqrt(1 - zeta^2)) of the final value, after half a period.
TEST(ForceChange, OvershootAndSettlingTimeAreThoseOfADampedOscillator) {
  constexpr double kPi = 3.14159265358979323846, kFrequency = 60;  // rad/s, undamped
  for (const double zeta : {0.2, 0.3, 0.5}) {
    const double damped = std::sqrt(1 - zeta * zeta);
    const auto part_at = [&](double t) {  // part of the final value that is missing
      return std::exp(-zeta * kFrequency * t) *
             (std::cos(damped * kFrequency * t) + zeta / damped * std::sin(damped * kFrequency * t));
    };
    const Trace trace = step_response([&](double t) { return 4 * (1 - part_at(t + 0.001)); });
    EXPECT_NEAR(force_overshoot(trace), std::exp(-kPi * zeta / damped), 0.002) << zeta;
    int last_outside = 0;
    for (int i = 0; i < 700; ++i)
      if (std::abs(part_at(0.001 * i)) > kSettledBand) last_outside = i;
    EXPECT_NEAR(force_settling_time_s(trace), 0.001 * last_outside, 0.0011) << zeta;
  }
}

TEST(ForceChange, AForceThatIsThereAtOnceHasNoOvershoot) {
  const Trace constant = step_response([](double) { return 3.0; });
  EXPECT_EQ(force_overshoot(constant), 0);
  EXPECT_EQ(force_settling_time_s(constant), 0);
  const Trace rises = step_response([](double t) { return 3 * std::min(1.0, t / 0.3 + 0.001); });
  EXPECT_EQ(force_overshoot(rises), 0);
  EXPECT_NEAR(force_settling_time_s(rises), 0.95 * 0.3, 0.002);
}

// The mean of equal forces is rounded up or down.
TEST(ForceChange, NoForceThatStaysHasAnOvershoot) {
  for (int i = 1; i < 200; ++i)
    EXPECT_EQ(force_overshoot(step_response([&](double) { return 0.07 * i; }, 0.4)), 0) << i;
}

TEST(ForceChange, ARunThatIsNotSteadyAtItsEndDoesNotSettle) {
  const std::vector<Trace> unsteady = {
      step_response([](double t) { return 1 + 10 * t; }),
      step_response([](double) { return 0.0; }),
      step_response([](double t) { return t < 0.75 ? 3.0 : 0.0; }),
      step_response([](double) { return 3.0; }, 0.25),
      step_response([](double t) { return t > 0.3 && t < 0.302 ? std::nan("") : 3.0; }),
      Trace()};
  for (std::size_t i = 0; i < unsteady.size(); ++i) {
    EXPECT_TRUE(std::isnan(force_overshoot(unsteady[i]))) << i;
    EXPECT_TRUE(std::isnan(force_settling_time_s(unsteady[i]))) << i;
  }
}

TEST(ForceChange, GuidanceIsNoPartOfIt) {
  Trace trace = trace_of(kTicks);
  const double jump_N = max_force_jump_N(trace), noise_N = force_noise_N(trace);
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const Vec3 pull_N(std::pow(2.0, static_cast<double>(i % 5)), 8, -4);
    trace.force_N[i] += pull_N;
    trace.guidance_force_N.push_back(pull_N);
    trace.guidance_goal_m.push_back(Vec3::Zero());
  }
  EXPECT_EQ(max_force_jump_N(trace), jump_N);
  EXPECT_EQ(force_noise_N(trace), noise_N);
}

TEST(PerceptionThresholds, BelongToMeasuresOfTheSameUnit) {
  std::set<std::string> names;
  for (const PerceptionThreshold& threshold : perception_thresholds()) {
    const auto& measures = built_in_measures();
    const auto found = std::find_if(measures.begin(), measures.end(),
                                    [&](const Measure& one) { return one.name == threshold.measure; });
    ASSERT_NE(found, measures.end()) << threshold.measure;
    EXPECT_EQ(found->unit, threshold.unit) << threshold.measure;
    EXPECT_TRUE(found->better == Better::smaller || found->better == Better::near_zero) << threshold.measure;
    EXPECT_GT(threshold.value, 0) << threshold.measure;
    EXPECT_TRUE(names.insert(threshold.measure).second) << threshold.measure << " appears twice";
  }
  EXPECT_TRUE(names.contains("max_relative_jump"));
  EXPECT_TRUE(names.contains("apparent_friction"));
}

TEST(PerceptionThresholds, StateTheirMeaningAndSource) {
  for (const PerceptionThreshold& threshold : perception_thresholds()) {
    EXPECT_FALSE(std::string(threshold.meaning).empty());
    const std::string source = threshold.source;
    ASSERT_GT(source.size(), 4u);
    EXPECT_TRUE(std::all_of(source.end() - 4, source.end(), [](char c) { return c >= '0' && c <= '9'; }))
        << source << " does not end with a year";
  }
}

TEST(PerceptionThresholds, CompareMagnitudes) {
  const PerceptionThreshold threshold{"friction", "1", 0.5, "", ""};
  EXPECT_TRUE(is_below(threshold, 0));
  EXPECT_TRUE(is_below(threshold, -0.49));
  EXPECT_FALSE(is_below(threshold, 0.5));
  EXPECT_FALSE(is_below(threshold, -0.5));
  EXPECT_FALSE(is_below(threshold, std::numeric_limits<double>::quiet_NaN()));
}

}  // namespace
}  // namespace remote_touch::force_measures_test

namespace remote_touch::perceived_force_measures_test {
namespace {

// One tick every millisecond, and a new frame every frame_ticks ticks.
Trace trace_of(const std::vector<Vec3>& force_N, int frame_ticks) {
  Trace trace;
  for (const Vec3& one : force_N) {
    RenderOutput out;
    out.force_N = one;
    out.frame_index = static_cast<int>(trace.length()) / frame_ticks;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out, {});
  }
  return trace;
}

template <class Force>
Trace trace_along(int ticks, Force&& newtons) {
  std::vector<Vec3> force_N;
  for (int i = 0; i < ticks; ++i) force_N.push_back({0, newtons(i), 0});
  return trace_of(force_N, 10);
}

TEST(PerceivedForce, AJumpExceedsTheFractionOfTheForceBefore) {
  // Every tick has a frame update. The force changes by 5 % (4 to 4.2), 7.1 % (to 4.5) and -11 % (to 4),
  // ends, and begins again. The pair without any force (0 to 0) does not count.
  const Trace trace =
      trace_of({{0, 4, 0}, {0, 4.2, 0}, {0, 4.5, 0}, {0, 4, 0}, {0, 0, 0}, {0, 0, 0}, {0, 1, 0}}, 1);
  EXPECT_EQ(felt_jump_fraction(trace, 0.04), 1);
  EXPECT_EQ(felt_jump_fraction(trace, 0.06), 0.8);
  EXPECT_EQ(felt_jump_fraction(trace, 0.1), 0.6);
  EXPECT_EQ(felt_jump_fraction(trace, 0.2), 0.4);
  EXPECT_EQ(felt_jump_fraction(trace, 1), 0.2);  // a force that begins is above any fraction
}

TEST(PerceivedForce, HasNoJumpBetweenUpdatesOrWithoutForce) {
  EXPECT_EQ(felt_jump_fraction(trace_of({{0, 1, 0}, {0, 9, 0}, {0, 9, 0}, {0, 1, 0}}, 2), 0.2), 0);
  EXPECT_TRUE(std::isnan(felt_jump_fraction(trace_of({{0, 1, 0}, {0, 9, 0}}, 2), 0.2)));
  EXPECT_TRUE(std::isnan(felt_jump_fraction(trace_of({{0, 0, 0}, {0, 0, 0}}, 1), 0.2)));
  EXPECT_TRUE(std::isnan(felt_jump_fraction(Trace(), 0.2)));
}

// A force that turns by an angle a changes by 2 sin(a / 2) times its magnitude.
TEST(PerceivedForce, AForceThatTurnsChanges) {
  const double angle = 0.15;
  const Trace trace = trace_of({{2, 0, 0}, {2 * std::cos(angle), 2 * std::sin(angle), 0}}, 1);
  EXPECT_EQ(felt_jump_fraction(trace, 2 * std::sin(angle / 2) - 1e-9), 1);
  EXPECT_EQ(felt_jump_fraction(trace, 2 * std::sin(angle / 2) + 1e-9), 0);
}

// The force is exp(a t). A packet is sent when the force has grown by the factor 1 + d, so every ceil(ln(1 +
// d) / a) ticks.
TEST(PerceivedForce, ExponentialForceSendsPacketsAtEqualTimes) {
  const double per_tick = 0.003;
  const Trace trace = trace_along(1000, [&](int i) { return std::exp(per_tick * i); });
  for (const double weber : {0.05, 0.1, 0.2}) {
    const int between = static_cast<int>(std::ceil(std::log1p(weber) / per_tick));
    EXPECT_NEAR(deadband_packets_per_s(trace, weber), 1 + 999 / between, 1e-9) << weber;
  }
}

// If two forces alternate, every tick is a packet if they differ by more than the fraction, else only the
// first.
TEST(PerceivedForce, AForceThatEndsIsSentOnceAndNoMore) {
  const Trace trace = trace_along(100, [](int i) { return i < 50 ? 1.0 : 0.0; });
  EXPECT_NEAR(deadband_packets_per_s(trace, 0.1), 2 / 0.1, 1e-9);
  EXPECT_NEAR(deadband_packets_per_s(trace_along(100, [](int) { return 0.0; }), 0.1), 1 / 0.1, 1e-9);
  EXPECT_NEAR(deadband_packets_per_s(trace_along(100, [](int i) { return i % 2 ? 1.0 : 1.3; }), 0.2),
              100 / 0.1, 1e-9);
  EXPECT_NEAR(deadband_packets_per_s(trace_along(100, [](int i) { return i % 2 ? 1.0 : 1.3; }), 0.31),
              1 / 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(deadband_packets_per_s(trace_along(1, [](int) { return 1.0; }), 0.1)));
}

TEST(PerceivedForce, MeasuresAreInTheTableAtThreeFractions) {
  const Trace trace = trace_along(200, [](int i) { return 1 + 0.01 * (i / 10) * (i % 20 < 10 ? 1 : -1); });
  const auto value = [&](const std::string& name) { return measure_named(name).compute(trace); };
  for (const int percent : {5, 10, 20}) {
    const std::string end = "_" + std::to_string(percent);
    EXPECT_EQ(value("jump_fraction" + end), felt_jump_fraction(trace, percent / 100.)) << percent;
    EXPECT_EQ(value("packet_rate" + end), deadband_packets_per_s(trace, percent / 100.)) << percent;
  }
  EXPECT_GT(value("jump_fraction_5"), value("jump_fraction_20"));
  EXPECT_GT(value("packet_rate_5"), value("packet_rate_20"));
}

}  // namespace
}  // namespace remote_touch::perceived_force_measures_test

namespace remote_touch::perceived_measures_test {
namespace {

// Weber fractions, apparent friction and ripple: traces whose values follow from a formula.

constexpr double kTick_s = 0.001;

// One tick every millisecond, and a new frame every frame_ticks ticks.
Trace pushed(const std::vector<Vec3>& force_N, int frame_ticks) {
  Trace trace;
  for (const Vec3& one : force_N) {
    RenderOutput out;
    out.force_N = one;
    out.frame_index = static_cast<int>(trace.length()) / frame_ticks;
    trace.append(kTick_s * static_cast<double>(trace.length()), {}, out, {});
  }
  return trace;
}

template <class Force>
Trace pushed_along(int ticks, Force&& newtons) {
  std::vector<Vec3> force_N;
  for (int i = 0; i < ticks; ++i) force_N.push_back(newtons(i));
  return pushed(force_N, 33);
}

TEST(WeberFraction, IsTheLargestChangeRelativeToTheForceBefore) {
  // Updates at ticks 2 and 4: 4 to 5 N (0.25) and 5 to 4 N (0.2). The largest other change is 4 to 4.4 N
  // (0.1).
  const Trace trace = pushed({{0, 4, 0}, {0, 4, 0}, {0, 5, 0}, {0, 5, 0}, {0, 4, 0}, {0, 4.4, 0}}, 2);
  EXPECT_NEAR(max_relative_jump(trace), 0.25, 1e-15);
  EXPECT_NEAR(max_relative_change(trace), 0.1, 1e-15);
}

// The force grows by 0.5 N in each tick, and by 0.3 N more with the frame at tick 3.
TEST(WeberFraction, OfAJumpIsWithoutTheChangeOfAMovingHand) {
  const std::vector<Vec3> force_N = {{0, 1, 0}, {0, 1.5, 0}, {0, 2, 0}, {0, 2.8, 0}, {0, 3.3, 0}};
  EXPECT_NEAR(max_relative_jump(pushed(force_N, 3)), 0.3 / 2, 1e-12);
  EXPECT_NEAR(max_relative_change(pushed(force_N, 3)), 0.5, 1e-12);
  EXPECT_NEAR(max_relative_jump(pushed({{0, 0, 0}, {0, 1, 0}, {0, 2, 0}}, 2)), 1, 1e-12);  // a force begins
}

TEST(WeberFraction, CountsTheEndOfAForceAndATurnButNotItsBegin) {
  EXPECT_EQ(max_relative_jump(pushed({{0, 3, 0}, {0, 0, 0}, {0, 9, 0}}, 1)), 1);
  EXPECT_NEAR(max_relative_jump(pushed({{2, 0, 0}, {0, 2, 0}}, 1)), std::sqrt(2.0), 1e-15);
}

TEST(WeberFraction, NeedsTheLeastForceBeforeTheChange) {
  EXPECT_TRUE(std::isnan(max_relative_jump(pushed({{0, 0.99 * kMinWeberForce_N, 0}, {0, 5, 0}}, 1))));
  EXPECT_NEAR(max_relative_jump(pushed({{0, kMinWeberForce_N, 0}, {0, 5, 0}}, 1)), 49, 1e-12);
  EXPECT_TRUE(std::isnan(max_relative_jump(pushed({{0, 1, 0}, {0, 2, 0}}, 2))));  // there is no update
  EXPECT_TRUE(std::isnan(max_relative_change(pushed({{0, 1, 0}, {0, 2, 0}}, 1))));
  EXPECT_TRUE(std::isnan(max_relative_jump(Trace())));
}

struct Slide {
  Vec3 hip_W, force_N, normal;
  ContactState state = ContactState::contact;
};

Trace slid(const std::vector<Slide>& ticks) {
  Trace trace;
  for (const Slide& tick : ticks) {
    RenderOutput out;
    out.force_N = tick.force_N, out.state = tick.state;
    DeviceState device;
    device.position_W = tick.hip_W;
    trace.append(kTick_s * static_cast<double>(trace.length()), device, out, {.normal = tick.normal});
  }
  return trace;
}

// Coulomb friction on a leaning plane: the hand wanders along it, and in and out of it.
TEST(ApparentFriction, IsTheCoefficientOfCoulombFriction) {
  std::mt19937 random(5);
  std::normal_distribution<double> gauss;
  const Eigen::Quaterniond lean = rotation(Vec3(0.3, -0.7, 0.5));
  for (const double mu : {0.0, 0.15, 0.8, -0.1}) {
    std::vector<Slide> ticks;
    Vec3 hip(0.1, 0, 0.2);
    for (int i = 0; i < 200; ++i) {
      const Vec3 step(1e-4 * gauss(random), 0, 1e-4 * gauss(random));
      hip += step + Vec3(0, 1e-5 * gauss(random), 0);
      const double newtons = 1 + std::abs(gauss(random));
      const Vec3 force_N = newtons * (Vec3::UnitY() - mu * step.normalized());
      ticks.push_back({lean * hip, lean * force_N, lean * Vec3::UnitY()});
    }
    EXPECT_NEAR(apparent_friction(slid(ticks)), mu, 1e-9) << mu;
  }
}

// The force tilts by 0.2 to the left and right of the path in turn: the hand feels no friction.
TEST(ApparentFriction, IsNoneIfTheForceTiltsAcrossOrToBothSides) {
  std::vector<Slide> across, both;
  for (int i = 0; i < 101; ++i) {
    const double side = i % 2 ? 0.2 : -0.2;
    across.push_back({{1e-4 * i, 0, 0}, {0, 1, side}, Vec3::UnitY()});
    both.push_back({{1e-4 * i, 0, 0}, {side, 1, 0}, Vec3::UnitY()});
  }
  EXPECT_NEAR(apparent_friction(slid(across)), 0, 1e-12);
  EXPECT_NEAR(apparent_friction(slid(both)), 0, 1e-12);
}

TEST(ApparentFriction, UsesTicksThatSlideInContact) {
  const Vec3 up = Vec3::UnitY(), unknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  const double slow_m = 0.9 * kSliding_m_per_s * kTick_s, fast_m = 1.1 * kSliding_m_per_s * kTick_s;
  const Trace trace = slid({{{0, 0, 0}, {-9, 1, 0}, up},                      // has no tick before it
                            {{slow_m, 0, 0}, {-9, 1, 0}, up},                 // too slow
                            {{slow_m + fast_m, 0, 0}, {-0.5, 1, 0}, up},      // counts
                            {{1, 0, 0}, {-9, 1, 0}, up, ContactState::free},  // free
                            {{2, 0, 0}, {-9, 1, 0}, unknown},                 // unknown normal
                            {{3, 0, 0}, {-9, -1, 0}, up},                     // pulls into the surface
                            {{3, 1, 0}, {-9, 1, 0}, up}});                    // moves along the normal
  EXPECT_NEAR(apparent_friction(trace), 0.5, 1e-15);
  EXPECT_TRUE(std::isnan(apparent_friction(slid({{{0, 0, 0}, {-9, 1, 0}, up}}))));
  EXPECT_TRUE(std::isnan(apparent_friction(Trace())));
}

// The mean of a sine over an odd number of ticks is its middle times sin(n a / 2) / (n sin(a / 2)), with a
// the phase of a tick.
double ripple_factor(double frequency_Hz) {
  const int ticks = 101;
  const double half_phase = M_PI * frequency_Hz * kTick_s;
  return std::abs(1 - std::sin(ticks * half_phase) / (ticks * std::sin(half_phase)));
}

TEST(Ripple, OfASineIsItsRmsTimesTheFactorOfItsFrequency) {
  for (const double frequency_Hz : {2.0, 5.0, 10.0, 25.0, 90.0}) {
    const auto wave = [&](int i) { return std::sin(2 * M_PI * frequency_Hz * kTick_s * i); };
    // 1000 of the 1100 ticks have a whole window: whole periods.
    const Trace trace = pushed_along(1100, [&](int i) { return Vec3(0, 3, 0.5 * wave(i)); });
    const double rms = 0.5 * std::sqrt(0.5) * ripple_factor(frequency_Hz);
    EXPECT_NEAR(force_ripple_N(trace), rms, 1e-11) << frequency_Hz;
  }
}

// The factors of the header.
TEST(Ripple, FactorsOfTheWindow) {
  EXPECT_NEAR(ripple_factor(2), 0.06, 0.01);
  EXPECT_NEAR(ripple_factor(5), 0.36, 0.01);
  EXPECT_NEAR(ripple_factor(7.4), 0.71, 0.02);
  EXPECT_NEAR(ripple_factor(10), 1, 0.02);
  EXPECT_NEAR(ripple_factor(14.3), 1.22, 0.01);
}

TEST(Ripple, IsNoneForAForceThatIsLinearInTime) {
  const Trace trace = pushed_along(400, [](int i) { return Vec3(1 + 0.01 * i, 2, 3 - 0.002 * i); });
  EXPECT_NEAR(force_ripple_N(trace), 0, 1e-12);
  EXPECT_NEAR(relative_ripple(trace), 0, 1e-12);
}

TEST(Ripple, IsRelativeToTheMeanForce) {
  const auto sign = [](int i) { return i % 2 ? 1.0 : -1.0; };
  // A window of 101 ticks has 51 with the sign of its middle, and 50 with the other one.
  const Trace trace = pushed_along(300, [&](int i) { return Vec3(0, 4 + 0.1 * sign(i), 0); });
  const double ripple = 0.1 * (1 - 1.0 / 101);
  EXPECT_NEAR(force_ripple_N(trace), ripple, 1e-12);
  EXPECT_NEAR(relative_ripple(trace), ripple / 4, 1e-12);
}

// Contacts of 90 and 120 ticks: only 20 ticks of the second one have a whole window.
TEST(Ripple, CountsOnlyWindowsInContact) {
  const auto force = [](int i) {
    const bool touches = i < 90 || (i >= 200 && i < 320);
    return touches ? Vec3(0, 2, 0) : Vec3(0, 0, 0);
  };
  EXPECT_EQ(force_ripple_N(pushed_along(400, force)), 0);
  EXPECT_TRUE(std::isnan(force_ripple_N(pushed_along(100, force))));
  EXPECT_TRUE(std::isnan(force_ripple_N(pushed_along(100, [](int) { return Vec3(0, 0, 0); }))));
  EXPECT_FALSE(std::isnan(force_ripple_N(pushed_along(101, [](int) { return Vec3(0, 1, 0); }))));
  EXPECT_TRUE(std::isnan(relative_ripple(pushed_along(99, [](int) { return Vec3(0, 1, 0); }))));
}

TEST(Ripple, IsNanIfTheWindowHasFewerThanThreeTicks) {
  Trace slow;
  for (int i = 0; i < 50; ++i) {
    RenderOutput out;
    out.force_N = Vec3(0, i % 2 ? 1 : 2, 0);
    slow.append(0.06 * i, {}, out, {});
  }
  EXPECT_TRUE(std::isnan(force_ripple_N(slow)));
  EXPECT_TRUE(std::isnan(force_ripple_N(Trace())));
}

TEST(PerceivedMeasures, AreInTheTable) {
  const Trace trace = pushed_along(400, [](int i) { return Vec3(0.1 * (i % 7), 2 + 0.01 * (i % 13), 0); });
  EXPECT_EQ(value_of(measure_named("max_relative_jump"), trace), max_relative_jump(trace));
  EXPECT_EQ(value_of(measure_named("max_relative_change"), trace), max_relative_change(trace));
  EXPECT_EQ(value_of(measure_named("force_ripple"), trace), force_ripple_N(trace));
  EXPECT_EQ(value_of(measure_named("relative_ripple"), trace), relative_ripple(trace));
  EXPECT_TRUE(needs_true_contact(measure_named("apparent_friction")));
}

}  // namespace
}  // namespace remote_touch::perceived_measures_test
