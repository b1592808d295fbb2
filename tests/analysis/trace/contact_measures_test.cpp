#include "analysis/trace/contact_measures.h"

#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/trace/force_measures.h"
#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "core/points/vector.h"
#include "tests/analysis/trace/measure_named.h"

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

namespace remote_touch::contact_measures_test {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Tick {
  double signed_distance_m = 0.005, nearest_distance_m = 0.005;
  Vec3 force_N = Vec3::Zero(), hip_position_m = Vec3::Zero();
  int frame = 0;
  ContactState state = ContactState::contact;
};

// One tick every 10 ms.
Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.force_N = tick.force_N;
    out.state = tick.state;
    out.frame_index = tick.frame;
    out.nearest_distance_m = tick.nearest_distance_m;
    trace.append(0.01 * static_cast<double>(trace.length()), {tick.hip_position_m}, out,
                 {tick.signed_distance_m, tick.signed_distance_m, 0});
  }
  return trace;
}

Tick pushed(double force_y_N, int frame) {
  return {0.005, 0.005, {0, force_y_N, 0}, Vec3::Zero(), frame};
}

TEST(ContactMeasures, HeightIsThatOfTheRenderedSurfaceOverTheTrueOne) {
  Tick above{0.0058, 0.005}, below{0.0042, 0.0048}, free{0.5, 0.1}, dark{kUnknown, 0.005},
      alone{0.005, std::numeric_limits<double>::infinity()};
  free.state = ContactState::free;
  const Trace trace = trace_of({above, free, above, dark, below, alone, above});
  EXPECT_NEAR(mean_height_m(trace), (3 * 0.0008 - 0.0006) / 4, 1e-15);
  // Three of four heights are 0.8 mm and one is -0.6 mm: 1.4 mm sqrt(3/4 1/4).
  EXPECT_NEAR(height_sd_m(trace), 0.0014 * std::sqrt(3.0) / 4, 1e-15);
  EXPECT_TRUE(std::isnan(mean_height_m(trace_of({free, dark, alone}))));
  EXPECT_TRUE(std::isnan(height_sd_m(trace_of({free, dark, alone}))));
  EXPECT_EQ(height_sd_m(trace_of({above})), 0);
}

TEST(ContactMeasures, DistanceNeedsAForceButNoPoints) {
  Tick near{0.004, 0.002}, far{0.008, std::numeric_limits<double>::infinity()}, silent{0.5, 0.1},
      dark{kUnknown};
  near.force_N = far.force_N = dark.force_N = {0, 1, 0};
  far.state = ContactState::free;
  const Trace trace = trace_of({near, silent, far, dark, near});
  EXPECT_NEAR(mean_distance_m(trace), 0.016 / 3, 1e-15);
  // Two of three distances are 4 mm below the third: 4 mm sqrt(2/3 1/3).
  EXPECT_NEAR(distance_sd_m(trace), 0.004 * std::sqrt(2.0) / 3, 1e-15);
  EXPECT_TRUE(std::isnan(mean_distance_m(trace_of({silent, dark}))));
  EXPECT_TRUE(std::isnan(distance_sd_m(trace_of({silent, dark}))));
}

// The mean of three times 0.1 differs from 0.1 in the last bit. No other scatter may remain.
TEST(ContactMeasures, EqualTicksHaveNoScatter) {
  Tick same{0.1, 0};
  same.force_N = {0, 1, 0};
  EXPECT_NEAR(height_sd_m(trace_of({same, same, same})), 0, 1e-15);
  EXPECT_NEAR(distance_sd_m(trace_of({same, same, same})), 0, 1e-15);
}

TEST(ContactMeasures, EndDistanceIsThatOfTheLastTick) {
  EXPECT_EQ(end_distance_m(trace_of({{-0.01, 0.005}, {0.004, 0.005}})), 0.004);
  EXPECT_EQ(end_distance_m(trace_of({{0.01, 0.005}, {-0.004, 0.005}})), -0.004);
  EXPECT_TRUE(std::isnan(end_distance_m(trace_of({{0.01, 0.005}, {kUnknown, 0.005}}))));
  EXPECT_TRUE(std::isnan(end_distance_m(Trace())));
}

TEST(ContactMeasures, CountTicksWithAForce) {
  const Trace trace = trace_of({pushed(0, 0), pushed(1e-12, 0), pushed(-2, 1), pushed(0, 1), pushed(0, 2)});
  EXPECT_EQ(force_fraction(trace), 0.4);
  EXPECT_EQ(last_force_time_s(trace), 0.02);
  EXPECT_EQ(force_fraction(trace_of({pushed(0, 0)})), 0);
  EXPECT_EQ(force_fraction(Trace()), 0);
  EXPECT_TRUE(std::isnan(last_force_time_s(trace_of({pushed(0, 0)}))));
}

TEST(ContactMeasures, AreInTheTable) {
  const Trace trace = trace_of({pushed(5, 0), pushed(6, 0), pushed(9, 1)});
  for (const auto& [name, of] : std::vector<std::pair<std::string, double (*)(const Trace&)>>{
           {"mean_height", mean_height_m},
           {"height_sd", height_sd_m},
           {"mean_distance", mean_distance_m},
           {"distance_sd", distance_sd_m},
           {"end_distance", end_distance_m},
           {"force_fraction", force_fraction},
           {"last_force_time", last_force_time_s}}) {
    EXPECT_EQ(measure_named(name).compute(trace), of(trace)) << name;
  }
}

}  // namespace
}  // namespace remote_touch::contact_measures_test

namespace remote_touch::settled_contact_measures_test {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

struct Tick {
  double height_m = 0, hip_distance_m = -0.01;
  bool has_force = true;
};

// One tick every 20 ms, so the settling lasts five intervals.
Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.force_N = {0, tick.has_force ? 1.0 : 0.0, 0};
    out.frame_index = 0;
    trace.append(0.02 * static_cast<double>(trace.length()), {}, out,
                 {0, 0, 0, Trace::TrueContact{tick.height_m, tick.hip_distance_m}});
  }
  return trace;
}

// A trace of these ticks after five ticks of settling, which no measure may use.
Trace settled(const std::vector<Tick>& ticks) {
  std::vector<Tick> all(5, Tick{-1, -0.01, false});
  all.insert(all.end(), ticks.begin(), ticks.end());
  return trace_of(all);
}

TEST(SettledContact, TheWorstTickCountsOnEitherSide) {
  const Trace trace = settled({{0.001}, {-0.004}, {0.003}, {0}});
  EXPECT_EQ(max_contact_error_m(trace), 0.004);
  EXPECT_EQ(max_sink_m(trace), 0.004);
  EXPECT_EQ(max_float_m(trace), 0.003);
  EXPECT_NEAR(rms_contact_error_m(trace), std::sqrt((1 + 16 + 9) / 4.0) * 1e-3, 1e-18);
  EXPECT_EQ(max_contact_error_m(settled({{0.004}, {-0.001}})), 0.004);
  EXPECT_EQ(max_sink_m(settled({{0.004}})), 0);
  EXPECT_EQ(max_float_m(settled({{-0.004}})), 0);
}

TEST(SettledContact, TheFirstTenthOfASecondIsNotJudged) {
  EXPECT_TRUE(std::isnan(max_contact_error_m(trace_of(std::vector<Tick>(5, {0.001})))));
  EXPECT_EQ(max_contact_error_m(trace_of(std::vector<Tick>(6, {0.001}))), 0.001);
}

TEST(SettledContact, SettlingStartsAgainAfterTheHandLeavesTheSurface) {
  std::vector<Tick> ticks(6, {0.001});
  for (const double outside : {0.0, 0.01, kUnknown}) {
    std::vector<Tick> all = ticks;
    all.push_back({-0.5, outside});
    all.insert(all.end(), 5, {-0.5});  // below it again, and not settled yet
    EXPECT_EQ(max_contact_error_m(trace_of(all)), 0.001) << outside;
    all.push_back({-0.002});
    EXPECT_EQ(max_contact_error_m(trace_of(all)), 0.002) << outside;
  }
}

TEST(SettledContact, ErrorsOfCameraAndRendererAreToldApart) {
  Trace trace = settled({{0.005}, {0.001}, {kUnknown}, {0.5}, {0.003}});
  const std::vector<double> measured_m = {0.002, -0.002, 0.3, kUnknown, 0};
  for (std::size_t i = 0; i < measured_m.size(); ++i) trace.contact[5 + i].measured_height_m = measured_m[i];
  EXPECT_NEAR(rms_renderer_error_m(trace), std::sqrt((4 + 4 + 0) / 3.0) * 1e-3, 1e-18);
  EXPECT_NEAR(rms_camera_error_m(trace), 3e-3, 1e-17);
  EXPECT_NEAR(mean_camera_error_m(trace), 3e-3, 1e-17);
  for (const auto measure : {rms_renderer_error_m, rms_camera_error_m, mean_camera_error_m})
    EXPECT_TRUE(std::isnan(measure(settled({{0.001}, {0.002}}))));
}

TEST(SettledContact, TicksWithoutATruthAreLeftOutAndCounted) {
  const Trace trace = settled({{kUnknown}, {0.002}, {kUnknown}, {-0.001}});
  EXPECT_EQ(max_contact_error_m(trace), 0.002);
  EXPECT_NEAR(rms_contact_error_m(trace), std::sqrt(2.5e-6), 1e-18);
  EXPECT_EQ(contact_known_fraction(trace), 0.5);
  const Trace dark = settled({{kUnknown}, {kUnknown}});
  for (const auto measure : {max_contact_error_m, max_sink_m, max_float_m, rms_contact_error_m})
    EXPECT_TRUE(std::isnan(measure(dark)));
  EXPECT_EQ(contact_known_fraction(dark), 0);
}

TEST(SettledContact, TicksBeforeTheFirstFrameAreNotSettled) {
  Trace trace = trace_of(std::vector<Tick>(9, {0.001}));
  for (std::size_t i = 0; i < 2; ++i) trace.frame_index[i] = -1, trace.contact[i].height_m = 0.5;
  EXPECT_EQ(max_contact_error_m(trace), 0.001)
      << "the settling begins with the third tick and ends in the eighth";
  trace.contact[6].height_m = 0.5;
  EXPECT_EQ(max_contact_error_m(trace), 0.001);
  trace.contact[7].height_m = 0.002;
  EXPECT_EQ(max_contact_error_m(trace), 0.002);
}

TEST(SettledContact, ForceFractionUsesSettledTicksOnly) {
  EXPECT_EQ(contact_force_fraction(settled({{0}, {0, -0.01, false}, {0}, {0}})), 0.75);
  EXPECT_TRUE(std::isnan(contact_force_fraction(trace_of({{0}, {0}}))));
  EXPECT_TRUE(std::isnan(contact_known_fraction(trace_of({{0}, {0}}))));
}

TEST(SettledContact, PartsOfTheErrorApplyToRunsWithAMeasuredSurface) {
  Trace with = settled({{0.003}});
  with.measured_distance_m.assign(with.length(), 0.004);
  int found = 0;
  for (const Measure& measure : built_in_measures()) {
    if (measure.runs != MeasuredRuns::measured_surface) continue;
    ++found;
    EXPECT_EQ(measure.better, Better::neither) << measure.name << " is no error from the truth";
    EXPECT_TRUE(applies(measure, with)) << measure.name;
    EXPECT_FALSE(applies(measure, settled({{0.003}}))) << measure.name;
    EXPECT_TRUE(needs_true_contact(measure)) << measure.name;
    EXPECT_TRUE(std::isnan(measure.compute(Trace()))) << measure.name;
  }
  EXPECT_EQ(found, 4);
}

TEST(SettledContact, IsNanIfTheContactWasNotComputed) {
  Trace trace;
  trace.append(0, {}, {}, {});
  int found = 0;
  for (const Measure& measure : built_in_measures()) {
    if (measure.runs != MeasuredRuns::contact) continue;
    ++found;
    EXPECT_FALSE(applies(measure, trace)) << measure.name;
    EXPECT_TRUE(applies(measure, settled({{0}}))) << measure.name;
    EXPECT_TRUE(std::isnan(value_of(measure, trace))) << measure.name;
    EXPECT_TRUE(std::isnan(measure.compute(trace))) << measure.name;
  }
  EXPECT_EQ(found, 10);
}

}  // namespace
}  // namespace remote_touch::settled_contact_measures_test

namespace remote_touch::lateral_force_measures_test {
namespace {

// The direction of a force against the true normal: traces whose forces have a known part along the surface.

const Vec3 kUnknown = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

struct Tick {
  Vec3 force_N, normal = Vec3::UnitY();
  ContactState state = ContactState::contact;
  std::optional<Vec3> guidance_N = {};
};

Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.force_N = tick.force_N, out.state = tick.state;
    if (tick.guidance_N) out.guidance.emplace().force_N = *tick.guidance_N;
    trace.append(0.001 * static_cast<double>(trace.length()), {}, out, {.normal = tick.normal});
  }
  return trace;
}

TEST(LateralForce, IsTheRatioOfTheTwoPartsAndTheAngleBetween) {
  const Trace trace = trace_of({{{3, 10, 4}}, {{0, 7, 0}}, {{-1, 1, 0}}});  // 0.5, 0 and 1
  EXPECT_NEAR(mean_lateral_force(trace), 0.5, 1e-15);
  EXPECT_NEAR(mean_force_angle_rad(trace), (std::atan(0.5) + std::atan(1.0)) / 3, 1e-15);
}

// 100 ticks with the ratios 0.01 to 1, in another order: 95 of them lie below 0.96.
TEST(LateralForce, The95thPercentileIsAbove95PercentOfTheTicks) {
  std::vector<Tick> ticks;
  for (int i = 0; i < 100; ++i) ticks.push_back({{0.01 * (1 + (37 * i) % 100), 1, 0}});
  EXPECT_NEAR(lateral_force_95(trace_of(ticks)), 0.96, 1e-15);
  EXPECT_NEAR(mean_lateral_force(trace_of(ticks)), 0.505, 1e-14);
}

TEST(LateralForce, UsesTicksInContactWithAForceAndAKnownNormal) {
  const Tick counts{{1, 2, 0}};
  const Trace trace = trace_of({counts,
                                {{9, 1, 0}, Vec3::UnitY(), ContactState::free},
                                {{0, 0, 0}},
                                {{9, 1, 0}, kUnknown},
                                {{1, 2, 0}, Vec3::UnitY(), ContactState::entrenched}});
  EXPECT_EQ(mean_lateral_force(trace), 0.5);
  EXPECT_EQ(lateral_force_95(trace), 0.5);
  EXPECT_EQ(mean_force_angle_rad(trace), std::atan2(1, 2));
}

// A force into the surface has no ratio, but an angle above a right one.
TEST(LateralForce, AForceIntoTheSurfaceHasAnAngleButNoRatio) {
  const Trace trace = trace_of({{{1, -2, 0}}, {{0, -1, 0}}, {{1, 0, 0}}});
  EXPECT_TRUE(std::isnan(mean_lateral_force(trace)));
  EXPECT_TRUE(std::isnan(lateral_force_95(trace)));
  EXPECT_NEAR(mean_force_angle_rad(trace), (M_PI - std::atan(0.5) + M_PI + M_PI / 2) / 3, 1e-15);
}

// Guidance may pull in any direction, so its part of the force is not a contact force.
TEST(LateralForce, IsThatOfContactWithoutGuidance) {
  const Trace trace = trace_of({{{5, 2, 0}, Vec3::UnitY(), ContactState::contact, Vec3(4, 0, 0)},
                                {{3, 0, 0}, Vec3::UnitY(), ContactState::contact, Vec3(3, 0, 0)}});
  EXPECT_EQ(mean_lateral_force(trace), 0.5);
  EXPECT_EQ(mean_force_angle_rad(trace), std::atan2(1, 2));
}

TEST(LateralForce, IsNanIfTheTrueNormalIsNotKnown) {
  Trace not_computed;
  not_computed.append(0, {}, {}, {});
  int found = 0;
  for (const Measure& measure : built_in_measures()) {
    if (measure.runs != MeasuredRuns::true_normal) continue;
    ++found;
    EXPECT_TRUE(needs_true_contact(measure)) << measure.name;
    EXPECT_EQ(measure.better, measure.name == "apparent_friction" ? Better::near_zero : Better::smaller);
    EXPECT_TRUE(applies(measure, trace_of({{{1, 2, 0}, kUnknown}, {{1, 2, 0}}}))) << measure.name;
    for (const Trace& trace : {not_computed, trace_of({{{1, 2, 0}, kUnknown}})}) {
      EXPECT_FALSE(applies(measure, trace)) << measure.name;
      EXPECT_TRUE(std::isnan(value_of(measure, trace))) << measure.name;
      EXPECT_TRUE(std::isnan(measure.compute(trace))) << measure.name;
    }
  }
  EXPECT_EQ(found, 4);
}

}  // namespace
}  // namespace remote_touch::lateral_force_measures_test
