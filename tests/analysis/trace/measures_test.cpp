#include "analysis/trace/measures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "tests/analysis/trace/measure_named.h"

namespace remote_touch::measures_test {
namespace {

// The direction in which each measure gets better.

TEST(BetterOfMeasures, IsInTheirTable) {
  for (const char* name : {"popped_through", "rms_contact_error", "rms_force_jump", "force_noise",
                           "tool_popped_through", "max_tool_penetration", "guidance_error"})
    EXPECT_EQ(measure_named(name).better, Better::smaller) << name;
  for (const char* name : {"min_slave_distance", "min_clearance"})
    EXPECT_EQ(measure_named(name).better, Better::not_negative) << name;
  EXPECT_EQ(measure_named("contact_force_fraction").better, Better::larger);
  EXPECT_EQ(measure_named("mean_height").better, Better::near_zero);
  // More force is no better and no worse: a proxy that popped through exerts none.
  for (const char* name :
       {"max_force", "max_torque", "energy_injected", "force_fraction", "last_force_time", "end_distance"})
    EXPECT_EQ(measure_named(name).better, Better::neither) << name;
}

double nothing(const Trace&) {
  return 0;
}

TEST(BetterOfMeasures, IsNeitherIfAProgramGivesNone) {
  EXPECT_EQ((Measure{"own", "1", "a measure of a program", MeasuredRuns::all, nothing}.better),
            Better::neither);
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

TEST(DirectionOf, AnUnlistedMeasureHasNoDirection) {
  const Directions directions = {{"x", Better::larger}};
  EXPECT_EQ(direction_of(directions, "x"), Better::larger);
  EXPECT_EQ(direction_of(directions, "y"), Better::neither);
  EXPECT_STREQ(text_of(direction_of(directions, "y")), "has no direction");
}

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

TEST(Measures, ARunWithAMeasuredSurfaceIsJudgedByIt) {
  Trace trace = trace_of({{0.01}, {0.004}, {-0.002}});
  trace.measured_distance_m = {0.012, 0.007, 0.001};
  EXPECT_EQ(popped_through(trace), 0) << "the camera's error";
  trace.contact.resize(3);
  EXPECT_EQ(value_of(measure_named("popped_through_truth"), trace), 1);
  trace.measured_distance_m.back() = -0.001;
  EXPECT_EQ(popped_through(trace), 1);
  trace.measured_distance_m.clear();
  EXPECT_TRUE(std::isnan(value_of(measure_named("popped_through_truth"), trace)));
}

TEST(Measures, TicksBeforeTheFirstFrameDoNotCount) {
  const Tick early{-0.02, 0, -1}, front{0.005}, back{-0.001};
  EXPECT_EQ(popped_through(trace_of({front, early, front})), 0);
  EXPECT_EQ(popped_through(trace_of({{0.01, 0, -1}, early, back})), 0) << "it was behind when the frame came";
  EXPECT_TRUE(std::isnan(popped_through(trace_of({{0.01, 0, -1}, early})))) << "no frame";
  EXPECT_EQ(max_penetration_m(trace_of({early, front})), 0);
  EXPECT_EQ(wrong_side_fraction(trace_of({early, front, back})), 0.5);
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
