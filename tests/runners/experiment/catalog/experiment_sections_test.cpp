// Faults, guidance, task, operator and device in an experiment: what is read, written and refused.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::experiment_sections_test {
namespace {

constexpr const char* kTask = R"({"scenario": {"name": "flat-grid"},
    "fixtures": [{"name": "everywhere", "label": "table"},
                 {"name": "half-space", "role": "guidance", "label": "valve", "radius_m": 0.01}],
    "guidance": {"standoff_m": 0.05, "orientation": "plane"},
    "sequence": [{"action": "lock", "fixture": "table", "not_before_s": 0.1},
                 {"action": "activate", "fixture": "valve", "start": "button", "button": 2, "done": "reached",
                  "deadline_s": 4, "offset_m": [0, 0.1, 0]},
                 {"action": "wait", "done": "button", "button": 2}],
    "renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints"},
    "operator": {"mass_kg": 0.7, "grip": [[0, 1], [2, 0]], "presses": [[1, 2, 0.1]]},
    "device": {"torque_x": false, "max_force_N": 8}})";

Experiment task(const std::vector<std::string>& overrides = {}) {
  return Experiment::from_json(kTask, "task", overrides);
}
Json resolved(const std::vector<std::string>& overrides = {}) {
  return Json::parse(task(overrides).to_json());
}
std::string why(const std::string& assignment) {
  return refusal([&] { task({assignment}); });
}

// --- read and written ---

TEST(ExperimentSections, SectionsOfTheLiveLoopAreKept) {
  const std::string text =
      task({"live.device_position_m=[0,0.1,0]", "live.device_scale=2", "safety.ramp_s=1"}).to_json();
  EXPECT_EQ(Experiment::from_json(text, "again").to_json(), text);
  EXPECT_EQ(task({"live.device_scale=2"}).live().device_scale, 2);
  EXPECT_EQ(task({"safety.ramp_s=1"}).safety().ramp_s, 1);
  EXPECT_EQ(task().safety().max_force_N, SafetyLimits{}.max_force_N);
  EXPECT_HAS(why("safety.force_slew_N_per_s=100"), "safety.force_slew_N_per_s = 100");
  EXPECT_HAS(why("safety.max_force=3"), "safety.max_force: unknown");
}

TEST(ExperimentSections, OptionalSectionsAreNotWrittenUnlessGiven) {
  const Json json = Json::parse(Experiment::load("fig4.11").to_json());
  for (const char* section : {"faults", "guidance", "sequence", "operator", "device", "live", "safety"})
    EXPECT_FALSE(json.contains(section));
  EXPECT_FALSE(Json::parse(Experiment::load("fig4.11", {"sequence=[]"}).to_json()).contains("sequence"));
  EXPECT_TRUE(Json::parse(Experiment::load("fig4.11", {"operator={}"}).to_json()).contains("operator"));
}

TEST(ExperimentSections, CanBeChangedByOverrides) {
  EXPECT_EQ(resolved({"guidance.max_force_N=3"})["guidance"]["max_force_N"], 3);
  EXPECT_EQ(resolved({"guidance.max_force_N=3"})["guidance"]["standoff_m"], 0.05);
  EXPECT_EQ(resolved({"sequence.0.not_before_s=2"})["sequence"][0]["not_before_s"], 2);
  EXPECT_EQ(resolved({"sequence.1.offset_m=[0,0,0.5]"})["sequence"][1]["offset_m"][2], 0.5);
  EXPECT_EQ(resolved({"operator.grip=[[0,0.5]]"})["operator"]["grip"], Json::parse("[[0.0, 0.5]]"));
  EXPECT_EQ(resolved({"device.torque_x=true"})["device"]["torque_x"], true);
  // A section that the file does not have is made.
  EXPECT_EQ(
      Json::parse(Experiment::load("fig4.11", {"device.torque_z=false"}).to_json())["device"]["torque_z"],
      false);
}

TEST(ExperimentSections, OnlyAnExperimentWithATaskOrGuidanceIsGuided) {
  const auto guided = [](const std::vector<std::string>& overrides) {
    const auto renderer = task(overrides).build_renderer(scenes::kernels());
    return renderer->step({}, 0).guidance.has_value();
  };
  EXPECT_TRUE(guided({}));
  EXPECT_TRUE(guided({"sequence=[]"}));
  EXPECT_TRUE(guided({"fixtures=[]", "guidance=null", R"(sequence=[{"action": "wait"}])"}));
  EXPECT_FALSE(guided({"sequence=[]", "fixtures=[]", "guidance=null"}));
}

// A result must state the settings that it was made with, also those that were left out.
TEST(ExperimentSections, GuidanceThatIsLeftOutIsStoredWithItsDefaults) {
  const Json left_out = resolved({"guidance=null"})["guidance"];
  EXPECT_EQ(left_out, resolved({"guidance={}"})["guidance"]);
  EXPECT_EQ(left_out["standoff_m"], GuidanceSettings{}.standoff_m);
}

// --- refused ---

TEST(ExperimentSections, RefuseInvalidValues) {
  EXPECT_HAS(why("sequence.0.deadline_s=soon"),
             "sequence.0.deadline_s = \"soon\": expected a number from 0 to 86400");
  EXPECT_HAS(why("sequence.1.action=open"),
             "sequence.1.action = \"open\": expected lock, unlock, activate, release, wait");
  EXPECT_HAS(why("sequence.1.button=32"), "sequence.1.button = 32: expected integers 0 to 31");
  EXPECT_HAS(why("guidance.orientation=free"), "guidance.orientation = \"free\": expected fixed, plane");
  EXPECT_HAS(why("guidance.min_points=0"), "guidance.min_points = 0: expected integers 1 to");
  EXPECT_HAS(why("operator.mass_kg=0"), "operator.mass_kg = 0: expected 0.01 to 100");
  EXPECT_HAS(why("device.torque_x=1"), "device.torque_x = 1: expected true, false");
  EXPECT_HAS(why("fixtures.0.role=both"), "fixtures.0.role = \"both\": expected forbidden, guidance");
  EXPECT_HAS(why("device.torqe_x=true"), "device.torqe_x: unknown; did you mean device.torque_x");
}

TEST(ExperimentSections, RefuseSectionsOfAnotherShape) {
  EXPECT_HAS(why("sequence=3"), "sequence: expected a list of {\"action\": ..., parameters}");
  EXPECT_HAS(why(R"(sequence={"action": "wait"})"), "sequence: expected a list of");
  EXPECT_HAS(why("sequence=[3]"), "sequence.0: expected an object of parameters");
  for (const std::string section : {"faults", "guidance", "operator", "device"}) {
    EXPECT_HAS(why(section + "=3"), section + ": expected an object of parameters");
    EXPECT_HAS(why(section + "=[]"), section + ": expected an object of parameters");
  }
}

TEST(ExperimentSections, RefuseSettingsThatContradictEachOther) {
  EXPECT_HAS(why("guidance.approach_axis=[0,0,0]"),
             "guidance.approach_axis: expected a vector of length 0.001 or more");
  EXPECT_HAS(
      why(R"(operator={"inertia_kg_m2": 1e-5, "rotational_stiffness_Nm_per_rad": 101})"),
      "operator.rotational_stiffness_Nm_per_rad = 101.000000: expected at most 100.000000 for this inertia");
  EXPECT_HAS(why("operator.grip=[[0,2]]"), "operator.grip: fraction 2.000000: expected 0 to 1");
  EXPECT_HAS(why("operator.presses=[[0,32,1]]"), "operator.presses: button 32.000000: expected integers");
  EXPECT_HAS(why("sequence.0.fixture="), "sequence.0.fixture = \"\": expected the label of a fixture");
  EXPECT_HAS(why("sequence.2.fixture=valve"), "sequence.2.fixture = \"valve\": expected none for wait");
  for (const char* radius : {"0", "-1"})
    EXPECT_HAS(why(std::string("fixtures.1.radius_m=") + radius), "expected above 0 for role = guidance");
}

TEST(ExperimentSections, RefuseADeviceThatNeedsAHandWithAMass) {
  for (const std::string name :
       {"friction_N", "friction_torque_Nm", "damping_Ns_per_m", "rotational_damping_Nms_per_rad"}) {
    EXPECT_EQ(resolved({"device." + name + "=0.5"})["device"][name], 0.5);
    EXPECT_HAS(refusal([&] { Experiment::load("fig4.11", {"device." + name + "=0.5"}); }),
               "device." + name + " = 0.5: expected 0 in an experiment without the section operator");
  }
  EXPECT_HAS(why("device.velocity_ticks=2"), "device.velocity_ticks = 2: expected 1 without");
  EXPECT_EQ(
      resolved({"device.velocity_ticks=2", "device.contact_damping_Ns_per_m=1"})["device"]["velocity_ticks"],
      2);
}

TEST(ExperimentSections, RefuseATaskThatDoesNotFitItsFixtures) {
  EXPECT_EQ(why("sequence.1.fixture=knob"),
            "sequence.1.fixture = \"knob\": expected the label of a fixture: \"table\", \"valve\"");
  EXPECT_EQ(why("fixtures.1.label=table"),
            "fixtures.1.label = \"table\": expected a label of its own, fixtures.0 has this one");
  EXPECT_EQ(
      why("sequence.0.fixture=valve"),
      "sequence.0.action = \"lock\": expected activate, release, wait for a fixture with role = guidance");
  EXPECT_EQ(why(R"(sequence.1={"action": "release", "fixture": "table"})"),
            "sequence.1.action = \"release\": expected lock, unlock for a fixture with role = forbidden");
  EXPECT_EQ(why(R"(sequence.2={"action": "wait", "done": "reached", "fixture": "table"})"),
            "sequence.2.action = \"wait\": expected lock, unlock for a fixture with role = forbidden");
  EXPECT_EQ(
      why("sequence.2.button=3"),
      "sequence.2.button = 3: expected a button of operator.presses (any button in experiments with a section live)");
  EXPECT_EQ(
      why("operator=null"),
      "sequence.1.button = 2: expected a button of operator.presses (any button in experiments with a section live)");
  EXPECT_EQ(resolved({"operator=null", "live={}"})["sequence"].size(), 3u);  // a real device has buttons
  EXPECT_EQ(resolved({R"(sequence=[{"action": "wait"}])"})["sequence"].size(), 1u);  // presses may be unused
  EXPECT_EQ(refusal([] {
              task({"sequence=[]", R"(fixtures.0={"name": "everywhere", "role": "guidance"})"});
            }),
            "fixtures.1.role = guidance: expected at most once among fixtures that no step of a sequence "
            "activates or releases");
  EXPECT_EQ(why("sequence.0.offset_m=[0,0,1]"), "sequence.0.offset_m: expected 0 unless action = activate");
  EXPECT_EQ(why("sequence.0.deadline_s=1"),
            "sequence.0.deadline_s = 1.000000: expected 0 for done = immediately");
  // Fixtures without a label are not mixed up.
  EXPECT_EQ(resolved({"fixtures.0.label=", "fixtures.1.label=", "sequence=[]"})["fixtures"].size(), 2u);
}

TEST(ExperimentSections, RefuseMoreFixturesThanATaskCanSwitch) {
  Json json = Json::parse(kTask);
  while (json["fixtures"].size() < 64) json["fixtures"].push_back({{"name", "everywhere"}});
  EXPECT_NO_THROW(Experiment::from_json(json));
  json["fixtures"].push_back({{"name", "everywhere"}});
  EXPECT_EQ(refusal([&] { Experiment::from_json(json); }),
            "fixtures: 65 rules: expected 64 or fewer with a sequence");
  json.erase("sequence");
  EXPECT_NO_THROW(Experiment::from_json(json));
}

}  // namespace
}  // namespace remote_touch::experiment_sections_test
