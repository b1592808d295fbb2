// Replayed contacts through the whole loop: renderers whose error is known.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "analysis/trace/force_measures.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/test_files.h"

namespace remote_touch::contact_replay_loop_test {
namespace {

Trace replayed(const std::string& renderer, const std::vector<std::string>& settings = {}) {
  const std::string text = R"({"scenario": {"name": "moving-shape"}, "trajectory": {"name": "contact-replay"},
                               "renderer": {"name": ")" +
                           renderer + R"("}})";
  SimulationOptions options;
  options.find_true_contact = true;
  return simulate(Experiment::from_json(text, "test", settings), options);
}

// The mesh of a flat grid is the plane itself, and a god-object stays surface_offset_m = 1e-5 m above it.
TEST(ContactReplayLoop, AGodObjectOnAPlaneHasNoError) {
  const Trace trace = replayed("god-object", {"trajectory.onset_distance_m=1e-5"});
  ASSERT_TRUE(trace.has_replay());
  EXPECT_LT(rms_force_error_N(trace), 0.001);
  EXPECT_LT(force_direction_error_rad(trace), 1e-6);
  EXPECT_EQ(false_contact_fraction(trace), 0);
  EXPECT_EQ(lost_contact_fraction(trace), 0);
}

TEST(ContactReplayLoop, AStiffnessThatDiffersIsARelativeError) {
  for (const double stiffness : {300.0, 540.0})
    EXPECT_NEAR(relative_force_error(
                    replayed("god-object", {"trajectory.onset_distance_m=1e-5",
                                            "renderer.stiffness_N_per_m=" + std::to_string(stiffness)})),
                1 - stiffness / 600, 0.001)
        << stiffness;
}

// The ball sinks between the points of the grid by up to r_c - sqrt(r_c^2 - s^2 / 2) = 0.11 mm, 0.07 N.
TEST(ContactReplayLoop, AProxyOnAGridLacksTheForceOfItsSinking) {
  const Trace trace = replayed("proxy");
  EXPECT_LT(rms_force_error_N(trace), 600 * 1.14e-4);
  EXPECT_GT(rms_force_error_N(trace), 0.01);
  EXPECT_LT(lost_contact_fraction(trace), 0.01);
  EXPECT_EQ(false_contact_fraction(trace), 0);
}

TEST(ContactReplayLoop, FrictionIsFoundAsItsCoefficient) {
  for (const double friction : {0.0, 0.1, 0.3}) {
    const Trace trace = replayed("surfels", {"renderer.friction=" + std::to_string(friction)});
    EXPECT_NEAR(apparent_friction(trace), friction, 0.01) << friction;
    EXPECT_LT(force_direction_error_rad(trace), std::atan(friction) + 0.001) << friction;
  }
}

TEST(ContactReplayLoop, OtherRunsHaveNoExpectedForce) {
  EXPECT_FALSE(replayed("proxy", {"operator={}", "duration_s=0.1"}).has_replay());
  EXPECT_TRUE(replayed("proxy", {"device={}", "duration_s=0.1"}).has_replay());
  EXPECT_FALSE(replayed("proxy", {R"(trajectory={"name": "waypoints"})", "duration_s=0.1"}).has_replay());
}

TEST(ContactReplayLoop, RefusesASceneWithoutASurface) {
  EXPECT_HAS(refusal([] { replayed("proxy", {R"(scenario={"name": "points"})"}); }),
             "trajectory.name = contact-replay: no true surface is known");
}

}  // namespace
}  // namespace remote_touch::contact_replay_loop_test
