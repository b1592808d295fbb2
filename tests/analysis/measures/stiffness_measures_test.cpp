// Presses whose force follows from a formula: a spring, a spring on a surface that gives way, and loops.
#include "analysis/measures/stiffness_measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "analysis/measures/measures.h"
#include "analysis/trace/trace.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::stiffness_measures_test {
namespace {

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
}  // namespace remote_touch::stiffness_measures_test
