// The runs that pop through: scenes whose answer is known, through the whole loop.
#include <gtest/gtest.h>
#include <cmath>
#include <string>
#include <vector>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep.h"

namespace remote_touch::pop_through_test {
namespace {

Trace run(const std::string& json) {
  SimulationOptions options;
  options.find_true_contact = true;
  return simulate(Experiment::from_json(json, "test"), options);
}

// The hand presses 5 mm into a flat cloud. The proxy of surfels lies in the plane, or behind it by rounding
// or by noise in some runs.
Trace pressed_on_surfels(double start_x_m, double noise_sigma_m, int seed) {
  return run(R"({"scenario": {"name": "flat-grid", "noise_sigma_m": )" + std::to_string(noise_sigma_m) +
             R"(}, "renderer": {"name": "surfels"}, "trajectory": {"name": "press", "press_at_s": 0.05,
                 "depth_m": 0.005, "start_m": [)" +
             std::to_string(start_x_m) + R"(, 0.02, 0.0001]}, "duration_s": 0.2, "seed": )" +
             std::to_string(seed) + "}");
}

TEST(PopThrough, AProxyThatRestsOnTheSurfaceDidNotPopThrough) {
  int behind = 0;
  for (int seed = 1; seed <= 8; ++seed) {
    const Trace trace = pressed_on_surfels(0.0003, 0.001, seed);
    EXPECT_FALSE(trace.force_N.back().isZero(0)) << "it is held";
    EXPECT_EQ(popped_through(trace), 0) << seed;
    EXPECT_EQ(wrong_side_fraction(trace), 0) << seed;
    behind += end_distance_m(trace) < 0 ? 1 : 0;
  }
  EXPECT_GT(behind, 0) << "else nothing was tested";
  for (const double x_m : {0.0003, 0.004}) EXPECT_EQ(popped_through(pressed_on_surfels(x_m, 0, 1)), 0);
}

// A surface that rises with 20 m/s^2 is lost.
TEST(PopThrough, AProxyThatLosesTheSurfacePoppedThrough) {
  const std::string renderer = R"(renderer={"name": "surfels"})";
  const Trace lost = simulate(Experiment::load(
      "fig4.12", {renderer, "scenario.acceleration_m_per_s2=20", "scenario.noise_sigma_m=0"}));
  EXPECT_LT(end_distance_m(lost), -0.0025);
  EXPECT_EQ(popped_through(lost), 1);
}

// The hand presses 5 mm into a plate of 10 cm, is drawn off its edge, and stays below its plane beside it.
TEST(PopThrough, DoesNotCountAHandThatSlidesOffTheEdge) {
  for (const char* scenario :
       {R"({"name": "plates", "plates": [[0, 0, 0, 0.1, 0.1, 0, 0, 0, 0]]})",
        R"({"name": "panel", "normal": [0, 1, 0], "width_m": 0.1, "height_m": 0.1, "spacing_m": 0.0015})",
        R"({"name": "flat-grid", "columns": 67, "rows": 67})"}) {
    const Trace trace =
        run(std::string(R"({"scenario": )") + scenario +
            R"(, "renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints", "waypoints":
      [[0, 0.02, 0, 0], [0, -0.005, 0, 0.1], [0.08, -0.005, 0, 0.1], [0.18, -0.005, 0, 0.5]]},
      "duration_s": 1.5})");
    EXPECT_GT(max_force_N(trace), 0.5) << "it did press";
    EXPECT_LT(trace.proxy_position_m.back().y(), -0.004) << "it is beside the plate";
    EXPECT_TRUE(std::isnan(popped_through(trace))) << scenario;
    EXPECT_LE(max_penetration_m(trace), 0.005 + 1e-12) << "under the edge it is as deep as the hand";
    EXPECT_LT(max_sink_m(trace), 0.0101) << "r_c more, and not as far as the hand is beside the plate";
  }
}

// The tool moves from the back of the sheet to its front and back again.
TEST(PopThrough, AToolThatReturnsBehindASheetDidNotPopThrough) {
  const Trace trace = simulate(Experiment::load("tool-sheet"));
  EXPECT_LT(end_distance_m(trace), -0.02);
  EXPECT_EQ(popped_through(trace), 0);
}

TEST(PopThrough, IsUnknownForSinglePoints) {
  const Trace trace = run(R"({"scenario": {"name": "points", "points": [[0, 0, 0]]},
    "renderer": {"name": "proxy"},
    "trajectory": {"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, -0.01, 0, 0.1]]}, "duration_s": 0.4})");
  for (const auto measure : {popped_through, max_penetration_m, min_slave_distance_m, wrong_side_fraction,
                             rms_surface_error_m, end_distance_m, mean_distance_m, mean_height_m})
    EXPECT_TRUE(std::isnan(measure(trace)));
}

// The predecessor [1]: fixed small steps and no velocity estimate, as settings of the same renderer.

double popped_at(double velocity, const std::vector<std::string>& more) {
  std::vector<std::string> settings = {"scenario.noise_sigma_m=0",
                                       "scenario.acceleration_m_per_s2=0",
                                       "scenario.start_velocity_m_per_s=" + std::to_string(velocity),
                                       "scenario.start_depth_m=" + std::to_string(velocity / 2),
                                       "scenario.rise_s=1",
                                       "scenario.acceleration_s=0",
                                       "duration_s=1"};
  settings.insert(settings.end(), more.begin(), more.end());
  return popped_through(simulate(Experiment::load("fig4.12", settings)));
}

// An update of more than r_1 puts the proxy on the wrong side if there is no estimate: r_1 f_c = 0.1497 m/s.
TEST(Predecessor, PopsThroughAboveItsVelocityBound) {
  const std::vector<std::string> predecessor = {"renderer.step_rule=fixed",
                                                "renderer.velocity_estimate=false"};
  EXPECT_EQ(popped_at(0.13, predecessor), 0);
  EXPECT_EQ(popped_at(0.16, predecessor), 1);
  EXPECT_EQ(popped_at(0.16, {}), 0) << "the estimate of (4.13) removes the bound on velocity";
}

// Noise often makes a tick end a step away from contact. The printed gate of the force then drops out; the
// gate in use does not.
TEST(ForceGate, TheLatestContactGivesAForceInEveryTick) {
  const auto silent = [](const std::string& gate) {
    const Trace trace = simulate(Experiment::load(
        "fig4.11", {"scenario.noise_sigma_m=0.003", "renderer.force_gate=" + gate, "duration_s=3"}));
    return no_force_fraction(trace, 0.005);
  };
  EXPECT_EQ(silent("latest-contact"), 0);
  EXPECT_GT(silent("contact-now"), 0.005);
}

// The rivals and the chapter 4 proxy under the same lifts (4.3.2), from rest and without noise: what each
// paper's method loses. The HIP is 1 cm deep, and a proxy that is lost ends there.

constexpr double kPressed_m = 0.01;

// Greatest depth of the proxy behind the surface. popped_through() is not used, because a point proxy lies on
// the points, and so behind the true surface by their noise.
double lost_m(const std::string& renderer, double acceleration_m_per_s2, double noise_sigma_m = 0) {
  return max_penetration_m(simulate(Experiment::load(
      "fig4.12",
      {"renderer=" + renderer, "scenario.acceleration_m_per_s2=" + std::to_string(acceleration_m_per_s2),
       "scenario.noise_sigma_m=" + std::to_string(noise_sigma_m), "scenario.start_velocity_m_per_s=0",
       "scenario.start_depth_m=0.0005", "trajectory.start_m=[0, 0.02, 0]", "trajectory.press_at_s=0.2",
       "trajectory.depth_m=0.01"})));
}

const std::string kImplicit[] = {R"({"name": "implicit-surface"})",
                                 R"({"name": "implicit-surface", "weight": "wendland"})",
                                 R"({"name": "implicit-surface", "surface": "surfels"})"};

TEST(RivalsUnderALift, TheProxyOfChapter4IsNotLost) {
  for (const double a : {0.0, 0.2, 1.0, 4.0}) EXPECT_EQ(lost_m(R"({"name": "proxy"})", a), 0) << a;
}

TEST(RivalsUnderALift, DirectRenderingIsLostWithoutAnyLift) {
  EXPECT_GT(lost_m(R"({"name": "penalty"})", 0), 0.99 * kPressed_m);
}

// The surface is lost at the frame that jumps by more than half of its thickness, 8.6 mm, or by more than R.
// The limit was measured between 0.5 and 1 m/s^2.
TEST(RivalsUnderALift, AnImplicitSurfaceHoldsASlowLiftAndLosesAFastOne) {
  for (const std::string& renderer : kImplicit) {
    for (const double a : {0.0, 0.2}) EXPECT_LT(lost_m(renderer, a), 1e-9) << renderer << " at " << a;
    for (const double a : {2.0, 4.0})
      EXPECT_GT(lost_m(renderer, a), 0.99 * kPressed_m) << renderer << " at " << a;
  }
}

// Any frame that passes the god-object leaves it behind: by a lift, or by noise that is drawn anew.
TEST(RivalsUnderALift, AGodObjectHoldsOnlyASurfaceAtRest) {
  const std::string renderer = R"({"name": "god-object"})";
  EXPECT_LT(lost_m(renderer, 0), 1e-9);
  EXPECT_GT(lost_m(renderer, 0.05), 0.99 * kPressed_m);
  EXPECT_GT(lost_m(renderer, 0, 0.001), 0.9 * kPressed_m);
}

// The measures of lateral force through the whole loop: which runs have them, and scenes whose result is
// known.

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
}  // namespace remote_touch::pop_through_test
