#include "analysis/trace/contact_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "tests/analysis/trace/measure_named.h"

namespace remote_touch::tool_and_slave_measures_test {
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
}  // namespace remote_touch::tool_and_slave_measures_test

namespace remote_touch::slave_measures_test {
namespace {

// Measures of the slave: traces whose values are known.

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Tick {
  double lag_m, peak_N, clearance_m, felt_N;
};

Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    const auto number = static_cast<std::int32_t>(trace.length());
    RenderOutput out;
    out.slave_W = Vec3(1, 2, 3);
    HandState hand;
    hand.force_N = Vec3(0, tick.felt_N, 0);
    SlaveState slave;
    slave.position_W = Vec3(1, 2 + tick.lag_m, 3);
    slave.peak_force_N = tick.peak_N, slave.clearance_m = tick.clearance_m;
    slave.command_packets = 1 + number, slave.force_packets = 1 + number / 2;
    slave.frame_packets = 1 + number / 4;
    trace.append(0.001 * number, {}, out, {}, hand, slave);
  }
  return trace;
}

const std::vector<Tick> kTouch = {
    {0.001, 0, 0.02, 0}, {0.002, 0, 0.01, 1}, {-0.002, 0, kUnknown, 2}, {0, 7, -0.001, 3}, {0, 4, -0.002, 3}};

TEST(SlaveMeasures, AreThoseOfTheSlave) {
  const Trace trace = trace_of(kTouch);
  EXPECT_EQ(max_slave_force_N(trace), 7);
  EXPECT_EQ(slave_touched(trace), 1);
  EXPECT_NEAR(slave_contact_fraction(trace), 0.4, 1e-15);
  EXPECT_EQ(min_slave_clearance_m(trace), -0.002);
  EXPECT_NEAR(rms_slave_lag_m(trace), std::sqrt(9e-6 / 5), 1e-15);
  EXPECT_NEAR(first_slave_contact_time_s(trace), 0.003, 1e-15);
  EXPECT_NEAR(slave_anticipation_s(trace), 0.002, 1e-15);
  EXPECT_NEAR(command_packet_rate_per_s(trace), 1000, 1e-9);
  EXPECT_NEAR(force_packet_rate_per_s(trace), 500, 1e-9);
  EXPECT_EQ(max_device_force_N(trace), 3);
  EXPECT_NEAR(frame_packet_rate_per_s(trace), 250, 1e-9);
}

TEST(SlaveMeasures, HaveNoValueForWhatDidNotHappen) {
  const Trace trace = trace_of({{0, 0, kUnknown, 0}, {0, 0, kUnknown, 0}});
  EXPECT_EQ(max_slave_force_N(trace), 0);
  EXPECT_TRUE(std::isnan(min_slave_clearance_m(trace)));
  EXPECT_TRUE(std::isnan(slave_touched(trace))) << "there is no surface to touch";
  EXPECT_EQ(slave_touched(trace_of({{0, 0, kUnknown, 0}, {0, 0, 0.001, 0}})), 0);
  EXPECT_TRUE(std::isnan(first_slave_contact_time_s(trace)));
  EXPECT_TRUE(std::isnan(slave_anticipation_s(trace)));
  EXPECT_TRUE(std::isnan(command_packet_rate_per_s(trace_of({{0, 0, 0, 0}}))));
}

// The state of a slave is NaN before its first command.
TEST(SlaveMeasures, IgnoreTicksBeforeTheFirstCommand) {
  std::vector<Tick> ticks = kTouch;
  ticks.insert(ticks.begin(), 2, {0, kUnknown, kUnknown, 0});
  EXPECT_EQ(max_slave_force_N(trace_of(ticks)), 7);
  EXPECT_EQ(min_slave_clearance_m(trace_of(ticks)), -0.002);
}

// The slave is behind the surface in the last tick, where the normal is not known.
TEST(SlaveMeasures, HaveNoValueForAForceThatIsNotKnown) {
  const Trace trace = trace_of({{0, 0, 0.001, 0}, {0, kUnknown, -0.001, 1}});
  EXPECT_TRUE(std::isnan(max_slave_force_N(trace)));
  EXPECT_TRUE(std::isnan(slave_touched(trace)));
  EXPECT_TRUE(std::isnan(slave_contact_fraction(trace)));
  EXPECT_TRUE(std::isnan(first_slave_contact_time_s(trace)));
  EXPECT_EQ(min_slave_clearance_m(trace), -0.001);
  const Trace later = trace_of({{0, 3, -0.001, 0}, {0, kUnknown, -0.001, 1}});
  EXPECT_TRUE(std::isnan(max_slave_force_N(later)));
  EXPECT_EQ(slave_touched(later), 1);
  EXPECT_EQ(first_slave_contact_time_s(later), 0);
}

struct ToolTick {
  bool commands_tool;  // the slave is sent where the renderer's tool is, else where the device is
  double device_rad, tool_rad, slave_rad;
};

// All turn about one axis. The renderer's tool is 1 cm above the device.
Trace trace_of(const std::vector<ToolTick>& ticks) {
  const auto turned = [](double angle) { return rotation(angle * Vec3(0.36, 0.48, 0.8)); };
  Trace trace;
  for (const ToolTick& tick : ticks) {
    DeviceState device;
    device.position_W = Vec3(1, 2, 3), device.orientation_W = turned(tick.device_rad);
    RenderOutput out;
    out.proxy_W = Vec3(1, 2.01, 3);
    out.tool.emplace().orientation_W = turned(tick.tool_rad);
    out.slave_W = tick.commands_tool ? out.proxy_W : device.position_W;
    SlaveState slave;
    slave.tool.emplace().orientation_W = turned(tick.slave_rad);
    trace.append(0.001 * static_cast<double>(trace.length()), device, out, {}, HandState{}, slave);
  }
  return trace;
}

TEST(SlaveMeasures, TheLagInRotationIsThatBehindTheCommand) {
  EXPECT_NEAR(rms_slave_lag_angle_rad(trace_of(std::vector<ToolTick>{{true, 3, 0.5, 0.2}})), 0.3, 1e-12);
  EXPECT_NEAR(rms_slave_lag_angle_rad(trace_of(std::vector<ToolTick>{{false, 0.9, 3, 0.5}})), 0.4, 1e-12);
  EXPECT_NEAR(
      rms_slave_lag_angle_rad(trace_of(std::vector<ToolTick>{{true, 3, 0.5, 0.2}, {false, 0.9, 3, 0.5}})),
      std::sqrt((0.09 + 0.16) / 2), 1e-12);
  EXPECT_TRUE(std::isnan(rms_slave_lag_angle_rad(trace_of(kTouch)))) << "a ball";
}

// Before the first command the state of the slave is NaN, and so is the command.
TEST(SlaveMeasures, TheLagInRotationIgnoresTicksWithoutACommand) {
  Trace trace =
      trace_of(std::vector<ToolTick>{{true, 0, 0.1, kUnknown}, {false, 0, 0, kUnknown}, {true, 0, 0.1, 0.3}});
  trace.slave_command_m[0].setConstant(kUnknown);
  trace.hip_orientation[1].coeffs().setZero();
  EXPECT_NEAR(rms_slave_lag_angle_rad(trace), 0.2, 1e-12);
  trace.slave_command_m[2].setConstant(kUnknown);
  EXPECT_TRUE(std::isnan(rms_slave_lag_angle_rad(trace)));
}

TEST(SlaveMeasures, BelongToRunsWithASlave) {
  const Trace with = trace_of(kTouch);
  Trace without;
  without.append(0, {}, {}, {});
  int measures = 0;
  for (const Measure& measure : built_in_measures()) {
    if (measure.runs != MeasuredRuns::slave) continue;
    EXPECT_TRUE(applies(measure, with)) << measure.name;
    EXPECT_FALSE(applies(measure, without)) << measure.name;
    EXPECT_TRUE(std::isnan(value_of(measure, without))) << measure.name;
    ++measures;
  }
  EXPECT_EQ(measures, 14);
  EXPECT_EQ(value_of(measure_named("max_slave_force"), with), 7);
}

}  // namespace
}  // namespace remote_touch::slave_measures_test
