#include "analysis/measures/event_times.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "analysis/measures/force_change_measures.h"
#include "analysis/trace/trace.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::event_times_test {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Tick {
  int contacts = 0;
  double distance_m = 0.01, force_N = 0;
  int frame = 0;
};

// One tick every 2 ms, from 0.1 s.
Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.contact_count = tick.contacts;
    out.force_N = {0, tick.force_N, 0};
    out.frame_index = tick.frame;
    trace.append(0.1 + 0.002 * static_cast<double>(trace.length()), {}, out,
                 {tick.distance_m, tick.distance_m, 0});
  }
  return trace;
}

TEST(EventTimes, TheFirstContactIsTheFirstTickThatTouches) {
  const Trace trace = trace_of({{0}, {0}, {3}, {0}, {5}});
  EXPECT_EQ(first_contact_tick(trace), 2);
  EXPECT_EQ(first_contact_time_s(trace), trace.time_s[2]);
  EXPECT_EQ(first_contact_tick(trace_of({{1}})), 0);
}

TEST(EventTimes, TheFirstPopThroughCountsAlsoIfTheProxyComesBack) {
  const Trace trace = trace_of({{0, -0.001}, {0, 0.01}, {0, 0.001}, {0, -0.001}, {0, 0.001}, {0, -0.001}});
  EXPECT_EQ(first_pop_through_tick(trace), 3);
  EXPECT_EQ(first_pop_through_time_s(trace), trace.time_s[3]);
}

TEST(EventTimes, APathWithAnUnknownDistanceIsNotAPopThrough) {
  EXPECT_TRUE(std::isnan(first_pop_through_tick(trace_of({{0, 0.001}, {0, kUnknown}, {0, -0.001}}))));
}

TEST(EventTimes, TheJumpIsTheFirstOfTheLargestAtAFrameUpdate) {
  const Trace trace =
      trace_of({{1, 0, 0, 0}, {1, 0, 9, 0}, {1, 0, 11, 1}, {1, 0, 14, 2}, {1, 0, 11, 3}, {1, 0, 0, 3}});
  EXPECT_EQ(max_force_jump_tick(trace), 3);
  EXPECT_EQ(max_force_jump_time_s(trace), trace.time_s[3]);
  EXPECT_EQ(max_force_jump_N(trace), 3);
}

TEST(EventTimes, AnEventThatDidNotHappenIsNan) {
  const Trace calm = trace_of({{0, 0.01, 2, 0}, {0, 0.01, 2, 1}});
  EXPECT_EQ(max_force_jump_N(calm), 0);
  for (const char* name : {"first_contact", "first_pop_through", "max_force_jump"})
    for (const char* ending : {"_time", "_tick"}) {
      const Measure& measure = measure_named(std::string(name) + ending);
      EXPECT_TRUE(std::isnan(value_of(measure, calm))) << measure.name;
      EXPECT_TRUE(std::isnan(value_of(measure, Trace()))) << measure.name;
      EXPECT_EQ(measure.unit, std::string(ending) == "_time" ? "s" : "1");
    }
}

}  // namespace
}  // namespace remote_touch::event_times_test
