// Experiments: stored, from files and with overrides; the sections that they have, and what they resolve to.
#include "runners/experiment/catalog/experiment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "runners/experiment/catalog/configuration.h"
#include "runners/experiment/settings/json_parameters.h"
#include "tests/runners/experiment/catalog/whole_experiments.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::experiment_test {
namespace {

// The resolved configuration of an experiment with these overrides.
Json resolved(const char* experiment, const std::vector<std::string>& overrides = {}) {
  return Json::parse(Experiment::from_json(experiment, "test", overrides).to_json());
}

TEST(Experiments, AllFilesAreStored) {
  const std::filesystem::path folder = std::filesystem::path(REMOTE_TOUCH_SOURCE_DIR) / "data/experiments";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    ++files;
    const auto stored = std::find_if(
        embedded_experiments().begin(), embedded_experiments().end(),
        [&](const EmbeddedText& s) { return entry.path().filename() == std::string(s.name) + ".json"; });
    ASSERT_NE(stored, embedded_experiments().end()) << entry.path();
    EXPECT_EQ(stored->json, bytes_of(entry.path()));
  }
  EXPECT_EQ(embedded_experiments().size(), files);
}

void expect_has_all(const Json& whole, const Json& part) {
  for (const auto& [name, value] : part.items()) EXPECT_EQ(whole[name], value) << part << ": " << name;
}

TEST(Experiments, SurviveARoundTrip) {
  for (const EmbeddedText& stored : embedded_experiments()) {
    SCOPED_TRACE(stored.name);
    const Experiment experiment = Experiment::load(stored.name);
    const std::string text = experiment.to_json();
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_EQ(Experiment::from_json(text, "again").to_json(), text);
    EXPECT_FALSE(experiment.settings().title.empty());

    // The resolved configuration contains everything that the file states.
    const Json file = Json::parse(stored.json), all = Json::parse(text);
    for (const auto& [key, value] : file.items()) {
      if (key == "fixtures" || key == "sequence") {
        ASSERT_EQ(all[key].size(), value.size());
        for (std::size_t i = 0; i < value.size(); ++i) expect_has_all(all[key][i], value[i]);
      } else if (value.is_object()) {
        expect_has_all(all[key], value);
      } else {
        EXPECT_EQ(all[key], value) << key;
      }
    }
  }
}

// The defaults, then the file, then the overrides, of which the last one counts: a whole part, then one of
// its parameters.
TEST(Experiments, ApplyDefaultsThenFileThenOverrides) {
  const Json plain = resolved(kSmall);
  EXPECT_EQ(plain["seed"], 5);
  EXPECT_EQ(plain["scenario"]["columns"], 7);
  EXPECT_EQ(plain["scenario"]["rows"], 100);
  EXPECT_EQ(plain["fixtures"], Json::array());
  const Json changed = resolved(
      kSmall, {"seed=-1", "seed=6", "scenario.columns=8", R"(renderer={"name": "proxy", "gamma": 0.5})",
               "renderer.steps_per_tick=3", "title=a plain text = with more", "device.torque_z=false",
               R"(fixtures=[{"name": "half-space", "radius_m": 0.03}, {"name": "everywhere"}])",
               "fixtures.1.radius_m=0.5", "fixtures.0.normal=[0,1,0]"});
  EXPECT_EQ(changed["seed"], 6);
  EXPECT_EQ(changed["scenario"]["columns"], 8);
  EXPECT_EQ(changed["title"], "a plain text = with more");
  EXPECT_EQ(changed["renderer"]["gamma"], 0.5);
  EXPECT_EQ(changed["renderer"]["steps_per_tick"], 3);
  EXPECT_NE(changed["renderer"]["xi"], 0.25) << "the whole part of the file was replaced";
  EXPECT_EQ(changed["device"]["torque_z"], false) << "a section that the file does not have is made";
  ASSERT_EQ(changed["fixtures"].size(), 2u);
  EXPECT_EQ(changed["fixtures"][0]["radius_m"], 0.03);
  EXPECT_EQ(changed["fixtures"][0]["normal"], Json::parse("[0.0, 1.0, 0.0]"));
  EXPECT_EQ(changed["fixtures"][1]["name"], "everywhere");
  EXPECT_EQ(changed["fixtures"][1]["radius_m"], 0.5);
}

TEST(Experiments, DefaultsFitTogether) {
  const auto expect_no_contradiction = [](const auto& entries) {
    for (const auto& entry : entries) {
      const std::string name = entry.name;  // a recording and a mask have no default path
      EXPECT_EQ(entry.make()->validate().empty(),
                name != "recording" && name != "image-mask" && name != "live-session")
          << name;
    }
  };
  expect_no_contradiction(scenarios()), expect_no_contradiction(fixtures()),
      expect_no_contradiction(renderers()), expect_no_contradiction(trajectories());
}

// --- sections ---

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

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
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
  const Json whole = resolved(kAll);
  for (const ExperimentSection& section : experiment_sections()) {
    if (section.is_top_level) continue;
    const Json& written = whole[section.key];
    const Json& one = written.is_array() ? written.at(0) : written;
    for (const SectionEntry& entry : section.entries()) {
      if (!entry.name.empty() && one["name"] != entry.name) continue;
      const auto made = entry.make();
      EXPECT_EQ(one.size(), made->settings().size() + !entry.name.empty()) << section.key;
      for (const Parameter& p : made->settings()) EXPECT_TRUE(one.contains(p.name)) << section.key << p.name;
    }
  }
}

// An optional section may be left out or null, with the same result. A required one is reported as missing in
// both cases.
TEST(Sections, LeftOutAndNullAreTheSame) {
  for (const ExperimentSection& section : experiment_sections()) {
    if (section.is_top_level) continue;
    const auto written = [&](bool is_null) {
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
    const std::string missing = refusal([&] { written(false); });
    EXPECT_EQ(refusal([&] { written(true); }), missing);
    if (missing == "no InputError") {
      EXPECT_EQ(written(true), written(false));
    } else {
      EXPECT_HAS(missing, std::string(section.key) + ": missing");
    }
  }
}

TEST(Sections, TheOverrideThatRemovesTheSlaveRemovesItsLinks) {
  const Json all = Json::parse(Experiment::load("steer-robot", {"slave=null"}).to_json());
  for (const char* section :
       {"slave", "command_link", "force_link", "frame_link", "feedback", "registration"})
    EXPECT_TRUE(!all.contains(section) || all[section].is_null()) << section;
}

// Every setting of the live loop reaches the field of its name.
TEST(Sections, OfTheLiveLoopReachTheLoop) {
  const Experiment set = Experiment::from_json(
      kTask, "task",
      {R"(live={"device_position_m": [1, 1, 1], "device_rotation_deg": [2, 2, 2], "device_scale": 3,
                "camera_position_m": [4, 4, 4], "camera_rotation_deg": [5, 5, 5]})",
       R"(safety={"max_force_N": 1, "max_torque_Nm": 2, "force_slew_N_per_s": 300,
                  "torque_slew_Nm_per_s": 400, "max_speed_m_per_s": 5, "max_angular_speed_rad_per_s": 6,
                  "engage_force_N": 7, "ramp_s": 8, "max_command_age_s": 0.9, "max_frame_age_s": 10})"});
  const LiveSettings& live = set.live();
  EXPECT_EQ(live.device_position_m, Vec3::Constant(1));
  EXPECT_EQ(live.device_rotation_deg, Vec3::Constant(2));
  EXPECT_EQ(live.device_scale, 3);
  EXPECT_EQ(live.camera_position_m, Vec3::Constant(4));
  EXPECT_EQ(live.camera_rotation_deg, Vec3::Constant(5));
  const SafetyLimits& s = set.safety();
  const double limits[] = {s.max_force_N,        s.max_torque_Nm,
                           s.force_slew_N_per_s, s.torque_slew_Nm_per_s,
                           s.max_speed_m_per_s,  s.max_angular_speed_rad_per_s,
                           s.engage_force_N,     s.ramp_s,
                           s.max_command_age_s,  s.max_frame_age_s};
  const double expected[] = {1, 2, 300, 400, 5, 6, 7, 8, 0.9, 10};
  for (int i = 0; i < 10; ++i) EXPECT_EQ(limits[i], expected[i]) << i;
  EXPECT_EQ(Experiment::from_json(kTask, "task").safety().max_force_N, SafetyLimits{}.max_force_N);
}

TEST(Sections, AreNotWrittenUnlessGiven) {
  const Json json = Json::parse(Experiment::load("fig4.11", {"sequence=[]"}).to_json());
  for (const char* section : {"faults", "guidance", "sequence", "operator", "device", "live", "safety"})
    EXPECT_FALSE(json.contains(section));
}

TEST(Sections, OnlyAnExperimentWithATaskOrGuidanceIsGuided) {
  const auto guided = [](const std::vector<std::string>& overrides) {
    const auto renderer = Experiment::from_json(kTask, "task", overrides).build_renderer(scenes::kernels());
    return renderer->step({}, 0).guidance.has_value();
  };
  EXPECT_TRUE(guided({}));
  EXPECT_TRUE(guided({"sequence=[]"}));
  EXPECT_TRUE(guided({"fixtures=[]", "guidance=null", R"(sequence=[{"action": "wait"}])"}));
  EXPECT_FALSE(guided({"sequence=[]", "fixtures=[]", "guidance=null"}));
}

// A result must state the settings that it was made with, also those that were left out.
TEST(Sections, GuidanceThatIsLeftOutIsStoredWithItsDefaults) {
  const Json left_out = resolved(kTask, {"guidance=null"})["guidance"];
  EXPECT_EQ(left_out, resolved(kTask, {"guidance={}"})["guidance"]);
  EXPECT_EQ(left_out["standoff_m"], GuidanceSettings{}.standoff_m);
}

}  // namespace
}  // namespace remote_touch::experiment_test
