// Measures of runs: their direction, the runs to which they apply, outcomes and counts, and properties that
// all of them have.
#include "analysis/trace/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/interval_estimates.h"
#include "tests/analysis/trace/example_traces.h"

namespace remote_touch::measures_test {
namespace {

using namespace example_traces;

// More force is no better and no worse: a proxy that popped through exerts none. A renderer that follows a
// bad measurement exactly is not better.
TEST(BetterOfMeasures, IsInTheirTable) {
  const std::map<Better, std::vector<const char*>> table = {
      {Better::smaller,
       {"popped_through", "rms_contact_error", "rms_force_jump", "force_noise", "tool_popped_through",
        "max_tool_penetration", "guidance_error", "mean_lateral_force"}},
      {Better::not_negative, {"min_slave_distance", "min_clearance"}},
      {Better::larger, {"contact_force_fraction"}},
      {Better::near_zero, {"mean_height", "apparent_friction"}},
      {Better::neither,
       {"max_force", "max_torque", "energy_injected", "force_fraction", "last_force_time", "end_distance",
        "rms_renderer_error", "rms_camera_error", "mean_camera_error", "popped_through_truth"}}};
  for (const auto& [better, names] : table)
    for (const char* name : names) EXPECT_EQ(measure_named(name).better, better) << name;
  const Directions directions = {{"x", Better::larger}};
  EXPECT_EQ(direction_of(directions, "x"), Better::larger);
  EXPECT_EQ(direction_of(directions, "y"), Better::neither);
}

TEST(Badness, IsSmallerWhereItIsBetter) {
  EXPECT_LT(badness(1, Better::smaller), badness(2, Better::smaller));
  EXPECT_GT(badness(1, Better::larger), badness(2, Better::larger));
  EXPECT_LT(badness(-1, Better::near_zero), badness(2, Better::near_zero));
  EXPECT_LT(badness(1, Better::near_zero), badness(-2, Better::near_zero));
  EXPECT_LT(badness(-1, Better::not_negative), badness(-2, Better::not_negative));
  EXPECT_LT(badness(0, Better::not_negative), badness(-1, Better::not_negative));
  EXPECT_EQ(badness(1, Better::not_negative), badness(2, Better::not_negative));
}

// A measure of a part that a run does not have is NaN. A true normal that is known in one tick is enough.
TEST(Measures, ApplyToRunsWithWhatTheyMeasure) {
  using enum MeasuredRuns;
  const Trace::TrueContact point{0, -0.01};
  const SlaveState state{};
  Trace with_slave;
  with_slave.append(0, {}, {}, {}, {}, state);
  const std::map<MeasuredRuns, Trace> with = {
      {proxy, run_of({{}})},
      {contact, run_of({{.contact = point}})},
      {measured_surface, run_of({{.contact = point, .measured_m = 0.004}})},
      {true_normal, run_of({{.normal = kUnknownVector}, {.normal = Vec3::UnitY()}})},
      {replay, run_of({{.expected_N = Vec3::UnitY()}})},
      {guidance, run_of({{.guidance_N = Vec3::Zero()}})},
      {tool, run_of({{.torque_Nm = Vec3::Zero()}})},
      {MeasuredRuns::slave, with_slave}};
  std::map<MeasuredRuns, int> found;
  for (const Measure& measure : built_in_measures()) {
    ++found[measure.runs];
    for (const auto& [part, trace] : with) {
      const bool expected = measure.runs == all || measure.runs == part ||
                            (measure.runs == proxy && part != tool) ||
                            (measure.runs == contact && part == measured_surface);
      EXPECT_EQ(applies(measure, trace), expected) << measure.name;
      if (expected) continue;
      EXPECT_TRUE(std::isnan(value_of(measure, trace))) << measure.name;
      if (measure.runs == proxy || measure.runs == MeasuredRuns::slave) continue;
      EXPECT_TRUE(std::isnan(measure.compute(trace))) << measure.name;
    }
    EXPECT_EQ(needs_true_contact(measure),
              measure.runs == contact || measure.runs == true_normal || measure.runs == measured_surface)
        << measure.name;
    EXPECT_FALSE(measure.runs == true_normal && applies(measure, run_of({{.normal = kUnknownVector}})));
  }
  for (const auto& [part, trace] : with) EXPECT_GE(found[part], 3) << name_of(part);
}

// --- outcomes and counts ---

Trace at_distances(const std::vector<double>& distance_m, const std::vector<int>& frames = {}) {
  std::vector<Tick> ticks;
  for (std::size_t i = 0; i < distance_m.size(); ++i)
    ticks.push_back({.frame = i < frames.size() ? frames[i] : 0, .distance_m = distance_m[i]});
  return run_of(ticks);
}

// Depth and side are those of the ticks with a known truth and a frame.
TEST(Measures, PopThroughIsJudgedAtTheEndAndDepthAlways) {
  const struct {
    std::vector<double> distance_m;
    double popped_through, max_penetration_m, wrong_side;
    std::vector<int> frames = {};
  } rows[] = {{{-0.01, 0.005}, 0, 0.01, 0.5},
              {{0.005, -1e-9}, 1, 1e-9, 0.5},
              {{0.005, -0.003, -0.001}, 1, 0.003, 2 / 3.0},
              {{-0.01, kUnknown}, kUnknown, 0.01, 1},
              {{kUnknown, 0.005, kUnknown}, kUnknown, 0, 0},
              {{kUnknown, kUnknown}, kUnknown, kUnknown, kUnknown},
              {{0.005, kUnknown, -0.003, 0.0, -1e-9}, 1, 0.003, 0.5},
              {{0.005, -0.02, 0.005}, 0, 0, 0, {0, -1, 0}},
              {{0.01, -0.02, -0.001}, 0, 0.001, 1, {-1, -1, 0}},  // it was behind when the frame came
              {{0.01, -0.02}, kUnknown, kUnknown, kUnknown, {-1, -1}}};
  for (const auto& row : rows) {
    SCOPED_TRACE(testing::PrintToString(row.distance_m));
    const Trace trace = at_distances(row.distance_m, row.frames);
    expect_values(trace,
                  {{"popped_through", row.popped_through}, {"max_penetration", row.max_penetration_m}});
    const double wrong = wrong_side_fraction(trace);
    EXPECT_TRUE(std::isnan(row.wrong_side) ? std::isnan(wrong) : std::abs(wrong - row.wrong_side) < 1e-15);
  }
}

TEST(Measures, AProxyThatRestsOnTheSurfaceIsNotBehindIt) {
  Trace resting = at_distances({0.01, -2.37e-16, 0.0001, -0.0004});
  EXPECT_EQ(popped_through(resting), 1) << "a ball's centre";
  EXPECT_EQ(wrong_side_fraction(resting), 0.5);
  resting.held_depth_m = 0.0025;
  EXPECT_EQ(popped_through(resting), 0);
  EXPECT_EQ(wrong_side_fraction(resting), 0);
  EXPECT_EQ(max_penetration_m(resting), 0.0004) << "a depth is a depth";
}

TEST(Measures, ARunWithAMeasuredSurfaceIsJudgedByIt) {
  Trace trace = at_distances({0.01, 0.004, -0.002});
  trace.measured_distance_m = {0.012, 0.007, 0.001};
  EXPECT_EQ(popped_through(trace), 0) << "the camera's error";
  trace.contact.resize(3);
  EXPECT_EQ(value("popped_through_truth", trace), 1);
  trace.measured_distance_m.back() = -0.001;
  EXPECT_EQ(popped_through(trace), 1);
}

TEST(Measures, CountForcesStepsAndTicksWithoutConvergence) {
  const Tick quick{.force_N = {0, 5, 0}, .steps = 2},
      slow{.force_N = {0, -7, 0}, .steps = 30, .converged = false};
  expect_values(run_of({quick, quick, slow, quick}), {{"mean_steps", 9},
                                                      {"max_steps", 30},
                                                      {"unconverged_fraction", 0.25},
                                                      {"non_finite_fraction", 0},
                                                      {"max_force", 7}});
  expect_values(Trace(), {{"mean_steps", 0},
                          {"max_steps", 0},
                          {"unconverged_fraction", 0},
                          {"non_finite_fraction", 0},
                          {"max_force", 0}});
}

// Results are compared bit by bit, and the NaN of 0 / 0 has another sign on some machines.
TEST(Measures, NoValueHasTheSameBitsEverywhere) {
  for (const Trace& trace : {Trace(), at_distances({kUnknown, kUnknown})})
    for (const auto measure :
         {max_penetration_m, min_slave_distance_m, wrong_side_fraction, rms_surface_error_m})
      EXPECT_EQ(std::bit_cast<std::uint64_t>(measure(trace)), std::bit_cast<std::uint64_t>(kNoValue));
}

// --- unknown numbers ---

// Calls act(name, unit, rows) for each column of the trace.
template <class Act>
void for_each_column(Trace& trace, const Act& act) {
#define TRACE_COLUMN(member, Row, name, unit, ...) act(std::string(name), std::string(unit), trace.member);
#include "analysis/trace/trace_columns.h"
#undef TRACE_COLUMN
}

// A run with a contact and with every column, in which every tick is as bad as the others of its kind: the
// force and the torque change at every second tick, with a frame. So no measure can get better because a tick
// is left out.
Trace steady_run(bool tool) {
  Trace trace;
  const Vec3 up = Vec3::UnitY();
  for (int i = 0; i < 400; ++i) {
    RenderOutput out;
    const double size = i % 4 < 2 ? 2 : 3;
    out.force_N = size * Vec3(0.2, 1, 0), out.normal_W = up, out.proxy_W = {0, -0.001, 0};
    out.slave_W = out.proxy_W, out.nearest_distance_m = -0.002, out.frame_index = i / 2;
    out.state = ContactState::contact, out.steps = 3, out.contact_count = 4;
    GuidanceOutput& guidance = out.guidance.emplace();
    guidance.active = true, guidance.force_N = size * Vec3(0.05, 0, 0.05);
    guidance.goal_W = {0.01, 0, 0}, guidance.goal_orientation_W = rotation({0, 0.2, 0});
    DeviceState device{{0, -0.01, 0}};
    HandState hand;
    hand.force_N = out.force_N, hand.true_pose.emplace().position_W = {0, -0.011, 0};
    SlaveState slave;
    slave.position_W = {0.003, 0, 0}, slave.force_N = up, slave.peak_force_N = 1, slave.energy.emplace();
    if (tool) {
      out.tool.emplace().torque_Nm = size * Vec3(0.01, 0, 0);
      out.tool->tool_penetration_m = 0.001, out.tool->detections = 2, out.tool->budget_exhausted = true;
      device.orientation_W = rotation({0.5, 0, 0});
      slave.tool.emplace().orientation_W = rotation({-0.1, 0, 0}), slave.tool->torque_Nm = up;
    }
    Trace::Truth truth{-0.001, -0.001, 0};
    truth.contact = Trace::TrueContact{-0.001, -0.01}, truth.normal = up,
    truth.expected_force_N = Vec3::Zero(), truth.measured_distance_m = -0.001;
    trace.append(0.001 * i, device, out, truth, hand, slave);
  }
  return trace;
}

// Returns true if the value is a number that is now unknown, or of which one part is.
bool make_unknown(double& value, bool one_part) {
  if (!one_part) value = kNoValue;
  return !one_part;
}
bool make_unknown(Vec3& value, bool one_part) {
  if (!one_part) value.setConstant(kNoValue);
  value.z() = kNoValue;
  return true;
}
bool make_unknown(Eigen::Quaterniond& value, bool one_part) {
  return make_unknown(value.w(), one_part);
}
template <class Integer>
bool make_unknown(Integer&, bool) {
  return false;
}

// A number that is not known in one tick is never good: a measure has no value then, or it is no better than
// before. The time is always known; without an expected force there is nothing to compare with.
TEST(Measures, AnUnknownNumberNeverMakesAMeasureBetter) {
  std::vector<std::string> columns;
  Trace every = steady_run(true);
  for_each_column(every, [&](const std::string& name, const std::string&, const auto& rows) {
    EXPECT_FALSE(rows.empty()) << name;
    if (name != "time" && name != "expected_force") columns.push_back(name);
  });
  for (const bool tool : {false, true}) {
    const Trace known = steady_run(tool);
    const auto expect_no_better = [&](const Trace& spoiled, const std::string& what) {
      for (const Measure& measure : built_in_measures()) {
        if (measure.better == Better::neither) continue;
        const double before = badness(value_of(measure, known), measure.better);
        const double after = badness(value_of(measure, spoiled), measure.better);
        EXPECT_FALSE(after < before - 1e-9 * std::abs(before))
            << measure.name << ", " << what << ": " << before << " to " << after;
      }
    };
    for (const std::string& column : columns)
      for (const std::size_t tick : {200u, 203u, 399u})
        for (const bool one_part : {false, true}) {
          Trace spoiled = known;
          bool is_changed = false;
          for_each_column(spoiled, [&](const std::string& name, const std::string&, auto& rows) {
            if (name == column && tick < rows.size()) is_changed = make_unknown(rows[tick], one_part);
          });
          if (!is_changed) continue;
          if (column == "proxy_position")
            spoiled.signed_distance_m[tick] = spoiled.measured_distance_m[tick] =
                spoiled.contact[tick].height_m = kNoValue;
          expect_no_better(spoiled, column + ", tick " + std::to_string(tick));
        }
  }
}

// A hand that presses and slides, with a frame every ten ticks and forces that are steady at the end.
Trace pressed_and_slid(bool tool) {
  Trace trace;
  for (int i = 0; i < 600; ++i) {
    RenderOutput out;
    DeviceState device{{1e-4 * i, -2e-5 * std::min(i, 300), 0}};
    const double size = i < 50 ? 0 : -500 * device.position_W.y() + (i < 400 && i / 10 % 2 == 0 ? 0.5 : 0);
    out.force_N = size * Vec3(0.2, 1, 0), out.normal_W = Vec3::UnitY(), out.frame_index = i / 10;
    out.state = ContactState::contact, out.nearest_distance_m = 0.005;
    if (tool) out.tool.emplace();
    Trace::Truth truth{0.005, 0.005, 0};
    truth.contact = Trace::TrueContact{0, device.position_W.y()}, truth.normal = Vec3::UnitY(),
    truth.expected_force_N = i == 350 ? Vec3::Zero() : Vec3(0, 1, 0);
    trace.append(0.001 * i, device, out, truth);
  }
  return trace;
}

// The axes and the origin of the world do not matter.
TEST(Measures, AreTheSameInAWorldThatIsTurnedAndMoved) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(0.99, 1.01);  // no force is at a threshold, no change the same
  const Eigen::Quaterniond turn = rotation({1, -2, 0.5});
  const Vec3 motion_m(0.3, -0.2, 0.5);
  for (const bool tool : {false, true})
    for (Trace level : {steady_run(tool), pressed_and_slid(tool)}) {
      for (Vec3& force_N : level.force_N) force_N *= noise(random);
      Trace turned = level;
      for_each_column(turned, [&](const std::string& name, const std::string& unit, auto& rows) {
        const bool are_positions = unit == "m" && name != "frame_correction";
        for ([[maybe_unused]] auto& row : rows) {
          using Row = std::decay_t<decltype(row)>;
          if constexpr (std::is_same_v<Row, Vec3>)
            row = turn * row + (are_positions ? motion_m : Vec3(Vec3::Zero()));
          if constexpr (std::is_same_v<Row, Eigen::Quaterniond>) row = turn * row;
        }
      });
      for (Vec3& normal : turned.true_normal) normal = turn * normal;
      for (const Measure& measure : built_in_measures()) {
        const double before = value_of(measure, level), after = value_of(measure, turned);
        EXPECT_TRUE(std::isnan(before) ? std::isnan(after)
                                       : std::abs(after - before) <= 1e-9 * (1 + std::abs(before)))
            << measure.name << ": " << before << " to " << after;
      }
    }
}

// Each measure that uses the force of a tick has no value if this force is unknown, except those whose header
// says that an unknown force is none, or that the tick does not count.
TEST(Measures, OfAForceThatIsUnknownInOneTickHaveNoValue) {
  const std::set<std::string> leave_it_out = {
      "force_fraction",       "contact_force_fraction", "last_force_time",        "mean_distance",
      "distance_sd",          "mean_lateral_force",     "lateral_force_95",       "mean_force_angle",
      "apparent_friction",    "rendered_stiffness",     "stiffness_error",        "stiffness_nonlinearity",
      "stiffness_hysteresis", "force_direction_error",  "false_contact_fraction", "lost_contact_fraction"};
  std::set<std::string> used;
  for (const bool tool : {false, true})
    for (const std::size_t tick : {49u, 50u, 109u, 110u, 111u, 240u, 350u, 450u, 560u, 598u, 599u})
      for (const Measure& measure : built_in_measures()) {
        const auto value_with = [&](double factor) {
          Trace trace = pressed_and_slid(tool);
          trace.force_N[tick] = factor * (trace.force_N[tick] + Vec3(0.1, 0.1, 0));
          return value_of(measure, trace);
        };
        const double value = value_with(1);
        if (value == value_with(5) && value == value_with(0)) continue;
        if (std::isnan(value) || leave_it_out.contains(measure.name)) continue;
        used.insert(measure.name);
        EXPECT_TRUE(std::isnan(value_with(kNoValue))) << measure.name << ", tick " << tick;
      }
  for (const char* name :
       {"max_force", "rms_force_jump", "jump_fraction_5", "packet_rate_5", "max_relative_jump",
        "max_relative_change", "force_overshoot", "force_ripple", "energy_injected"})
    EXPECT_TRUE(used.contains(name)) << name;
}

TEST(Measures, PrintNoNanWithASign) {
  Trace trace = steady_run(false);
  trace.force_N[200].setConstant(-kNoValue);
  for (const Measure& measure : built_in_measures()) {
    const double value = value_of(measure, trace);
    EXPECT_FALSE(std::isnan(value) && std::signbit(value)) << measure.name;
  }
}

TEST(Measures, AnUnknownForceIsNoForce) {
  Trace trace = steady_run(false);
  EXPECT_EQ(force_fraction(trace), 1);
  EXPECT_EQ(value_of(measure_named("contact_force_fraction"), trace), 1);
  for (Vec3& force_N : trace.force_N) force_N.setConstant(kNoValue);
  for (const char* name : {"force_fraction", "contact_force_fraction"})
    EXPECT_EQ(value_of(measure_named(name), trace), 0) << name;
  for (const char* name : {"max_force", "max_force_jump", "rms_force_jump", "force_noise", "jump_fraction_10",
                           "force_ripple", "mean_distance", "false_contact_fraction", "last_force_time"})
    EXPECT_TRUE(std::isnan(value_of(measure_named(name), trace))) << name;
  EXPECT_EQ(no_force_fraction(trace, 0.005), 1);
}

}  // namespace
}  // namespace remote_touch::measures_test
