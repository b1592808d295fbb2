// Measures of the slave: traces whose values are known.
#include "analysis/measures/slave_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "analysis/measures/measures.h"
#include "analysis/trace/trace.h"
#include "core/geometry/rotation.h"
#include "tests/analysis/measures/measure_named.h"

namespace remote_touch::slave_measures_test {
namespace {

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
