// The measures of lateral force through the whole loop: which runs have them, and scenes whose result is
// known.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep.h"

namespace remote_touch::lateral_force_test {
namespace {

Trace judged(const std::string& experiment, const std::vector<std::string>& settings) {
  SimulationOptions options;
  options.find_true_contact = true;
  return simulate(Experiment::load(experiment, settings), options);
}

bool is_measured(const Trace& trace) {
  for (const Measure& measure : built_in_measures())
    if (measure.runs == MeasuredRuns::true_normal) return applies(measure, trace);
  return false;
}

// The hand presses 5 mm into a level or leaning plane without noise. The proxy touches four points alike in
// the middle of the grid.
const std::string kPress =
    R"(trajectory={"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, -0.005, 0, 0.2]]})";

TEST(LateralForce, IsNoneOnALevelPlaneWithoutNoise) {
  const Trace trace = judged("fig4.11", {kPress, "duration_s=0.4"});
  ASSERT_TRUE(is_measured(trace));
  EXPECT_LT(lateral_force_95(trace), 1e-9);
  EXPECT_LT(mean_force_angle_rad(trace), 1e-9);
}

// The god-object on the triangles of the cloud slides without friction to where the force is along the
// normal.
TEST(LateralForce, IsNoneOnALeaningPlane) {
  for (const int tilt_deg : {-30, 10, 40}) {
    const Trace trace = judged("rival-god-object",
                               {R"(scenario={"name": "moving-shape"})",
                                "scenario.tilt_deg=" + std::to_string(tilt_deg), kPress, "duration_s=0.4"});
    ASSERT_TRUE(is_measured(trace)) << tilt_deg;
    EXPECT_LT(lateral_force_95(trace), 1e-6) << tilt_deg;
  }
}

// Surfels have friction: while the hand is dragged along the plane, the force along it is the coefficient
// times the force along the normal.
TEST(LateralForce, IsThatOfFriction) {
  for (const double friction : {0.0, 0.1, 0.3}) {
    const Trace trace = judged(
        "fig4.11",
        {R"(renderer={"name": "surfels"})", "renderer.friction=" + std::to_string(friction),
         R"(trajectory={"name": "waypoints", "waypoints": [[-0.02, 0.02, 0, 0], [-0.02, -0.005, 0, 0.2], [0.03, -0.005, 0, 0.05]]})"});
    ASSERT_TRUE(is_measured(trace)) << friction;
    EXPECT_NEAR(lateral_force_95(trace), friction, 1e-6) << friction;
  }
}

TEST(LateralForce, IsNotKnownOfAToolOnMoreThanOnePlane) {
  EXPECT_FALSE(is_measured(judged("tool-slot", {"duration_s=0.1"})));
  const Trace trace = judged("tool-lift", {});
  ASSERT_TRUE(is_measured(trace));
  EXPECT_LT(lateral_force_95(trace), 1e-6) << "a plate on a plane without noise";
}

TEST(LateralForce, IsComputedWhereAMeasureAsksAndChangesNothingElse) {
  const Experiment experiment = Experiment::load("fig4.12", {"duration_s=0.6"});
  const Trace plain = simulate(experiment);
  EXPECT_FALSE(plain.has_true_normal());
  const Trace trace = judged("fig4.12", {"duration_s=0.6"});
  EXPECT_EQ(trace.true_normal.size(), trace.length());
  EXPECT_EQ(std::get<std::vector<std::uint64_t>>(plain.columns().back().values),
            std::get<std::vector<std::uint64_t>>(trace.columns().back().values));
  const auto needs = [](const std::string& measure) {
    return Sweep::from_json(R"({"experiment": "fig4.12", "axes": [{"parameter": "seed", "values": [1]}],
                                "measures": [")" +
                                measure + R"("]})",
                            "lifts")
        .needs_true_contact();
  };
  EXPECT_TRUE(needs("mean_lateral_force"));
  EXPECT_FALSE(needs("max_force"));
}

}  // namespace
}  // namespace remote_touch::lateral_force_test
