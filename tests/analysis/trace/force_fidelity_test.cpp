#include "analysis/trace/force_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "tests/analysis/trace/measure_named.h"

namespace remote_touch::force_fidelity_test {
namespace {

// Presses whose force follows from a formula: a spring, a spring on a surface that gives way, and loops.

constexpr double kTick_s = 0.001;
const double kNan = std::numeric_limits<double>::quiet_NaN();
const Vec3 kNormal = Vec3(0.6, 0.8, 0);

struct Tick {
  double depth_m = 0, normal_N = 0;
  double sunk_m = 0;  // depth of the contact point below the true surface
  Vec3 normal = kNormal;
};

// The force has a part along the surface, which no measure uses.
Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.force_N = tick.normal_N * (kNormal + Vec3(0.8, -0.6, 0.3));
    if (tick.normal_N == 0) out.force_N.setZero();
    Trace::Truth truth;
    truth.contact = Trace::TrueContact{-tick.sunk_m, -tick.depth_m};
    truth.normal = tick.normal_N == 0 ? Vec3(Vec3::Constant(kNan)) : tick.normal;
    trace.append(kTick_s * static_cast<double>(trace.length()), {}, out, truth);
  }
  return trace;
}

// A motion from 2 mm above the surface to 6 mm below it, and back if there is a second force.
std::vector<Tick> pressed(const std::function<double(double)>& down_N,
                          const std::function<double(double)>& up_N = {}) {
  constexpr double kStep_m = 1e-5;
  std::vector<Tick> ticks;
  for (int i = -200; i <= 600; ++i) ticks.push_back({i * kStep_m, i > 0 ? down_N(i * kStep_m) : 0});
  if (up_N)
    for (int i = 600; i >= -200; --i) ticks.push_back({i * kStep_m, i > 0 ? up_N(i * kStep_m) : 0});
  return ticks;
}

double spring_N(double depth_m) {
  return 500 * depth_m;
}

TEST(Stiffness, OfASpringIsItsOwn) {
  const Trace trace = trace_of(pressed(spring_N, spring_N));
  EXPECT_NEAR(rendered_stiffness_N_per_m(trace), 500, 1e-9);
  EXPECT_NEAR(stiffness_error(trace), 0, 1e-12);
  EXPECT_NEAR(stiffness_nonlinearity(trace), 0, 1e-12);
  EXPECT_NEAR(stiffness_hysteresis(trace), 0, 1e-12);
}

TEST(Stiffness, IsTheSameIfTheSurfaceIsRenderedTooHigh) {
  std::vector<Tick> ticks = pressed([](double depth_m) { return 500 * depth_m + 0.7; });
  for (Tick& tick : ticks) tick.sunk_m = -0.7 / 500;
  EXPECT_NEAR(rendered_stiffness_N_per_m(trace_of(ticks)), 500, 1e-9);
  EXPECT_NEAR(stiffness_error(trace_of(ticks)), 0, 1e-9);
}

// The force k (x - a) that begins at the depth a has, from 0 to L, the slope k (1 - a/L)^2 (1 + 2 a/L).
TEST(Stiffness, IsSmallerIfTheForceBeginsTooDeep) {
  const Trace trace = trace_of(pressed([](double depth_m) { return 500 * std::max(0.0, depth_m - 0.001); }));
  EXPECT_NEAR(rendered_stiffness_N_per_m(trace), 500 * 25.0 / 36 * 4 / 3, 1);
}

// Two springs in a row, 600 N/m of the coupling and 2400 N/m of the surface: 480 N/m, a fifth less.
TEST(Stiffness, OfASurfaceThatGivesWayIsThatOfSpringsInARow) {
  std::vector<Tick> ticks = pressed([](double depth_m) { return 480 * depth_m; });
  for (Tick& tick : ticks) tick.sunk_m = tick.normal_N / 2400;
  EXPECT_NEAR(rendered_stiffness_N_per_m(trace_of(ticks)), 480, 1e-9);
  EXPECT_NEAR(stiffness_error(trace_of(ticks)), -0.2, 1e-9);
}

// The line of least squares of x^2 from 0 to a is a x - a^2 / 6; the rest has the rms a^2 / sqrt(180). For
// equally spaced x from a to b its slope is a + b.
TEST(Stiffness, OfASquareIsThatOfItsLine) {
  const Trace trace = trace_of(pressed([](double depth_m) { return 1e5 * depth_m * depth_m; }));
  EXPECT_NEAR(rendered_stiffness_N_per_m(trace), 1e5 * (0.00002 + 0.006), 1e-6);
  EXPECT_NEAR(stiffness_nonlinearity(trace), 1 / std::sqrt(180), 1e-3);
}

TEST(Stiffness, IsThatOfThePressAlone) {
  const Trace trace = trace_of(pressed(spring_N, [](double depth_m) { return 100 * depth_m; }));
  EXPECT_NEAR(rendered_stiffness_N_per_m(trace), 500, 1e-9);
  EXPECT_NEAR(stiffness_error(trace), 0, 1e-12);
}

TEST(Hysteresis, IsTheLostPartOfTheWork) {
  const auto of = [](const std::function<double(double)>& up_N) {
    return stiffness_hysteresis(trace_of(pressed(spring_N, up_N)));
  };
  EXPECT_NEAR(of([](double depth_m) { return 400 * depth_m; }), 0.2, 1e-9);
  EXPECT_NEAR(of([](double depth_m) { return 550 * depth_m; }), -0.1, 1e-9);
  EXPECT_NEAR(of([](double) { return 0.0; }), 1, 1e-9);
  // The square encloses a^3 / 3 of a^3 / 2.
  EXPECT_NEAR(of([](double depth_m) { return 500 / 0.006 * depth_m * depth_m; }), 1.0 / 3, 1e-3);
}

// Two presses to 6 mm and a release to 3 mm only: the work is compared between 3 and 6 mm.
TEST(Hysteresis, UsesTheIndentationsThatBothHave) {
  std::vector<Tick> ticks = pressed(spring_N);
  const std::vector<Tick> again = ticks;
  for (int i = 600; i >= 300; --i) ticks.push_back({i * 1e-5, 0.9 * spring_N(i * 1e-5)});
  EXPECT_NEAR(stiffness_hysteresis(trace_of(ticks)), 0.1, 1e-3);
  ticks.insert(ticks.end(), again.begin(), again.end());
  EXPECT_NEAR(stiffness_hysteresis(trace_of(ticks)), 0.1, 1e-3);
}

TEST(Stiffness, IsNanWithoutAPress) {
  const auto expect_none = [](const Trace& trace) {
    EXPECT_TRUE(std::isnan(rendered_stiffness_N_per_m(trace)));
    EXPECT_TRUE(std::isnan(stiffness_error(trace)));
    EXPECT_TRUE(std::isnan(stiffness_nonlinearity(trace)));
    EXPECT_TRUE(std::isnan(stiffness_hysteresis(trace)));
  };
  expect_none(Trace());
  Trace not_computed;
  for (int i = 0; i < 3; ++i) not_computed.append(kTick_s * i, {}, {}, {});
  expect_none(not_computed);
  expect_none(trace_of(std::vector<Tick>(900, {0.003, 2})));  // a hand at rest
  std::vector<Tick> shallow, slow, unknown = pressed(spring_N, spring_N);
  for (int i = 0; i < 99; ++i) shallow.push_back({1e-5 * i, 0.1 * i});
  for (int i = 0; i < 99999; ++i) slow.push_back({0.9 * kPressing_m_per_s * kTick_s * i, 0.01 * i});
  for (Tick& tick : unknown) tick.normal = Vec3::Constant(kNan);
  for (const double newtons : {0.0, -2.0})  // no force, and one that pulls the hand in
    expect_none(trace_of(pressed([=](double) { return newtons; }, [=](double) { return newtons; })));
  expect_none(trace_of(shallow));
  expect_none(trace_of(slow));
  expect_none(trace_of(unknown));
}

TEST(StiffnessMeasures, AreInTheTable) {
  std::vector<Tick> ticks = pressed(spring_N, [](double depth_m) { return 400 * depth_m; });
  for (Tick& tick : ticks) tick.sunk_m = tick.normal_N / 2400;
  const Trace trace = trace_of(ticks);
  EXPECT_EQ(value_of(measure_named("rendered_stiffness"), trace), rendered_stiffness_N_per_m(trace));
  EXPECT_EQ(value_of(measure_named("stiffness_error"), trace), stiffness_error(trace));
  EXPECT_EQ(value_of(measure_named("stiffness_nonlinearity"), trace), stiffness_nonlinearity(trace));
  EXPECT_EQ(value_of(measure_named("stiffness_hysteresis"), trace), stiffness_hysteresis(trace));
  EXPECT_TRUE(needs_true_contact(measure_named("rendered_stiffness")));
}

}  // namespace
}  // namespace remote_touch::force_fidelity_test

namespace remote_touch::replay_measures_test {
namespace {

// The rendered force against the expected one: traces whose errors are known.

const Vec3 kUnknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

struct Tick {
  Vec3 expected_N, force_N;
  std::optional<Vec3> guidance_N = {};
};

Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.force_N = tick.force_N;
    if (tick.guidance_N) out.guidance.emplace().force_N = *tick.guidance_N;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out, {.expected_force_N = tick.expected_N});
  }
  return trace;
}

// The errors are 3, 4 and 0 N; the expected forces 5, 0 and 0 N.
TEST(ReplayMeasures, ErrorIsTheRmsOverAllTicks) {
  const Trace trace = trace_of({{{3, 4, 0}, {0, 4, 0}}, {{0, 0, 0}, {0, 0, 4}}, {{0, 0, 0}, {0, 0, 0}}});
  EXPECT_NEAR(rms_force_error_N(trace), std::sqrt(25.0 / 3), 1e-15);
  EXPECT_NEAR(relative_force_error(trace), 1, 1e-15);
}

TEST(ReplayMeasures, AScaledForceHasTheScaleAsItsRelativeError) {
  std::vector<Tick> ticks;
  double squares = 0;
  for (int i = 0; i < 100; ++i) {
    const Vec3 expected(0.01 * i, 1 + 0.02 * i, -0.03 * i);
    ticks.push_back({expected, 0.75 * expected});
    squares += expected.squaredNorm();
  }
  const Trace trace = trace_of(ticks);
  EXPECT_NEAR(relative_force_error(trace), 0.25, 1e-14);
  EXPECT_NEAR(rms_force_error_N(trace), 0.25 * std::sqrt(squares / 100), 1e-14);
  EXPECT_NEAR(force_direction_error_rad(trace), 0, 1e-15);
}

// Only ticks with both forces have an angle: 90 degrees, 45 degrees and 0.
TEST(ReplayMeasures, DirectionErrorIsTheMeanAngleWhereBothAreFelt) {
  const Trace trace = trace_of({{{0, 2, 0}, {1, 0, 0}},
                                {{0, 2, 0}, {0, 3, 3}},
                                {{0, 2, 0}, {0, 5, 0}},
                                {{0, 2, 0}, {0, 0, 0}},
                                {{0, 0, 0}, {7, 0, 0}},
                                {{0, 2, 0}, {0.9 * kContactForce_N, 0, 0}}});
  EXPECT_NEAR(force_direction_error_rad(trace), (M_PI / 2 + M_PI / 4) / 3, 1e-15);
}

TEST(ReplayMeasures, CountFalseAndLostContacts) {
  const Vec3 none = Vec3::Zero(), force(0, 1, 0), little(0, 0.9 * kContactForce_N, 0),
             small(0, 0.9 * kExpectedContact_N, 0);
  // Four ticks without an expected force, one of them with a force; three with one, two of them without
  // force.
  const Trace trace = trace_of({{none, none},
                                {none, force},
                                {none, little},
                                {none, none},
                                {force, none},
                                {force, little},
                                {force, force},
                                {small, none}});
  EXPECT_EQ(false_contact_fraction(trace), 0.25);
  EXPECT_NEAR(lost_contact_fraction(trace), 2.0 / 3, 1e-15);
}

TEST(ReplayMeasures, DoNotUseTicksWithoutAKnownForce) {
  const Trace trace = trace_of({{kUnknown, {9, 9, 9}}, {{0, 2, 0}, {0, 2.5, 0}}});
  EXPECT_EQ(rms_force_error_N(trace), 0.5);
  EXPECT_EQ(relative_force_error(trace), 0.25);
  EXPECT_EQ(lost_contact_fraction(trace), 0);
  EXPECT_TRUE(std::isnan(false_contact_fraction(trace)));
}

TEST(ReplayMeasures, CompareTheForceWithoutGuidance) {
  const Trace trace = trace_of({{{0, 2, 0}, {4, 2, 0}, Vec3(4, 0, 0)}});
  EXPECT_EQ(rms_force_error_N(trace), 0);
  EXPECT_EQ(force_direction_error_rad(trace), 0);
}

TEST(ReplayMeasures, AForceThatIsNotFiniteHasNoError) {
  const Trace trace = trace_of({{{0, 2, 0}, {0, 2, 0}}, {{0, 2, 0}, kUnknown}});
  EXPECT_TRUE(std::isnan(rms_force_error_N(trace)));
  EXPECT_TRUE(std::isnan(relative_force_error(trace)));
  EXPECT_EQ(lost_contact_fraction(trace), 0.5);
}

TEST(ReplayMeasures, RelativeErrorIsNanIfNoForceIsExpected) {
  EXPECT_TRUE(std::isnan(relative_force_error(trace_of({{{0, 0, 0}, {0, 1, 0}}}))));
  EXPECT_TRUE(std::isnan(relative_force_error(trace_of({{{0, 0, 0}, {0, 0, 0}}}))));
}

TEST(ReplayMeasures, ApplyToRunsWithAnExpectedForce) {
  Trace without;
  without.append(0, {}, {}, {});
  const Trace with = trace_of({{{0, 1, 0}, {0, 1, 0}}});
  int found = 0;
  for (const Measure& measure : built_in_measures()) {
    if (measure.runs != MeasuredRuns::replay) continue;
    ++found;
    EXPECT_TRUE(applies(measure, with)) << measure.name;
    EXPECT_FALSE(applies(measure, without)) << measure.name;
    EXPECT_FALSE(needs_true_contact(measure)) << measure.name;
    EXPECT_TRUE(std::isnan(measure.compute(without))) << measure.name;
    EXPECT_TRUE(std::isnan(measure.compute(Trace()))) << measure.name;
  }
  EXPECT_EQ(found, 5);
  EXPECT_EQ(value_of(measure_named("rms_force_error"), with), 0);
  EXPECT_EQ(value_of(measure_named("lost_contact_fraction"), with), 0);
}

}  // namespace
}  // namespace remote_touch::replay_measures_test

namespace remote_touch::passivity_measures_test {
namespace {

struct Tick {
  double force_N = 0, hip_position_m = 0;
  int frame = 0;
};

Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.force_N = {0, tick.force_N, 0};
    out.frame_index = tick.frame;
    trace.append(0.001 * static_cast<double>(trace.length()), {Vec3(0, tick.hip_position_m, 0)}, out, {});
  }
  return trace;
}

TEST(PassivityMeasures, ASpringGivesBackWhatItTookAndNoMore) {
  constexpr int kStiffer = 528;  // first tick with 1.5 times the stiffness, on the way out
  std::vector<Tick> ticks;
  double before = 0, after = 0;  // sums of squared steps
  for (int i = 0; i <= 1000; ++i) {
    const double depth = 0.01 * std::sin(3.14159265358979 * i / 1000);
    if (i > 0) (i <= kStiffer ? before : after) += std::pow(depth + ticks.back().hip_position_m, 2);
    ticks.push_back({600 * depth, -depth, i / 33});
  }
  // Sampling injects energy: each force is held while the hand moves on, k / 2 (sum of steps^2) in all.
  EXPECT_NEAR(max_energy_injected_J(trace_of(ticks)), 300 * (before + after), 1e-14);
  for (int i = kStiffer; i <= 1000; ++i) ticks[static_cast<std::size_t>(i)].force_N *= 1.5;
  const double more = 150 * std::pow(ticks[kStiffer].hip_position_m, 2);  // half of the added 300 N/m
  EXPECT_NEAR(max_energy_injected_J(trace_of(ticks)), more + 300 * before + 450 * after, 1e-14);
}

// A spring that is pressed and released gives back what it took. One that gets stiffer in between gives more.
TEST(PassivityMeasures, EnergyIsForceTimesDisplacementOfTheHand) {
  EXPECT_NEAR(energy_injected_J(trace_of({{2, 0}, {2, -0.01}, {2, 0}})), 0, 1e-17);
  EXPECT_NEAR(energy_injected_J(trace_of({{2, 0}, {5, -0.01}, {100, 0}})), 0.01 * (5 - 2), 1e-17);
  EXPECT_LT(energy_injected_J(trace_of({{2, 0}, {2, -0.01}})), 0);
  EXPECT_EQ(energy_injected_J(trace_of({{2, 0}})), 0);
  EXPECT_EQ(energy_injected_J(Trace()), 0);
}

// A torque of 0.5 N m turns the hand by 0.2 rad about an axis at 60 degrees to it, and 2 N push it by 1 cm.
TEST(PassivityMeasures, WorkIncludesTheTorque) {
  const Vec3 axis_W(0.5, std::sqrt(0.75), 0);
  Trace trace;
  for (int i = 0; i < 2; ++i) {
    RenderOutput out;
    out.force_N = {0, 2, 0};
    out.tool.emplace().torque_Nm = {0.5, 0, 0};
    DeviceState device{Vec3(0, 0.01 * i, 0)};
    device.orientation_W = rotation(0.2 * i * axis_W) * rotation({0.3, -0.1, 0.7});
    trace.append(0.001 * i, device, out, {});
  }
  EXPECT_NEAR(energy_injected_J(trace), 2 * 0.01 + 0.5 * 0.2 * 0.5, 1e-15);
}

// Work is done by the force that the device exerts, not by the renderer's command: here a motor is missing.
TEST(PassivityMeasures, WorkIsThatOfTheMotors) {
  Trace trace;
  for (int i = 0; i < 2; ++i) {
    RenderOutput out;
    out.force_N = {3, 2, 0};
    HandState hand;
    hand.force_N = {0, 2, 0};
    trace.append(0.001 * i, {Vec3(0.01 * i, 0.01 * i, 0)}, out, {}, hand);
  }
  EXPECT_NEAR(energy_injected_J(trace), 0.02, 1e-17);
  EXPECT_NEAR(max_energy_injected_J(trace), 0.02, 1e-17);
}

TEST(PassivityMeasures, MaxEnergyIsTheMaximumOverTime) {
  // 2 J to the hand, then 5 J from it.
  const Trace trace = trace_of({{1, 0}, {1, 2}, {1, -3}});
  EXPECT_EQ(max_energy_injected_J(trace), 2);
  EXPECT_EQ(max_energy_injected_J(trace_of({{1, 0}, {1, -1}, {1, -3}})), 0);
  EXPECT_EQ(max_energy_injected_J(trace_of({})), 0);
}

TEST(PassivityMeasures, EnergyPerUpdateIsOfWholePiecesWithForce) {
  // Frame updates are at the ticks 1, 3, 5 and 7. The work between them is 3, -2 and, without force, 0 J.
  const Trace trace = trace_of({{9, 0, 0},
                                {1, 0, 1},
                                {1, 1, 1},
                                {-1, 3, 2},
                                {-1, 4, 2},
                                {0, 5, 3},
                                {0, 9, 3},
                                {7, 12, 4},
                                {7, 20, 4}});
  EXPECT_EQ(mean_energy_per_update_J(trace), 0.5);
  EXPECT_EQ(max_energy_per_update_J(trace), 3);
  EXPECT_TRUE(std::isnan(mean_energy_per_update_J(trace_of({{9, 0, 0}, {9, 1, 1}}))));
  EXPECT_TRUE(std::isnan(max_energy_per_update_J(trace_of({}))));
}

// Frame updates are at the ticks 1, 3 and 5. The renderer always commands a force, but the device exerts one
// only between the second update and the third.
TEST(PassivityMeasures, APieceWithACommandThatNoMotorExertsDoesNotCount) {
  Trace trace;
  for (int i = 0; i < 7; ++i) {
    RenderOutput out;
    out.force_N = {3, 0, 0};
    out.frame_index = (i + 1) / 2;
    HandState hand;
    hand.force_N = {0, i == 3 || i == 4 ? 2.0 : 0.0, 0};
    trace.append(0.001 * i, {Vec3(0.01 * i, 0.01 * i, 0)}, out, {}, hand);
  }
  EXPECT_NEAR(mean_energy_per_update_J(trace), 2 * 2 * 0.01, 1e-17);
}

// Frame updates are at the ticks 1, 3 and 5. The hand turns by 0.1 rad in each tick. The tool exerts a torque
// of 0.5 N m only between the first two updates, and never a force.
TEST(PassivityMeasures, APieceWithATorqueAloneHasItsEnergy) {
  Trace trace;
  for (int i = 0; i < 7; ++i) {
    RenderOutput out;
    out.frame_index = (i + 1) / 2;
    out.tool.emplace().torque_Nm = {0, i == 1 || i == 2 ? 0.5 : 0, 0};
    DeviceState device{Vec3(0.01 * i, 0, 0)};
    device.orientation_W = rotation({0, 0.1 * i, 0});
    trace.append(0.001 * i, device, out, {});
  }
  EXPECT_NEAR(mean_energy_per_update_J(trace), 2 * 0.5 * 0.1, 1e-15);
  EXPECT_NEAR(max_energy_per_update_J(trace), 2 * 0.5 * 0.1, 1e-15);
}

}  // namespace
}  // namespace remote_touch::passivity_measures_test
