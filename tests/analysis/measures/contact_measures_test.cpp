#include "analysis/measures/contact_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "analysis/trace/trace.h"
#include "tests/analysis/measures/measure_named.h"

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
