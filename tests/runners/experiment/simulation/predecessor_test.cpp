// The predecessor [1]: fixed small steps and no velocity estimate, as settings of the same renderer.
#include <gtest/gtest.h>

#include "analysis/trace/measures.h"
#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch::predecessor_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::predecessor_test
