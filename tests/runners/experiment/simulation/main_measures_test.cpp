#include "runners/experiment/simulation/main_measures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/trace/trace.h"
#include "runners/experiment/simulation/simulation.h"

namespace remote_touch::main_measures_test {
namespace {

using Names = std::vector<std::string>;

Trace run(const std::string& experiment, std::vector<std::string> settings) {
  SimulationOptions options;
  options.find_true_contact = true;
  settings.emplace_back("duration_s=0.8");
  return simulate(Experiment::load(experiment, settings), options);
}

Names main_names(const Trace& trace, Fixtures fixtures) {
  Names names;
  for (const auto& [measure, value] : main_measures(measured_values(built_in_measures(), trace), fixtures)) {
    EXPECT_FALSE(std::isnan(value)) << measure->name;
    names.push_back(measure->name);
  }
  return names;
}

TEST(MainMeasures, ProxyRunsReportTheTrueSurfaceFirst) {
  const Trace trace = run("fig4.12", {});
  EXPECT_EQ(main_names(trace, Fixtures::none),
            (Names{"popped_through", "max_penetration", "rms_contact_error", "max_force", "max_force_jump"}));
  EXPECT_EQ(main_names(trace, Fixtures::some), (Names{"min_slave_distance", "max_force", "max_force_jump",
                                                      "force_fraction", "unconverged_fraction"}));
}

TEST(MainMeasures, OfASlaveBeginWithItsContact) {
  const Trace trace = run("steer-robot", {});
  EXPECT_EQ(main_names(trace, Fixtures::some),
            (Names{"max_slave_force", "min_slave_clearance", "max_device_force", "min_slave_distance",
                   "max_force"}));
}

TEST(MainMeasures, HaveOthersIfTheTruthIsUnknown) {
  Trace trace = run("fig4.12", {});
  for (double& distance_m : trace.signed_distance_m) distance_m = std::nan("");
  trace.contact.clear();
  EXPECT_EQ(main_names(trace, Fixtures::none),
            (Names{"max_force", "max_force_jump", "force_fraction", "unconverged_fraction", "mean_steps"}));
}

TEST(MainMeasures, OfAToolHaveItsTorqueAndGuidanceItsGoal) {
  EXPECT_EQ(
      main_names(run("tool-lift", {}), Fixtures::none),
      (Names{"tool_popped_through", "max_tool_penetration", "max_force", "max_force_jump", "max_torque"}));
  Trace guided;
  RenderOutput out;
  out.guidance.emplace().active = true;
  out.guidance->goal_W = Vec3(0.01, 0, 0);
  guided.append(0, {}, out, {0.01, 0.01, 0});
  EXPECT_EQ(main_names(guided, Fixtures::some).front(), "min_slave_distance");
  EXPECT_EQ(main_names(guided, Fixtures::some).at(1), "guidance_error");
}

TEST(MainMeasures, HaveAllThatAreNotBuiltIn) {
  const Trace trace = run("fig4.12", {});
  std::vector<Measure> list = built_in_measures();
  list.push_back({"mine", "N/s", "my own", MeasuredRuns::all, [](const Trace&) { return 41.0; }});
  const std::vector<MeasuredValue> all = measured_values(list, trace);
  const std::vector<MeasuredValue> chosen = main_measures(all, Fixtures::none);
  ASSERT_EQ(chosen.size(), 6u);
  EXPECT_EQ(chosen.back().measure->name, "mine");
  EXPECT_EQ(chosen.back().value, 41);
}

TEST(MainMeasures, AreFewerIfFewHaveAValue) {
  EXPECT_LE(main_names(Trace(), Fixtures::none).size(), 5u);
}

TEST(UnitInWords, NamesEveryUnitOfTheBuiltInMeasures) {
  for (const Measure& measure : built_in_measures())
    EXPECT_NE(unit_in_words(measure.unit), measure.unit) << measure.name;
  EXPECT_EQ(unit_in_words("m"), "metres");
  EXPECT_EQ(unit_in_words("1"), "");
  EXPECT_EQ(unit_in_words("N/s"), "N/s");
}

}  // namespace
}  // namespace remote_touch::main_measures_test
