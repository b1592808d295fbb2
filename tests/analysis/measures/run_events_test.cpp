#include "analysis/measures/run_events.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "analysis/measures/force_measures.h"
#include "analysis/trace/trace.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::run_events_test {
namespace {

// Pop-through: from the front of the true surface to its back.

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double popped_through(const std::vector<double>& distance_m, double held_depth_m = 0) {
  SurfaceSide side(held_depth_m);
  for (const double each_m : distance_m) side.add(each_m);
  return side.popped_through();
}

std::vector<std::size_t> crossings(const std::vector<double>& distance_m, double held_depth_m = 0) {
  SurfaceSide side(held_depth_m);
  std::vector<std::size_t> ticks;
  for (std::size_t i = 0; i < distance_m.size(); ++i)
    if (side.add(distance_m[i])) ticks.push_back(i);
  return ticks;
}

TEST(SurfaceSide, CrossesFromTheFrontToTheBack) {
  EXPECT_EQ(popped_through({0.01, 0, -1e-9}), 1);
  EXPECT_EQ(popped_through({0.01, -0.01, 0.01}), 0) << "it came back";
  EXPECT_EQ(popped_through({0.01, 0.005}), 0);
  EXPECT_EQ(crossings({0.1, 0, -0.1, -0.2, 0.1, -0.1}), (std::vector<std::size_t>{2, 5}));
}

TEST(SurfaceSide, AProxyThatBeginsBehindHasNotPoppedThrough) {
  EXPECT_EQ(popped_through({-0.03, -0.002, -0.03}), 0);
  EXPECT_TRUE(crossings({-0.03, -0.002, -0.03}).empty());
  EXPECT_EQ(popped_through({-0.03, 0.002, -0.03}), 1) << "it was in front in between";
}

TEST(SurfaceSide, APositionOnTheSurfaceIsHeldUpToADepth) {
  EXPECT_EQ(popped_through({0.01, -2.37e-16}, 0.0025), 0);
  EXPECT_EQ(popped_through({0.01, -0.0025}, 0.0025), 0);
  EXPECT_EQ(popped_through({0.01, -0.001, -0.0026}, 0.0025), 1);
  EXPECT_EQ(crossings({0.01, -0.001, 0.001, -0.003}, 0.0025), std::vector<std::size_t>{3});
}

TEST(SurfaceSide, ResultIsNanIfTheWayToTheBackIsUnknown) {
  EXPECT_TRUE(std::isnan(popped_through({})));
  EXPECT_TRUE(std::isnan(popped_through({0.01, -0.01, kUnknown})));
  EXPECT_TRUE(std::isnan(popped_through({0.01, kUnknown, -0.01}))) << "round the border";
  EXPECT_TRUE(std::isnan(popped_through({kUnknown, -0.01})));
  EXPECT_TRUE(crossings({0.01, kUnknown, -0.01}).empty());
  EXPECT_EQ(popped_through({kUnknown, 0.01, -0.01}), 1);
  EXPECT_EQ(popped_through({0.01, -0.01, kUnknown, -0.01}), 1) << "it had crossed before";
  EXPECT_EQ(popped_through({-0.01, kUnknown, -0.01}), 0);
  EXPECT_EQ(popped_through({0.01, kUnknown, 0.01}), 0);
}

}  // namespace
}  // namespace remote_touch::run_events_test

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
