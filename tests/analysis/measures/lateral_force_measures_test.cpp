// The direction of a force against the true normal: traces whose forces have a known part along the surface.
#include "analysis/measures/lateral_force_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "analysis/measures/measures.h"
#include "analysis/trace/trace.h"
#include "core/geometry/rotation.h"

namespace remote_touch::lateral_force_measures_test {
namespace {

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

// Neither the axes of the world nor the magnitude of a force matter.
TEST(LateralForce, IsTheSameInATurnedWorld) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    const double x = normal(random), y = normal(random), z = normal(random);
    return Vec3(x, y, z);
  };
  std::vector<Tick> level, turned;
  double sum = 0;
  constexpr int kTicks = 200;
  for (int i = 0; i < kTicks; ++i) {
    const double ratio = std::abs(normal(random)), newtons = 1 + 10 * std::abs(normal(random));
    const Eigen::Quaterniond turn = rotation(direction());
    const Vec3 force_N = newtons * Vec3(0.6 * ratio, 1, -0.8 * ratio);
    level.push_back({force_N});
    turned.push_back({turn * force_N, turn * Vec3::UnitY()});
    sum += ratio;
  }
  for (const auto& ticks : {level, turned})
    EXPECT_NEAR(mean_lateral_force(trace_of(ticks)), sum / kTicks, 1e-13);
  EXPECT_NEAR(lateral_force_95(trace_of(turned)), lateral_force_95(trace_of(level)), 1e-12);
  EXPECT_NEAR(mean_force_angle_rad(trace_of(turned)), mean_force_angle_rad(trace_of(level)), 1e-12);
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
