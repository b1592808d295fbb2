#include "analysis/trace/sequence_log.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/trace/trace.h"

namespace remote_touch::sequence_log_test {
namespace {

struct Tick {
  int step;
  bool running;
  int missed;
  double sequence_distance_m = std::nan("");
};

// A tick every millisecond.
Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    GuidanceOutput guidance;
    guidance.sequence_distance_m = tick.sequence_distance_m,
    guidance.sequence_angle_rad = 30 * tick.sequence_distance_m;
    guidance.sequence_step = tick.step, guidance.sequence_running = tick.running;
    guidance.sequence_missed = tick.missed;
    out.guidance = guidance;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out, {});
  }
  return trace;
}

TEST(SequenceLog, IsEmptyWithoutATask) {
  Trace trace;
  trace.append(0, {}, {}, {});
  EXPECT_TRUE(sequence_log(trace).empty());
  EXPECT_TRUE(sequence_log(trace_of({{0, false, 0}, {0, false, 0}})).empty());
}

TEST(SequenceLog, HasTheTimesAtWhichAStepBeganAndEnded) {
  const auto log = sequence_log(trace_of({{0, false, 0}, {0, true, 0}, {0, true, 0}, {1, false, 0, 0.003}}));
  ASSERT_EQ(log.size(), 1u);
  EXPECT_EQ(log[0].began_s, 0.001);
  EXPECT_EQ(log[0].ended_s, 0.003);
  EXPECT_FALSE(log[0].missed);
  EXPECT_EQ(log[0].distance_m, 0.003);
  EXPECT_EQ(log[0].angle_rad, 30 * 0.003);
}

// One tick in which the first step reaches its deadline, the second begins and ends, and the third begins.
TEST(SequenceLog, OnlyTheRunningOneOfSeveralStepsInATickIsMissed) {
  const auto log = sequence_log(trace_of({{0, true, 0}, {2, true, 1}, {2, true, 1}}));
  ASSERT_EQ(log.size(), 3u);
  EXPECT_TRUE(log[0].missed);
  EXPECT_FALSE(log[1].missed);
  EXPECT_EQ(log[1].began_s, 0.001);
  EXPECT_EQ(log[1].ended_s, 0.001);
  EXPECT_EQ(log[2].step, 2);
  EXPECT_TRUE(std::isnan(log[2].ended_s));
  EXPECT_TRUE(std::isnan(log[0].distance_m)) << "has no goal";
}

}  // namespace
}  // namespace remote_touch::sequence_log_test
