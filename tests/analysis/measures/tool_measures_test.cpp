#include "analysis/measures/tool_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "analysis/trace/trace.h"
#include "core/geometry/rotation.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::tool_measures_test {
namespace {

struct Tick {
  Vec3 torque_Nm = Vec3::Zero();
  int contacts = 0, active = 0, clusters = 0, detections = 1;
  double penetration_m = 0, gap_m = 0.01;
  bool exhausted = false;
  Vec3 lag_m = Vec3::Zero();
  Vec3 lag_rad = Vec3::Zero();
};

// The tool has arbitrary poses; the device is ahead of it by the lag.
Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    const double i = static_cast<double>(trace.length());
    RenderOutput out;
    out.proxy_W = {0.1, 0.02 * i, -0.3};
    out.contact_count = tick.contacts;
    out.nearest_distance_m = tick.gap_m;
    ToolOutput& tool = out.tool.emplace();
    tool.orientation_W = rotation({0.5, 0.1 * i, -0.4});
    tool.torque_Nm = tick.torque_Nm;
    tool.active_constraints = tick.active;
    tool.contact_clusters = tick.clusters;
    tool.tool_penetration_m = tick.penetration_m;
    tool.detections = tick.detections;
    tool.budget_exhausted = tick.exhausted;
    DeviceState device{out.proxy_W + tick.lag_m};
    device.orientation_W = rotation(tick.lag_rad) * tool.orientation_W;
    trace.append(0.001 * i, device, out, {});
  }
  return trace;
}

TEST(ToolMeasures, AreMeansAndMaximaOfTheTicks) {
  const double none = std::numeric_limits<double>::infinity();
  const Trace trace =
      trace_of({{{0, 0, 0}, 0, 0, 0, 1, 0, none, false, {0, 0, 0}, {0, 0, 0}},
                {{0.3, 0, 0.4}, 10, 2, 1, 3, 0.001, 0.002, false, {0.003, 0, 0.004}, {0, 0.2, 0}},
                {{0, -0.2, 0}, 30, 6, 4, 60, 0.004, -0.001, true, {0, -0.03, 0}, {0.3, 0, 0}},
                {{0, 0, 0}, 4, 0, 2, 4, 0, 0.005, true, {0, 0, 0.001}, {0, 0, -0.1}}});
  for (const auto& [name, expected] : {std::pair("max_torque", 0.5),
                                       {"mean_contact_count", 11},
                                       {"max_contact_count", 30},
                                       {"mean_active_constraints", 2},
                                       {"max_active_constraints", 6},
                                       {"max_contact_clusters", 4},
                                       {"max_tool_penetration", 0.004},
                                       {"min_clearance", -0.001},
                                       {"mean_detections", 17},
                                       {"max_detections", 60},
                                       {"exhausted_fraction", 0.5},
                                       {"mean_tool_lag", (0.005 + 0.03 + 0.001) / 4},
                                       {"max_tool_lag", 0.03},
                                       {"mean_tool_lag_angle", (0.2 + 0.3 + 0.1) / 4},
                                       {"max_tool_lag_angle", 0.3}})
    EXPECT_NEAR(value_of(measure_named(name), trace), expected, 1e-15) << name;
}

TEST(ToolMeasures, ClearanceIsNanWithoutANearestPoint) {
  Tick alone;
  alone.gap_m = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(std::isnan(min_clearance_m(trace_of({alone, alone}))));
}

TEST(ToolMeasures, ErrorOfGuidanceIsThatOfItsLastTick) {
  Trace trace;
  for (const double active : {0, 1, 1, 0}) {
    const double i = static_cast<double>(trace.length());
    RenderOutput out;
    out.proxy_W = {0.01 * i, 0, 0};
    out.tool.emplace().orientation_W = rotation({0, 0.2 * i, 0});
    GuidanceOutput& guidance = out.guidance.emplace();
    guidance.active = active != 0;
    if (guidance.active)
      guidance.goal_W = {0.05, 0, 0.04}, guidance.goal_orientation_W = rotation({0, 0.5, 0});
    trace.append(0.001 * i, {}, out, {});
  }
  EXPECT_EQ(guidance_fraction(trace), 0.5);
  EXPECT_NEAR(guidance_error_m(trace), 0.05, 1e-15);
  EXPECT_NEAR(guidance_error_rad(trace), 0.1, 1e-15);
}

TEST(ToolMeasures, ApplyToTheirRunsOnly) {
  Trace point;
  point.append(0, {}, {}, {});
  const Trace tool = trace_of({{}, {}});
  for (const Measure& each : built_in_measures()) {
    const bool of_tool = each.runs == MeasuredRuns::tool, of_proxy = each.runs == MeasuredRuns::proxy,
               of_guidance = each.runs == MeasuredRuns::guidance,
               of_others = each.runs == MeasuredRuns::replay || each.runs == MeasuredRuns::slave,
               of_contact = needs_true_contact(each);  // these traces have no true contact
    EXPECT_EQ(applies(each, point), !of_tool && !of_guidance && !of_contact && !of_others) << each.name;
    EXPECT_EQ(applies(each, tool), !of_proxy && !of_guidance && !of_contact && !of_others) << each.name;
    if (of_tool || of_guidance) {
      EXPECT_TRUE(std::isnan(each.compute(point))) << each.name;
    }
    if (of_proxy) {
      EXPECT_TRUE(std::isnan(value_of(each, tool))) << each.name;
    }
  }
  EXPECT_EQ(value_of(measure_named("mean_detections"), tool), 1);
  EXPECT_EQ(value_of(measure_named("max_force"), tool), 0);
}

}  // namespace
}  // namespace remote_touch::tool_measures_test
