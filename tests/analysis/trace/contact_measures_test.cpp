// Measures of contact: pop-through, events, height and distance of the surface, the settled contact point,
// and the direction of the force against the true normal.
#include "analysis/trace/contact_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/force_measures.h"
#include "analysis/trace/measures.h"
#include "tests/analysis/trace/example_traces.h"

namespace remote_touch::contact_measures_test {
namespace {

using namespace example_traces;

TEST(SurfaceSide, PopsThroughFromTheFrontToTheBackIfTheWayIsKnown) {
  const struct {
    std::vector<double> distance_m;
    double popped_through;
    std::vector<std::size_t> ticks;  // ticks in which it pops through
    double held_depth_m = 0;
  } rows[] = {{{0.01, 0, -1e-9}, 1, {2}},
              {{0.01, -0.01, 0.01}, 0, {1}},  // it came back
              {{0.01, 0.005}, 0, {}},
              {{0.1, 0, -0.1, -0.2, 0.1, -0.1}, 1, {2, 5}},
              {{-0.03, -0.002, -0.03}, 0, {}},  // it began behind
              {{-0.03, 0.002, -0.03}, 1, {2}},
              // A position on the surface is held up to a depth.
              {{0.01, -2.37e-16}, 0, {}, 0.0025},
              {{0.01, -0.0025}, 0, {}, 0.0025},
              {{0.01, -0.001, -0.0026}, 1, {2}, 0.0025},
              {{0.01, -0.001, 0.001, -0.003}, 1, {3}, 0.0025},
              {{}, kUnknown, {}},
              {{0.01, -0.01, kUnknown}, kUnknown, {1}},
              {{0.01, kUnknown, -0.01}, kUnknown, {}},  // perhaps round the border
              {{kUnknown, -0.01}, kUnknown, {}},
              {{kUnknown, 0.01, -0.01}, 1, {2}},
              {{0.01, -0.01, kUnknown, -0.01}, 1, {1}},
              {{-0.01, kUnknown, -0.01}, 0, {}},
              {{0.01, kUnknown, 0.01}, 0, {}}};
  for (const auto& row : rows) {
    SCOPED_TRACE(testing::PrintToString(row.distance_m));
    SurfaceSide side(row.held_depth_m);
    std::vector<std::size_t> ticks;
    for (std::size_t i = 0; i < row.distance_m.size(); ++i)
      if (side.add(row.distance_m[i])) ticks.push_back(i);
    EXPECT_EQ(ticks, row.ticks);
    if (std::isnan(row.popped_through))
      EXPECT_TRUE(std::isnan(side.popped_through()));
    else
      EXPECT_EQ(side.popped_through(), row.popped_through);
  }
}

// --- events ---

Trace at_distances(const std::vector<double>& distance_m) {
  std::vector<Tick> ticks;
  for (const double each_m : distance_m) ticks.push_back({.distance_m = each_m});
  return run_of(ticks, 0.002);
}

TEST(EventTimes, AreThoseOfTheFirstTickOfTheEvent) {
  const Trace touches = run_of({{.contacts = 0}, {.contacts = 0}, {.contacts = 3}, {.contacts = 0}}, 0.002);
  expect_values(touches, {{"first_contact_tick", 2}, {"first_contact_time", touches.time_s[2]}});
  EXPECT_EQ(first_contact_tick(run_of({{.contacts = 1}})), 0);
  // The first pop-through counts also if the proxy comes back.
  const Trace pops = at_distances({-0.001, 0.01, 0.001, -0.001, 0.001, -0.001});
  expect_values(pops, {{"first_pop_through_tick", 3}, {"first_pop_through_time", pops.time_s[3]}});
  expect_no_values(at_distances({0.001, kUnknown, -0.001}), {"first_pop_through_tick"});
  // The first of the largest jumps at a frame update.
  const Trace jumps =
      run_of({pushed(0, 0), pushed(9, 0), pushed(11, 1), pushed(14, 2), pushed(11, 3), pushed(0, 3)});
  expect_values(
      jumps, {{"max_force_jump_tick", 3}, {"max_force_jump_time", jumps.time_s[3]}, {"max_force_jump", 3}});
}

TEST(EventTimes, AnEventThatDidNotHappenIsNan) {
  const Trace calm = run_of({pushed(2, 0), pushed(2, 1)});
  EXPECT_EQ(max_force_jump_N(calm), 0);
  for (const char* name : {"first_contact", "first_pop_through", "max_force_jump"})
    for (const char* ending : {"_time", "_tick"}) {
      const std::string measure = std::string(name) + ending;
      EXPECT_TRUE(std::isnan(value(measure, calm)) && std::isnan(value(measure, Trace()))) << measure;
      EXPECT_EQ(measure_named(measure).unit, std::string(ending) == "_time" ? "s" : "1");
    }
}

// --- height and distance ---

TEST(ContactMeasures, HeightIsThatOfTheRenderedSurfaceOverTheTrueOne) {
  const Tick above{.distance_m = 0.0058}, below{.distance_m = 0.0042, .nearest_m = 0.0048},
      free{.state = ContactState::free, .distance_m = 0.5, .nearest_m = 0.1}, dark{.distance_m = kUnknown},
      alone{.nearest_m = std::numeric_limits<double>::infinity()};
  // Three of four heights are 0.8 mm and one is -0.6 mm: 1.4 mm sqrt(3/4 1/4).
  expect_values(run_of({above, free, above, dark, below, alone, above}),
                {{"mean_height", (3 * 0.0008 - 0.0006) / 4},
                 {"height_sd", 0.0014 * std::sqrt(3.0) / 4},
                 {"rms_surface_error", std::sqrt((3 * 64e-8 + 36e-8) / 4)}});
  expect_no_values(run_of({free, dark, alone}), {"mean_height", "height_sd", "rms_surface_error"});
}

TEST(ContactMeasures, DistanceNeedsAForceButNoPoints) {
  const Vec3 force_N(0, 1, 0);
  const Tick near{.force_N = force_N, .distance_m = 0.004}, silent{.distance_m = 0.5},
      far{.force_N = force_N,
          .state = ContactState::free,
          .distance_m = 0.008,
          .nearest_m = std::numeric_limits<double>::infinity()},
      dark{.force_N = force_N, .distance_m = kUnknown};
  // Two of three distances are 4 mm below the third: 4 mm sqrt(2/3 1/3).
  expect_values(run_of({near, silent, far, dark, near}),
                {{"mean_distance", 0.016 / 3}, {"distance_sd", 0.004 * std::sqrt(2.0) / 3}});
  expect_no_values(run_of({silent, dark}), {"mean_distance", "distance_sd"});
}

// The mean of three times 0.1 differs from 0.1 in the last bit. No other scatter may remain.
TEST(ContactMeasures, EqualTicksHaveNoScatter) {
  const Tick same{.force_N = {0, 1, 0}, .distance_m = 0.1, .nearest_m = 0};
  expect_values(run_of({same, same, same}), {{"height_sd", 0}, {"distance_sd", 0}});
}

TEST(ContactMeasures, EndDistanceIsThatOfTheLastTick) {
  EXPECT_EQ(value("end_distance", at_distances({0.01, -0.004})), -0.004);
  expect_no_values(at_distances({0.01, kUnknown}), {"end_distance"});
  expect_no_values(Trace(), {"end_distance"});
}

TEST(ContactMeasures, CountTicksWithAForce) {
  expect_values(run_of({pushed(0), pushed(1e-12), pushed(-2), pushed(0), pushed(0)}),
                {{"force_fraction", 0.4}, {"last_force_time", 0.002}});
  expect_values(run_of({pushed(0)}), {{"force_fraction", 0}, {"last_force_time", kUnknown}});
  EXPECT_EQ(force_fraction(Trace()), 0);
}

// --- settled contact ---

constexpr double kTick_s = 0.02;  // the settling lasts five intervals

Tick below_surface(double height_m, double hip_distance_m = -0.01) {
  return {.force_N = {0, 1, 0}, .contact = Trace::TrueContact{height_m, hip_distance_m}};
}

// A trace of contact points of these heights after five ticks of settling, which no measure may use.
Trace settled(const std::vector<double>& height_m) {
  std::vector<Tick> ticks(5, below_surface(-1));
  for (Tick& tick : ticks) tick.force_N.setZero();
  for (const double each_m : height_m) ticks.push_back(below_surface(each_m));
  return run_of(ticks, kTick_s);
}

TEST(SettledContact, TheWorstTickCountsOnEitherSide) {
  expect_values(settled({0.001, -0.004, 0.003, 0}), {{"max_contact_error", 0.004},
                                                     {"max_sink", 0.004},
                                                     {"max_float", 0.003},
                                                     {"rms_contact_error", std::sqrt(26 / 4.0) * 1e-3}});
  expect_values(settled({0.004, -0.001}), {{"max_contact_error", 0.004}});
  expect_values(settled({0.004}), {{"max_sink", 0}});
  expect_values(settled({-0.004}), {{"max_float", 0}});
}

// The settling begins with the first frame, and again after the hand leaves the surface.
TEST(SettledContact, TheFirstTenthOfASecondBelowTheSurfaceIsNotJudged) {
  const std::vector<Tick> ticks(6, below_surface(0.001));
  EXPECT_TRUE(std::isnan(max_contact_error_m(run_of({ticks.begin(), ticks.begin() + 5}, kTick_s))));
  EXPECT_EQ(max_contact_error_m(run_of(ticks, kTick_s)), 0.001);
  for (const double outside_m : {0.0, 0.01, kUnknown}) {
    std::vector<Tick> all = ticks;
    all.push_back(below_surface(-0.5, outside_m));
    all.insert(all.end(), 5, below_surface(-0.5));
    EXPECT_EQ(max_contact_error_m(run_of(all, kTick_s)), 0.001) << outside_m;
    all.push_back(below_surface(-0.002));
    EXPECT_EQ(max_contact_error_m(run_of(all, kTick_s)), 0.002) << outside_m;
  }
  Trace late = run_of(std::vector<Tick>(9, below_surface(0.001)), kTick_s);
  for (const std::size_t i : {0u, 1u}) late.frame_index[i] = -1, late.contact[i].height_m = 0.5;
  late.contact[6].height_m = 0.5;
  EXPECT_EQ(max_contact_error_m(late), 0.001);
  late.contact[7].height_m = 0.002;
  EXPECT_EQ(max_contact_error_m(late), 0.002);
}

TEST(SettledContact, ErrorsOfCameraAndRendererAreToldApart) {
  Trace trace = settled({0.005, 0.001, kUnknown, 0.5, 0.003});
  const std::vector<double> measured_m = {0.002, -0.002, 0.3, kUnknown, 0};
  for (std::size_t i = 0; i < measured_m.size(); ++i) trace.contact[5 + i].measured_height_m = measured_m[i];
  const std::vector<const char*> parts = {"rms_renderer_error", "rms_camera_error", "mean_camera_error"};
  trace.measured_distance_m.assign(trace.length(), 0.004);
  expect_values(trace, {{parts[0], std::sqrt((4 + 4 + 0) / 3.0) * 1e-3}, {parts[1], 3e-3}, {parts[2], 3e-3}},
                1e-17);
  Trace without = settled({0.001, 0.002});
  without.measured_distance_m.assign(without.length(), 0.004);
  expect_no_values(without, parts);
}

TEST(SettledContact, TicksWithoutATruthAreLeftOutAndCounted) {
  expect_values(settled({kUnknown, 0.002, kUnknown, -0.001}), {{"max_contact_error", 0.002},
                                                               {"rms_contact_error", std::sqrt(2.5e-6)},
                                                               {"contact_known_fraction", 0.5}});
  const Trace dark = settled({kUnknown, kUnknown});
  expect_no_values(dark, {"max_contact_error", "max_sink", "max_float", "rms_contact_error"});
  EXPECT_EQ(contact_known_fraction(dark), 0);
}

TEST(SettledContact, ForceFractionUsesSettledTicksOnly) {
  Trace trace = settled({0, 0, 0, 0});
  trace.force_N[6].setZero();
  EXPECT_EQ(value("contact_force_fraction", trace), 0.75);
  expect_no_values(run_of({below_surface(0), below_surface(0)}),
                   {"contact_force_fraction", "contact_known_fraction"});
}

// --- the direction of the force ---

Trace with_forces(const std::vector<Vec3>& force_N) {
  std::vector<Tick> ticks;
  for (const Vec3& each_N : force_N) ticks.push_back({.force_N = each_N, .normal = Vec3::UnitY()});
  return run_of(ticks);
}

TEST(LateralForce, IsTheRatioOfTheTwoPartsAndTheAngleBetween) {
  expect_values(with_forces({{3, 10, 4}, {0, 7, 0}, {-1, 1, 0}}),  // 0.5, 0 and 1
                {{"mean_lateral_force", 0.5}, {"mean_force_angle", (std::atan(0.5) + std::atan(1.0)) / 3}});
  // 100 ticks with the ratios 0.01 to 1, in another order: 95 of them lie below 0.96.
  std::vector<Vec3> force_N;
  for (int i = 0; i < 100; ++i) force_N.emplace_back(0.01 * (1 + (37 * i) % 100), 1, 0);
  expect_values(with_forces(force_N), {{"lateral_force_95", 0.96}, {"mean_lateral_force", 0.505}}, 1e-14);
  // A force into the surface has no ratio, but an angle above a right one.
  expect_values(with_forces({{1, -2, 0}, {0, -1, 0}, {1, 0, 0}}),
                {{"mean_lateral_force", kUnknown},
                 {"lateral_force_95", kUnknown},
                 {"mean_force_angle", (M_PI - std::atan(0.5) + M_PI + M_PI / 2) / 3}});
}

// Guidance may pull in any direction, so its part of the force is not a contact force.
TEST(LateralForce, UsesTicksInContactWithAForceAndAKnownNormal) {
  const Vec3 up = Vec3::UnitY(), none = Vec3::Zero();
  const Trace trace =
      run_of({{.force_N = {1, 2, 0}, .guidance_N = none, .normal = up},
              {.force_N = {9, 1, 0}, .state = ContactState::free, .guidance_N = none, .normal = up},
              {.guidance_N = none, .normal = up},
              {.force_N = {9, 1, 0}, .guidance_N = none, .normal = kUnknownVector},
              {.force_N = {1, 2, 0}, .state = ContactState::entrenched, .guidance_N = none, .normal = up},
              {.force_N = {5, 2, 0}, .guidance_N = Vec3(4, 0, 0), .normal = up},
              {.force_N = {3, 0, 0}, .guidance_N = Vec3(3, 0, 0), .normal = up}});
  EXPECT_EQ(mean_lateral_force(trace), 0.5);
  EXPECT_EQ(lateral_force_95(trace), 0.5);
  EXPECT_NEAR(mean_force_angle_rad(trace), std::atan2(1, 2), 1e-15);
}

}  // namespace
}  // namespace remote_touch::contact_measures_test

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
    EXPECT_NEAR(example_traces::value(name, trace), expected, 1e-15) << name;
  Tick alone;  // no point is near
  alone.gap_m = none;
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

}  // namespace
}  // namespace remote_touch::tool_measures_test

namespace remote_touch::slave_measures_test {
namespace {

using example_traces::kUnknown;

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
  for (const auto& [name, expected] : {std::pair("max_slave_force", 7.0),
                                       {"slave_touched", 1},
                                       {"slave_contact_fraction", 0.4},
                                       {"min_slave_clearance", -0.002},
                                       {"rms_slave_lag", std::sqrt(9e-6 / 5)},
                                       {"first_slave_contact_time", 0.003},
                                       {"slave_anticipation", 0.002},
                                       {"command_packet_rate", 1000},
                                       {"force_packet_rate", 500},
                                       {"max_device_force", 3},
                                       {"frame_packet_rate", 250}})
    EXPECT_NEAR(example_traces::value(name, trace), expected, 1e-12 * std::abs(expected) + 1e-15) << name;
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
  // The state of a slave is NaN before its first command.
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

}  // namespace
}  // namespace remote_touch::slave_measures_test
