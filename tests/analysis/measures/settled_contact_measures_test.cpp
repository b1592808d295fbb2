#include "analysis/measures/settled_contact_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "analysis/measures/measures.h"
#include "analysis/trace/trace.h"

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
