#include "analysis/measures/passivity_measures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/trace/trace.h"
#include "core/geometry/rotation.h"

namespace remote_touch::passivity_measures_test {
namespace {

struct Tick {
  double force_N = 0, hip_position_m = 0;
  int frame = 0;
};

Trace trace_of(const std::vector<Tick>& ticks) {
  Trace trace;
  for (const Tick& tick : ticks) {
    RenderOutput out;
    out.force_N = {0, tick.force_N, 0};
    out.frame_index = tick.frame;
    trace.append(0.001 * static_cast<double>(trace.length()), {Vec3(0, tick.hip_position_m, 0)}, out, {});
  }
  return trace;
}

TEST(PassivityMeasures, ASpringGivesBackWhatItTookAndNoMore) {
  constexpr int kStiffer = 528;  // first tick with 1.5 times the stiffness, on the way out
  std::vector<Tick> ticks;
  double before = 0, after = 0;  // sums of squared steps
  for (int i = 0; i <= 1000; ++i) {
    const double depth = 0.01 * std::sin(3.14159265358979 * i / 1000);
    if (i > 0) (i <= kStiffer ? before : after) += std::pow(depth + ticks.back().hip_position_m, 2);
    ticks.push_back({600 * depth, -depth, i / 33});
  }
  // Sampling injects energy: each force is held while the hand moves on, k / 2 (sum of steps^2) in all.
  EXPECT_NEAR(max_energy_injected_J(trace_of(ticks)), 300 * (before + after), 1e-14);
  for (int i = kStiffer; i <= 1000; ++i) ticks[static_cast<std::size_t>(i)].force_N *= 1.5;
  const double more = 150 * std::pow(ticks[kStiffer].hip_position_m, 2);  // half of the added 300 N/m
  EXPECT_NEAR(max_energy_injected_J(trace_of(ticks)), more + 300 * before + 450 * after, 1e-14);
}

// A spring that is pressed and released gives back what it took. One that gets stiffer in between gives more.
TEST(PassivityMeasures, EnergyIsForceTimesDisplacementOfTheHand) {
  EXPECT_NEAR(energy_injected_J(trace_of({{2, 0}, {2, -0.01}, {2, 0}})), 0, 1e-17);
  EXPECT_NEAR(energy_injected_J(trace_of({{2, 0}, {5, -0.01}, {100, 0}})), 0.01 * (5 - 2), 1e-17);
  EXPECT_LT(energy_injected_J(trace_of({{2, 0}, {2, -0.01}})), 0);
  EXPECT_EQ(energy_injected_J(trace_of({{2, 0}})), 0);
  EXPECT_EQ(energy_injected_J(Trace()), 0);
}

// A torque of 0.5 N m turns the hand by 0.2 rad about an axis at 60 degrees to it, and 2 N push it by 1 cm.
TEST(PassivityMeasures, WorkIncludesTheTorque) {
  const Vec3 axis_W(0.5, std::sqrt(0.75), 0);
  Trace trace;
  for (int i = 0; i < 2; ++i) {
    RenderOutput out;
    out.force_N = {0, 2, 0};
    out.tool.emplace().torque_Nm = {0.5, 0, 0};
    DeviceState device{Vec3(0, 0.01 * i, 0)};
    device.orientation_W = rotation(0.2 * i * axis_W) * rotation({0.3, -0.1, 0.7});
    trace.append(0.001 * i, device, out, {});
  }
  EXPECT_NEAR(energy_injected_J(trace), 2 * 0.01 + 0.5 * 0.2 * 0.5, 1e-15);
}

// Work is done by the force that the device exerts, not by the renderer's command: here a motor is missing.
TEST(PassivityMeasures, WorkIsThatOfTheMotors) {
  Trace trace;
  for (int i = 0; i < 2; ++i) {
    RenderOutput out;
    out.force_N = {3, 2, 0};
    HandState hand;
    hand.force_N = {0, 2, 0};
    trace.append(0.001 * i, {Vec3(0.01 * i, 0.01 * i, 0)}, out, {}, hand);
  }
  EXPECT_NEAR(energy_injected_J(trace), 0.02, 1e-17);
  EXPECT_NEAR(max_energy_injected_J(trace), 0.02, 1e-17);
}

TEST(PassivityMeasures, MaxEnergyIsTheMaximumOverTime) {
  // 2 J to the hand, then 5 J from it.
  const Trace trace = trace_of({{1, 0}, {1, 2}, {1, -3}});
  EXPECT_EQ(max_energy_injected_J(trace), 2);
  EXPECT_EQ(max_energy_injected_J(trace_of({{1, 0}, {1, -1}, {1, -3}})), 0);
  EXPECT_EQ(max_energy_injected_J(trace_of({})), 0);
}

TEST(PassivityMeasures, EnergyPerUpdateIsOfWholePiecesWithForce) {
  // Frame updates are at the ticks 1, 3, 5 and 7. The work between them is 3, -2 and, without force, 0 J.
  const Trace trace = trace_of({{9, 0, 0},
                                {1, 0, 1},
                                {1, 1, 1},
                                {-1, 3, 2},
                                {-1, 4, 2},
                                {0, 5, 3},
                                {0, 9, 3},
                                {7, 12, 4},
                                {7, 20, 4}});
  EXPECT_EQ(mean_energy_per_update_J(trace), 0.5);
  EXPECT_EQ(max_energy_per_update_J(trace), 3);
  EXPECT_TRUE(std::isnan(mean_energy_per_update_J(trace_of({{9, 0, 0}, {9, 1, 1}}))));
  EXPECT_TRUE(std::isnan(max_energy_per_update_J(trace_of({}))));
}

// Frame updates are at the ticks 1, 3 and 5. The renderer always commands a force, but the device exerts one
// only between the second update and the third.
TEST(PassivityMeasures, APieceWithACommandThatNoMotorExertsDoesNotCount) {
  Trace trace;
  for (int i = 0; i < 7; ++i) {
    RenderOutput out;
    out.force_N = {3, 0, 0};
    out.frame_index = (i + 1) / 2;
    HandState hand;
    hand.force_N = {0, i == 3 || i == 4 ? 2.0 : 0.0, 0};
    trace.append(0.001 * i, {Vec3(0.01 * i, 0.01 * i, 0)}, out, {}, hand);
  }
  EXPECT_NEAR(mean_energy_per_update_J(trace), 2 * 2 * 0.01, 1e-17);
}

// Frame updates are at the ticks 1, 3 and 5. The hand turns by 0.1 rad in each tick. The tool exerts a torque
// of 0.5 N m only between the first two updates, and never a force.
TEST(PassivityMeasures, APieceWithATorqueAloneHasItsEnergy) {
  Trace trace;
  for (int i = 0; i < 7; ++i) {
    RenderOutput out;
    out.frame_index = (i + 1) / 2;
    out.tool.emplace().torque_Nm = {0, i == 1 || i == 2 ? 0.5 : 0, 0};
    DeviceState device{Vec3(0.01 * i, 0, 0)};
    device.orientation_W = rotation({0, 0.1 * i, 0});
    trace.append(0.001 * i, device, out, {});
  }
  EXPECT_NEAR(mean_energy_per_update_J(trace), 2 * 0.5 * 0.1, 1e-15);
  EXPECT_NEAR(max_energy_per_update_J(trace), 2 * 0.5 * 0.1, 1e-15);
}

}  // namespace
}  // namespace remote_touch::passivity_measures_test
