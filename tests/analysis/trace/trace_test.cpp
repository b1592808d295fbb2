// Hashes of clouds and runs: what changes them, what does not, and that a difference persists to the end.

#include "analysis/trace/trace.h"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "runners/experiment/simulation/simulation.h"
#include "tests/support/scenes.h"

namespace remote_touch::column_hash_test {
namespace {

TEST(Fingerprint, CloudHashDependsOnEveryBitButNotOnTheOrder) {
  PointCloud cloud = scenes::random_cloud(300, 0.1, 1);
  const std::uint64_t reference = points_hash(cloud);
  PointCloud turned = cloud;
  for (auto* column : {&turned.x, &turned.y, &turned.z}) std::reverse(column->begin(), column->end());
  EXPECT_EQ(points_hash(turned), reference);
  for (auto* column : {&cloud.x, &cloud.y, &cloud.z}) {
    const double kept = column->at(150);
    column->at(150) = std::nextafter(kept, 1);
    EXPECT_NE(points_hash(cloud), reference);
    column->at(150) = kept;
  }
  std::swap(cloud.x[3], cloud.x[4]);  // the same numbers, but other points
  EXPECT_NE(points_hash(cloud), reference);
  std::swap(cloud.x[3], cloud.x[4]);
  cloud.fixture_radius_m.assign(cloud.size(), 0);
  EXPECT_NE(points_hash(cloud), reference);
}

// The chain that the header describes, computed by hand.
TEST(Fingerprint, EqualsTheChainComputedByHand) {
  const std::vector<Column> columns = {{"a", "1", "", std::vector<double>{0.5, 2}},
                                       {"b", "1", "", std::vector<std::int32_t>{-1, 7, 8, 9}, 2, {}}};
  const std::uint64_t row0 = mixed(mixed(mixed(0, 0x3fe0000000000000u), ~std::uint64_t{0}), 7);
  const std::uint64_t row1 = mixed(mixed(mixed(0, 0x4000000000000000u), 8), 9);
  const std::uint64_t first = mixed(0, row0);
  EXPECT_EQ(running_hash(columns), (std::vector<std::uint64_t>{first, mixed(first, row1)}));
  EXPECT_EQ(mixed(0, 1), 0x9e3779b9e17d05acu);  // the value that any other program computes
}

// Two seeds have other points in every frame, so their hashes differ in every tick. The hash of one run
// changes at each frame update and only there.
TEST(Fingerprint, TraceHasFrameHashesOnlyOnRequest) {
  SimulationOptions options;
  EXPECT_EQ(simulate(Experiment::load("fig4.12"), options).frame_hash.back(), 0u);
  options.hash_frames = true;
  const Trace one = simulate(Experiment::load("fig4.12"), options);
  const Trace other = simulate(Experiment::load("fig4.12", {"seed=2"}), options);
  for (std::size_t i = 0; i < one.length(); ++i) {
    EXPECT_NE(one.frame_hash[i], other.frame_hash[i]);
    EXPECT_EQ(i > 0 && one.frame_hash[i] != one.frame_hash[i - 1], one.frame_update(i));
  }
}

}  // namespace
}  // namespace remote_touch::column_hash_test

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

// The columns of a trace follow from the table trace_columns.h: each is filled, stored and described.
namespace remote_touch {
namespace {

// A trace of one tick with distinct numbers, so that swapped columns are found.
Trace one_tick(bool tool, bool guidance, bool hand, bool replay = false, bool measured = false,
               bool remote = false) {
  RenderOutput out;
  out.proxy_W = {1, 2, 3}, out.state = ContactState::entrenched, out.contact_count = 4;
  if (tool) {
    out.tool.emplace();
    out.tool->orientation_W = Eigen::Quaterniond(0.5, 0.1, -0.7, 0.5);
    out.tool->budget_exhausted = true;
  }
  if (guidance) out.guidance.emplace().sequence_missed = 7;
  DeviceState device;
  device.buttons = 9;
  Trace::Truth truth{5, 6, 0xfedcba9876543210u};
  if (replay) truth.expected_force_N = Vec3(11, 12, 13);
  if (measured) truth.measured_distance_m = 14;
  Trace trace;
  std::optional<HandState> state;
  if (hand) state.emplace();
  if (hand && remote) state->true_pose.emplace();
  std::optional<SlaveState> slave;
  if (remote) slave.emplace().energy.emplace();
  if (remote && tool) slave->tool.emplace();
  trace.append(0.25, device, out, truth, state, slave);
  return trace;
}

std::vector<std::string> names(const std::vector<Column>& columns) {
  std::vector<std::string> list;
  for (const Column& column : columns) list.push_back(column.name);
  return list;
}

const Column& find(const std::vector<Column>& columns, const std::string& name) {
  for (const Column& column : columns)
    if (column.name == name) return column;
  throw std::out_of_range(name);
}

template <class Number>
std::vector<Number> values(const Trace& trace, const std::string& name) {
  return std::get<std::vector<Number>>(find(trace.columns(), name).values);
}

TEST(TraceColumns, AreThoseOfTheTableInItsOrder) {
  const std::vector<Column> columns = one_tick(true, true, true, true, true, true).columns();
  ASSERT_EQ(columns.size(), trace_columns().size());
  std::set<std::string> seen;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const TraceColumn& described = trace_columns()[i];
    EXPECT_EQ(columns[i].name, described.name);
    EXPECT_EQ(columns[i].units, described.unit);
    EXPECT_EQ(columns[i].width, described.width) << described.name;
    EXPECT_EQ(columns[i].value_names, described.value_names) << described.name;
    EXPECT_EQ(columns[i].length(), 1u) << described.name;
    EXPECT_TRUE(seen.insert(described.name).second) << described.name << " is there twice";
  }
  EXPECT_STREQ(trace_columns().back().name, "tick_hash");
}

TEST(TraceColumns, ARunHasTheColumnsOfItsParts) {
  const std::size_t always = names(one_tick(false, false, false).columns()).size();
  EXPECT_EQ(always, 19u);
  EXPECT_EQ(names(one_tick(true, false, false).columns()).size(), always + 9);
  EXPECT_EQ(names(one_tick(false, true, false).columns()).size(), always + 10);
  EXPECT_EQ(names(one_tick(false, false, true).columns()).size(), always + 5);
  EXPECT_EQ(names(one_tick(false, false, false, true).columns()).size(), always + 1);
  EXPECT_EQ(names(one_tick(false, false, false, false, true).columns()).size(), always + 1);
  const Trace ball = one_tick(false, false, true, false, false, true);
  EXPECT_TRUE(ball.has_slave());
  EXPECT_FALSE(ball.has_slave_tool());
  const std::vector<std::string> list = names(ball.columns());
  for (const char* name : {"slave_orientation", "slave_torque", "expected_force", "measured_distance"})
    EXPECT_EQ(std::count(list.begin(), list.end(), name), 0) << name;
}

std::optional<Trace> again(const std::vector<Column>& columns) {
  return trace_of([&](const std::string& name) {
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const Column& c) { return c.name == name; });
    return found == columns.end() ? std::nullopt : std::optional(*found);
  });
}

// The last column is the hash of all others, so equal hashes show that all values were restored.
TEST(TraceColumns, RestoreTheTrace) {
  for (const bool tool : {false, true})
    for (const bool guidance : {false, true})
      for (const bool hand : {false, true})
        for (const bool replay : {false, true})
          for (const bool measured : {false, true}) {
            const std::vector<Column> columns = one_tick(tool, guidance, hand, replay, measured).columns();
            const std::optional<Trace> trace = again(columns);
            ASSERT_TRUE(trace);
            EXPECT_EQ(trace->columns().back().values, columns.back().values);
            EXPECT_EQ(trace->columns().size(), columns.size());
          }
}

// The columns of a slave, and those of a hand whose pose the device rounds.
TEST(TraceColumns, RestoreASlaveAndARoundedHand) {
  Trace trace;
  for (const double i : {1.0, 2.0}) {
    HandState hand;
    hand.true_pose = HandState::Pose{{i, 2, 3}, Eigen::Quaterniond(0.5, 0.5, 0.5, 0.5)};
    SlaveState slave{{4, i, 6}, {7, 8, i}, {i, 0, 1}, 10 + i, 11, 12, 13, 14, {}, {}};
    slave.tool = SlaveToolState{Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {i, 20, 21}};
    trace.append(i, {}, {}, {}, hand, slave);
  }
  const std::vector<Column> columns = trace.columns();
  EXPECT_EQ(values<double>(trace, "slave_orientation"),
            (std::vector<double>{0.5, 0.5, -0.5, 0.5, 0.5, 0.5, -0.5, 0.5}));
  EXPECT_EQ(values<double>(trace, "slave_torque"), (std::vector<double>{1, 20, 21, 2, 20, 21}));
  EXPECT_EQ(values<double>(trace, "hand_position"), (std::vector<double>{1, 2, 3, 2, 2, 3}));
  EXPECT_EQ(values<double>(trace, "slave_position"), (std::vector<double>{7, 8, 1, 7, 8, 2}));
  EXPECT_EQ(values<double>(trace, "slave_peak_force"), (std::vector<double>{11, 12}));
  EXPECT_EQ(values<std::int32_t>(trace, "force_packets"), (std::vector<std::int32_t>{13, 13}));
  EXPECT_EQ(values<std::int32_t>(trace, "frame_packets"), (std::vector<std::int32_t>{14, 14}));
  const std::optional<Trace> restored = again(columns);
  ASSERT_TRUE(restored);
  EXPECT_TRUE(restored->has_slave());
  EXPECT_TRUE(restored->has_slave_tool());
  EXPECT_TRUE(restored->has_rounded_hand());
  EXPECT_EQ(restored->columns().back().values, columns.back().values);
}

// The only column of a replay or of a measured surface may be missing: the trace is then one without it.
TEST(TraceColumns, RestoreNoTraceIfOneIsMissingOrWrong) {
  const std::vector<Column> all = one_tick(true, true, true).columns();
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    std::vector<Column> columns = all;
    columns.erase(columns.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(again(columns)) << all[i].name << " is missing";
    columns = all;
    columns[i].values = std::vector<std::string>{"x"};
    EXPECT_FALSE(again(columns)) << all[i].name << " is a text";
    columns = all;
    columns[i].width += 1;
    EXPECT_FALSE(again(columns)) << all[i].name << " is wider";
    columns = all;
    std::visit([](auto& values) { values.clear(); }, columns[i].values);
    EXPECT_FALSE(again(columns)) << all[i].name << " is shorter";
  }
}

// A tool has no proxy of radius r_c, so no description of a run with a tool may mention a proxy.
TEST(TraceColumns, DoNotMentionAProxyForATool) {
  const std::vector<Column> proxy = one_tick(false, false, false, false, true).columns();
  const std::vector<Column> tool = one_tick(true, false, false, false, true).columns();
  for (const char* name :
       {"contact_count", "nearest_distance", "signed_distance", "measured_distance", "proxy_position"}) {
    EXPECT_NE(find(proxy, name).long_name.find("proxy"), std::string::npos) << name;
    EXPECT_NE(find(tool, name).long_name.find("tool"), std::string::npos) << name;
  }
  for (const Column& column : tool)
    EXPECT_EQ(column.long_name.find("proxy"), std::string::npos) << column.name << ": " << column.long_name;
}

}  // namespace
}  // namespace remote_touch
