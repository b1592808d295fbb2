// The runs that pop through: scenes whose answer is known, through the whole loop.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "analysis/trace/contact_measures.h"
#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"

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

}  // namespace
}  // namespace remote_touch::pop_through_test
