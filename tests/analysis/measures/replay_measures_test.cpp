// The rendered force against the expected one: traces whose errors are known.
#include "analysis/measures/replay_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "analysis/measures/measures.h"
#include "analysis/trace/trace.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::replay_measures_test {
namespace {

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
