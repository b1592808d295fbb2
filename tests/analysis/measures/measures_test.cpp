#include "analysis/measures/measures.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "analysis/measures/contact_measures.h"
#include "analysis/measures/no_value.h"
#include "analysis/trace/trace.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::measures_test {
namespace {

struct Tick {
  double signed_distance = 0.005, force_y = 0;
  int frame = 0, steps = 1;
  ContactState state = ContactState::contact;
  bool converged = true;
  double nearest = 0.005;
};

Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.force_N = Vec3(0, tick.force_y, 0);
    out.state = tick.state;
    out.steps = tick.steps;
    out.converged = tick.converged;
    out.frame_index = tick.frame;
    out.nearest_distance_m = tick.nearest;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out,
                 {tick.signed_distance, tick.signed_distance, 0});
  }
  return trace;
}

TEST(Measures, PopThroughIsJudgedAtTheEnd) {
  EXPECT_EQ(popped_through(trace_of({{-0.01}, {0.005}})), 0);
  EXPECT_EQ(popped_through(trace_of({{0.005}, {-1e-9}})), 1);
  EXPECT_TRUE(std::isnan(popped_through(Trace())));
  EXPECT_EQ(max_penetration_m(trace_of({{0.005}, {-0.003}, {-0.001}})), 0.003);
  EXPECT_TRUE(std::isnan(popped_through(trace_of({{-0.01}, {kNoValue}}))));
  EXPECT_EQ(max_penetration_m(trace_of({{kNoValue}, {0.005}, {kNoValue}})), 0);
  EXPECT_TRUE(std::isnan(max_penetration_m(trace_of({{kNoValue}, {kNoValue}}))));
}

TEST(Measures, AProxyThatRestsOnTheSurfaceIsNotBehindIt) {
  Trace resting = trace_of({{0.01}, {-2.37e-16}, {0.0001}, {-0.0004}});
  EXPECT_EQ(popped_through(resting), 1) << "a ball's centre";
  EXPECT_EQ(wrong_side_fraction(resting), 0.5);
  resting.held_depth_m = 0.0025;
  EXPECT_EQ(popped_through(resting), 0);
  EXPECT_EQ(wrong_side_fraction(resting), 0);
  EXPECT_EQ(max_penetration_m(resting), 0.0004) << "a depth is a depth";
}

TEST(Measures, WrongSideIsAShareOfTheTicksWithKnownTruth) {
  EXPECT_EQ(wrong_side_fraction(trace_of({{0.005}, {kNoValue}, {-0.003}, {0.0}, {-1e-9}})), 0.5);
  EXPECT_TRUE(std::isnan(wrong_side_fraction(trace_of({{kNoValue}}))));
}

// A change counts only in ticks with a force or a torque, now or in the tick before.
TEST(Measures, TextsOfChangesNameTheTicksThatCount) {
  for (const char* name : {"rms_force_jump", "force_noise", "jump_fraction_5", "jump_fraction_20"})
    EXPECT_NE(measure_named(name).meaning.find("with a force"), std::string::npos) << name;
  for (const char* name : {"rms_torque_jump", "torque_noise"})
    EXPECT_NE(measure_named(name).meaning.find("with a torque"), std::string::npos) << name;
  for (const char* name : {"mean_lateral_force", "lateral_force_95"})
    EXPECT_NE(measure_named(name).meaning.find("pushes out"), std::string::npos) << name;
}

// Results are compared bit by bit, and the NaN of 0 / 0 has another sign on some machines.
TEST(Measures, NoValueHasTheSameBitsEverywhere) {
  for (const Trace& trace : {Trace(), trace_of({{kNoValue}, {kNoValue}})})
    for (const auto measure :
         {max_penetration_m, min_slave_distance_m, wrong_side_fraction, rms_surface_error_m})
      EXPECT_EQ(std::bit_cast<std::uint64_t>(measure(trace)), std::bit_cast<std::uint64_t>(kNoValue));
}

TEST(Measures, AreZeroForAnEmptyTrace) {
  EXPECT_EQ(unconverged_fraction(Trace()), 0);
  EXPECT_EQ(non_finite_fraction(Trace()), 0);
  EXPECT_EQ(mean_steps(Trace()), 0);
  EXPECT_EQ(max_steps(Trace()), 0);
  EXPECT_EQ(max_force_N(Trace()), 0);
}

TEST(Measures, SurfaceErrorCountsContactWithKnownTruthOnly) {
  Tick good{0.0053}, bad{0.0046}, free{0.02}, dark{kNoValue};
  free.state = ContactState::free;
  EXPECT_NEAR(rms_surface_error_m(trace_of({good, bad, free, dark})), std::sqrt((9e-8 + 16e-8) / 2), 1e-12);
  EXPECT_TRUE(std::isnan(rms_surface_error_m(trace_of({free, dark}))));
}

TEST(Measures, MaxForceIsOfAllTicks) {
  const auto tick = [](double force, int frame) { return Tick{0.005, force, frame}; };
  EXPECT_EQ(max_force_N(trace_of({tick(1, 0), tick(5, 0), tick(-7, 1)})), 7);
}

TEST(Measures, CountStepsAndTicksWithoutConvergence) {
  Tick quick, slow;
  quick.steps = 2, slow.steps = 30, slow.converged = false;
  const Trace trace = trace_of({quick, quick, slow, quick});
  EXPECT_EQ(mean_steps(trace), 9);
  EXPECT_EQ(max_steps(trace), 30);
  EXPECT_EQ(unconverged_fraction(trace), 0.25);
  EXPECT_EQ(non_finite_fraction(trace), 0);
}

}  // namespace
}  // namespace remote_touch::measures_test
