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
