// The table of sections: what each line must provide for reading, writing and help.
#include "runners/experiment/catalog/configuration.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "analysis/trace/measures.h"
#include "runners/experiment/catalog/experiment.h"
#include "runners/experiment/settings/json_parameters.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::sections_test {
namespace {

// An experiment with every section.
constexpr const char* kAll = R"({"scenario": {"name": "camera-scene"}, "faults": {}, "depth_pipeline": {},
    "fixtures": [{"name": "everywhere", "role": "guidance", "label": "all", "radius_m": 0.01}], "guidance": {},
    "sequence": [{"action": "activate", "fixture": "all"}], "renderer": {"name": "proxy"},
    "changes": [{"time_s": 1, "parameter": "renderer.r3_m", "value": 0.02}],
    "trajectory": {"name": "waypoints"}, "operator": {}, "device": {}, "slave": {}, "command_link": {}, "force_link": {}, "frame_link": {}, "feedback": {}, "registration": {},
    "live": {}, "safety": {}})";

std::string why(const std::string& assignment) {
  return refusal([&] { Experiment::from_json(kAll, "all", {assignment}); });
}

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

TEST(Sections, HaveNamesOfTheirOwnAndASentence) {
  std::set<std::string> keys;
  for (const ExperimentSection& section : experiment_sections()) {
    EXPECT_TRUE(keys.insert(section.key).second) << section.key << " is there twice";
    EXPECT_GT(std::string(section.summary).size(), 10u) << section.key;
    ASSERT_FALSE(section.entries().empty()) << section.key;
    for (const SectionEntry& entry : section.entries()) {
      EXPECT_EQ(entry.name.empty(), section.heading == nullptr) << section.key;
      EXPECT_TRUE(entry.name.empty() || !keys.contains(entry.name)) << entry.name << ": describe finds two";
      EXPECT_FALSE(entry.make()->settings().empty()) << section.key << " " << entry.name;
    }
  }
}

TEST(Sections, AreWrittenInTheOrderOfTheTable) {
  std::vector<std::string> expected;
  for (const ExperimentSection& section : experiment_sections())
    if (section.is_top_level)
      for (const Parameter& p : section.entries().front().make()->settings()) expected.push_back(p.name);
    else
      expected.push_back(section.key);
  const std::string text = Experiment::from_json(kAll, "all").to_json();
  EXPECT_EQ(keys_of(Json::parse(text)), expected);
  EXPECT_EQ(Experiment::from_json(text, "again").to_json(), text);
}

TEST(Sections, AreWrittenCompletely) {
  const Json resolved = Json::parse(Experiment::from_json(kAll, "all").to_json());
  for (const ExperimentSection& section : experiment_sections()) {
    if (section.is_top_level) continue;
    const Json& written = resolved[section.key];
    const Json& one = written.is_array() ? written.at(0) : written;
    for (const SectionEntry& entry : section.entries()) {
      if (!entry.name.empty() && one["name"] != entry.name) continue;
      const auto made = entry.make();
      EXPECT_EQ(one.size(), made->settings().size() + !entry.name.empty()) << section.key;
      for (const Parameter& p : made->settings()) EXPECT_TRUE(one.contains(p.name)) << section.key << p.name;
    }
  }
}

TEST(Sections, RefuseWhatIsNoSection) {
  for (const ExperimentSection& section : experiment_sections()) {
    const std::string key = section.key;
    if (section.is_top_level) {
      EXPECT_EQ(why(key + "=3").find(key + ": unknown; did you mean "), 0u) << why(key + "=3");
      continue;
    }
    for (const char* value : {"3", "text", "true", "[3]"}) {
      EXPECT_EQ(why(key + "=" + value).find(key), 0u) << key << ": " << why(key + "=" + value);
      EXPECT_HAS(why(key + "=" + value), "expected ");
    }
  }
}

TEST(Sections, RefuseUnknownParametersByTheirPath) {
  for (const ExperimentSection& section : experiment_sections()) {
    const bool is_list = Json::parse(kAll).value(section.key, Json()).is_array();
    const std::string path = section.is_top_level ? "" : std::string(section.key) + (is_list ? ".0." : ".");
    EXPECT_EQ(why(path + "moon_px=3").find(path + "moon_px: unknown; did you mean " + path), 0u)
        << why(path + "moon_px=3");
  }
}

// The size of a position depends on the origin of the world frame.
TEST(Sections, RefuseARelativeDeadBandOfCommands) {
  const std::string refused =
      "command_link.weber_fraction = 0.1: expected 0, and a length as command_link.least: the size of a "
      "position depends on the origin";
  EXPECT_EQ(why("command_link.weber_fraction=0.1"), refused);
  EXPECT_EQ(
      refusal([] {
        Experiment::load("steer-robot", {"command_link.weber_fraction=0.1", "command_link.least=0.001"});
      }),
      refused);
  EXPECT_EQ(why("force_link.weber_fraction=0.1"), "no InputError");
}

// An optional section may be left out or null, with the same result. A required one is reported as missing in
// both cases.
TEST(Sections, LeftOutAndNullAreTheSame) {
  for (const ExperimentSection& section : experiment_sections()) {
    if (section.is_top_level) continue;
    const auto resolved = [&](bool is_null) {
      Json json = Json::parse(kAll);
      json.erase("sequence");  // its steps name a fixture
      if (is_null)
        json[section.key] = nullptr;
      else
        json.erase(section.key);
      if (section.key == std::string("fixtures")) json.erase("guidance");  // guidance needs a fixture
      if (section.key == std::string("slave"))
        for (const char* needing : {"command_link", "force_link", "frame_link", "feedback", "registration"})
          json.erase(needing);
      return Experiment::from_json(json).to_json();
    };
    SCOPED_TRACE(section.key);
    const std::string missing = refusal([&] { resolved(false); });
    EXPECT_EQ(refusal([&] { resolved(true); }), missing);
    if (missing == "no InputError") {
      EXPECT_EQ(resolved(true), resolved(false));
    } else {
      EXPECT_HAS(missing, std::string(section.key) + ": missing");
    }
  }
}

// Passivity control and waves would balance another motion than the hand has. They know the limit of a force.
TEST(Sections, PassivityControlNeedsAnExactDevice) {
  for (const std::string force : {"passive-slave-force", "wave"}) {
    const auto why_with = [&](const std::string& setting) {
      return refusal([&] {
        Experiment::load("steer-robot", {"feedback.force=" + force, "device=" + setting});
      });
    };
    for (const char* setting : {"{}", R"({"friction_N": 0.1})", R"({"max_force_N": 2})"})
      EXPECT_EQ(why_with(setting), "no InputError") << setting;
    for (const char* setting : {R"({"force_y": false})", R"({"position_resolution_m": 5e-5})",
                                R"({"delay_ticks": 1})", R"({"contact_damping_Ns_per_m": -1})"})
      EXPECT_HAS(why_with(setting), "expected the default with feedback.force = " + force) << setting;
  }
}

TEST(Sections, AnArchitectureRefusesWhatItCannotUse) {
  const auto why = [](const std::string& force, const std::string& setting) {
    return refusal([&] { Experiment::load("steer-robot", {"feedback.force=" + force, setting}); });
  };
  EXPECT_HAS(why("wave", "command_link.least=0.001"), "command_link.least = 0.001");
  EXPECT_HAS(why("wave", "force_link.weber_fraction=0.1"), "force_link.weber_fraction = 0.1");
  EXPECT_HAS(why("position-position", "force_link.least=0.1"), "which needs every packet");
  EXPECT_EQ(why("position-position", "command_link.least=0.001"), "no InputError");
  EXPECT_HAS(why("wave", "slave.max_speed_m_per_s=0.2"), "slave.max_speed_m_per_s = 0.2: expected 0");
  EXPECT_HAS(why("wave", "feedback.gain=0.5"), "expected 1 unless force = slave-force");
  EXPECT_HAS(why("slave-force", "feedback.impedance_Ns_per_m=20"), "expected 0 unless force = wave");
  EXPECT_HAS(why("wave", "feedback.stiffness_N_per_m=300"), "expected 600 unless force = position-position");
}

TEST(Sections, TheOverrideThatRemovesTheSlaveRemovesItsLinks) {
  const Json all = Json::parse(Experiment::load("steer-robot", {"slave=null"}).to_json());
  for (const char* section :
       {"slave", "command_link", "force_link", "frame_link", "feedback", "registration"})
    EXPECT_TRUE(!all.contains(section) || all[section].is_null()) << section;
  EXPECT_HAS(refusal([] {
               Experiment::load("steer-robot", {"slave=null", "command_link.delay_s=1"});
             }),
             "command_link: expected only in an experiment with the section slave");
}

}  // namespace
}  // namespace remote_touch::sections_test

// Faults, guidance, task, operator and device in an experiment: what is read, written and refused.
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
