// Runs with a simulated device that rounds, delays, rubs and damps.
#include <gtest/gtest.h>

#include <cmath>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch::device_run_test {
namespace {

Trace run(std::vector<std::string> overrides) {
  overrides.push_back("duration_s=1.2");
  return simulate(Experiment::load("fig4.11", overrides));
}

constexpr const char* kOperator = R"(operator={"stiffness_N_per_m": 300, "damping_Ns_per_m": 15})";

TEST(DeviceRun, RecordsTheTruePoseOnlyIfTheDeviceRoundsIt) {
  EXPECT_FALSE(run({"device={}"}).has_rounded_hand());
  const Trace trace = run({R"(device={"position_resolution_m": 0.001})"});
  ASSERT_TRUE(trace.has_rounded_hand());
  double largest = 0;
  for (std::size_t i = 0; i < trace.length(); ++i) {
    const Vec3 steps = trace.hip_position_m[i] / 0.001;
    EXPECT_NEAR((steps - Vec3(steps.array().round())).norm(), 0, 1e-9) << i;
    largest = std::max(largest, (trace.hip_position_m[i] - trace.hand_position_m[i]).cwiseAbs().maxCoeff());
    EXPECT_EQ(trace.hand_position_m[i], trace.intended_position_m[i]) << i;
  }
  EXPECT_GT(largest, 1e-4);
  EXPECT_LE(largest, 0.0005 + 1e-12);
}

TEST(DeviceRun, ExertsTheForceOfEarlierTicks) {
  const Trace trace = run({R"(device={"delay_ticks": 5})"});
  std::size_t felt = 0;
  for (std::size_t i = 5; i < trace.length(); ++i) {
    EXPECT_EQ(trace.device_force_N[i], trace.force_N[i - 5]) << i;
    felt += trace.device_force_N[i].norm() > 0.1;
  }
  EXPECT_GT(felt, 50u);
}

// A spring that pulls less than friction does not move the hand from its first position.
TEST(DeviceRun, FrictionHoldsTheHand) {
  // The path jumps, and a damper would pull with the speed of the jump.
  const Trace held = run({kOperator, "operator.damping_Ns_per_m=0", R"(device={"friction_N": 100})"});
  EXPECT_EQ(held.hip_position_m.back(), held.hip_position_m.front());
  EXPECT_GT((held.intended_position_m.back() - held.hip_position_m.back()).norm(), 0.01);
  const Trace rubbed = run({kOperator, R"(device={"friction_N": 0.5})"});
  const Trace smooth = run({kOperator, "device={}"});
  EXPECT_NE(rubbed.hip_position_m.back(), smooth.hip_position_m.back());
  EXPECT_NEAR((rubbed.hip_position_m.back() - smooth.hip_position_m.back()).norm(), 0,
              2 * std::sqrt(3) * 0.5 / 300);
}

TEST(DeviceRun, TheDamperChangesTheForceInContactOnly) {
  const Trace trace = run({kOperator, R"(device={"contact_damping_Ns_per_m": 3, "velocity_ticks": 4})"});
  std::size_t damped = 0;
  for (std::size_t i = 4; i < trace.length(); ++i) {
    const Vec3 added = trace.device_force_N[i] - trace.force_N[i];
    if (trace.force_N[i].isZero(0)) {
      EXPECT_TRUE(added.isZero(0)) << i;
      continue;
    }
    const Vec3 velocity = (trace.hip_position_m[i] - trace.hip_position_m[i - 4]) / 0.004;
    EXPECT_NEAR((added + 3 * velocity).norm(), 0, 1e-9) << i;
    damped += added.norm() > 1e-6;
  }
  EXPECT_GT(damped, 50u);
}

}  // namespace
}  // namespace remote_touch::device_run_test
