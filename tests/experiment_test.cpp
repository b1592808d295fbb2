// Experiments: stored, from files and with overrides; what they resolve to and what they refuse.
#include "runners/experiment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/json_parameters.h"
#include "tests/test_files.h"

namespace remote_touch {
namespace {

TEST(Experiments, AllFilesAreStored) {
  const std::filesystem::path folder = std::filesystem::path(REMOTE_TOUCH_SOURCE_DIR) / "data/experiments";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    ++files;
    const auto stored = std::find_if(
        stored_experiments().begin(), stored_experiments().end(),
        [&](const StoredText& s) { return entry.path().filename() == std::string(s.name) + ".json"; });
    ASSERT_NE(stored, stored_experiments().end()) << entry.path();
    EXPECT_EQ(stored->json, bytes_of(entry.path()));
  }
  EXPECT_EQ(stored_experiments().size(), files);
}

TEST(Experiments, SurviveARoundTrip) {
  for (const StoredText& stored : stored_experiments()) {
    SCOPED_TRACE(stored.name);
    const Experiment experiment = Experiment::load(stored.name);
    const std::string text = experiment.to_json();
    EXPECT_EQ(text.find('\n'), std::string::npos);
    EXPECT_EQ(Experiment::from_json(text, "again").to_json(), text);
    EXPECT_FALSE(experiment.settings().title.empty());

    // What the file says is in the resolved configuration.
    const Json file = Json::parse(stored.json), resolved = Json::parse(text);
    for (const auto& [key, value] : file.items()) {
      if (!value.is_object()) {
        EXPECT_EQ(resolved[key], value) << key;
        continue;
      }
      for (const auto& [name, number] : value.items())
        EXPECT_EQ(resolved[key][name], number) << key << "." << name;
    }
  }
}

// The resolved configuration has every parameter of the run and of its parts.
TEST(Experiments, AreResolvedCompletely) {
  const Json json = Json::parse(Experiment::load("fig4.11").to_json());
  RunSettings run;
  EXPECT_EQ(json.size(), parameters(run).size() + 3);
  const auto expect_all = [&](const char* part, auto entries) {
    const auto blueprint = find_entry(entries, json[part]["name"].template get<std::string>(), part).make();
    EXPECT_EQ(json[part].size(), blueprint->settings().size() + 1) << part;
    for (const Parameter& p : blueprint->settings()) EXPECT_TRUE(json[part].contains(p.name)) << p.name;
  };
  expect_all("scenario", scenarios()), expect_all("renderer", renderers()),
      expect_all("trajectory", trajectories());
}

constexpr const char* kSmall = R"({"seed": 5, "scenario": {"name": "flat-grid", "columns": 7},
    "renderer": {"name": "proxy", "xi": 0.25}, "trajectory": {"name": "waypoints"}})";

Json resolved(const std::vector<std::string>& overrides) {
  return Json::parse(Experiment::from_json(kSmall, "small", overrides).to_json());
}

TEST(Experiments, DefaultsThenFileThenOverrides) {
  const Json plain = resolved({});
  EXPECT_EQ(plain["seed"], 5);
  EXPECT_EQ(plain["scenario"]["columns"], 7);
  EXPECT_EQ(plain["scenario"]["rows"], 100);
  const Json changed = resolved({"scenario.columns=8", "scenario.rows=9", "seed=6"});
  EXPECT_EQ(changed["seed"], 6);
  EXPECT_EQ(changed["scenario"]["columns"], 8);
  EXPECT_EQ(changed["scenario"]["rows"], 9);
  EXPECT_EQ(changed["renderer"], plain["renderer"]);
}

TEST(Experiments, TheLastOverrideCounts) {
  EXPECT_EQ(resolved({"seed=6", "seed=7"})["seed"], 7);
  EXPECT_EQ(resolved({"seed=-1", "seed=7"})["seed"], 7);
  // A whole part, then one of its parameters.
  const Json json =
      resolved({R"(renderer={"name": "proxy", "gamma": 0.5})", "renderer.steps_per_tick=3"})["renderer"];
  EXPECT_EQ(json["gamma"], 0.5);
  EXPECT_EQ(json["steps_per_tick"], 3);
  EXPECT_EQ(json["xi"], resolved({R"(renderer={"name": "proxy"})"})["renderer"]["xi"]);
}

TEST(Experiments, OverridesAreJsonOrPlainText) {
  EXPECT_EQ(resolved({"title=a plain text = with more"})["title"], "a plain text = with more");
  EXPECT_EQ(resolved({"title=\"3\""})["title"], "3");
  EXPECT_EQ(resolved({"title="})["title"], "");
  EXPECT_EQ(resolved({"renderer.step_rule=fixed"})["renderer"]["step_rule"], "fixed");
  EXPECT_EQ(resolved({"trajectory.waypoints=[[0,0.01,0,0],[0.1,0.01,0,1e-2]]"})["trajectory"]["waypoints"],
            Json::parse("[[0.0, 0.01, 0.0, 0.0], [0.1, 0.01, 0.0, 0.01]]"));
}

TEST(Experiments, RefuseOverridesThatAreNone) {
  const auto why = [](const std::string& assignment) { return refusal([&] { resolved({assignment}); }); };
  EXPECT_HAS(why("seed"), "--set seed: allowed key=value");
  EXPECT_HAS(why("=3"), "--set =3: allowed key=value");
  EXPECT_HAS(why("seed.x=3"), "--set seed.x=3: the path leads through a value");
  EXPECT_HAS(why("scenario=3"), "scenario");
  EXPECT_HAS(why("renderer.=3"), "renderer");
  EXPECT_HAS(why("title=\xff"), "title");
  EXPECT_HAS(why("renderer.xi=" + std::string(1000, '[')), "renderer.xi");
  EXPECT_HAS(why("renderer.xi=" + std::string(1000, '[') + std::string(1000, ']')), "renderer.xi");
}

TEST(Experiments, RefuseSettingsThatContradictEachOther) {
  const auto why = [](const std::string& assignment) { return refusal([&] { resolved({assignment}); }); };
  EXPECT_HAS(why("renderer.r1_m=0.006"), "renderer.r1_m = 0.006: allowed below r2_m = 0.00501");
  EXPECT_HAS(why("renderer.r3_m=0.005"), "renderer.r2_m = 0.00501: allowed below r3_m = 0.005");
  EXPECT_HAS(why("trajectory.waypoints=[]"), "trajectory.waypoints = []");
  EXPECT_HAS(why("trajectory.waypoints=[[0,0,0,-1]]"), "trajectory.waypoints");
  EXPECT_HAS(why(R"(scenario={"name":"recording"})"), "scenario.path");
}

TEST(Experiments, DefaultsFitTogether) {
  const auto expect_no_contradiction = [](const auto& entries) {
    for (const auto& entry : entries)  // a recording has no default path
      EXPECT_EQ(entry.make()->contradiction().empty(), entry.name != std::string("recording")) << entry.name;
  };
  expect_no_contradiction(scenarios()), expect_no_contradiction(renderers()),
      expect_no_contradiction(trajectories());
}

TEST(Experiments, TheMessageIsThatOfTheManual) {
  EXPECT_EQ(refusal([] { Experiment::load("fig4.11", {"renderer.stiffness_N_per_m=-3"}); }),
            "renderer.stiffness_N_per_m = -3: allowed 0 to 10000");
  EXPECT_EQ(refusal([] { Experiment::load("fig4.11", {"haptic_rate_hz=fast"}); }),
            "haptic_rate_hz = \"fast\": allowed 100 to 10000");
}

TEST(Experiments, AnUnknownKeyIsRefusedWithTheNearest) {
  const auto nearest = [](const std::string& assignment) {
    return refusal([&] { Experiment::load("fig4.11", {assignment}); });
  };
  EXPECT_EQ(nearest("renderer.stiffnes=3"),
            "renderer.stiffnes: unknown; the nearest allowed is renderer.stiffness_N_per_m");
  EXPECT_HAS(nearest("renderer.stifness_N_per_m=3"), "renderer.stiffness_N_per_m");
  EXPECT_HAS(nearest("renderer.r1=3"), "allowed is renderer.r1_m");
  EXPECT_HAS(nearest("scenario.colums=3"), "allowed is scenario.columns");
  EXPECT_HAS(nearest("trajectory.waypoint=3"), "allowed is trajectory.waypoints");
  EXPECT_HAS(nearest("duration=3"), "duration: unknown; the nearest allowed is duration_s");
  EXPECT_HAS(nearest("sede=3"), "allowed is seed");
}

TEST(Experiments, RefuseTextThatIsNoExperiment) {
  const auto why = [](const std::string& text) {
    return refusal([&] { Experiment::from_json(text, "file.json"); });
  };
  for (const char* text : {"", "{", "[", "{\"seed\": NaN}", "{\"seed\": 1e999}", "nonsense", "{} {}", "\xff"})
    EXPECT_HAS(why(text), "file.json: ") << text;
  for (const char* text : {"[]", "3", "null", "\"text\""})
    EXPECT_HAS(why(text), "file.json: not an object") << text;
  EXPECT_HAS(why(std::string(100000, '[')), "file.json: nested too deep");
  EXPECT_HAS(why("{}"), "scenario: missing");
  EXPECT_HAS(why(R"({"scenario": {"columns": 3}})"), "scenario: missing");
  EXPECT_HAS(why(R"({"scenario": {"name": "moon"}})"), "scenario.name = \"moon\": allowed flat-grid, ");
  EXPECT_HAS(why(R"({"scenario": {"name": "flat-grid"}})"), "renderer: missing");
  EXPECT_HAS(why(R"({"scenario": {"name": "flat-grid"}, "renderer": {"name": "proxy"}})"),
             "trajectory: missing");
}

TEST(Experiments, AreLoadedByNameOrFile) {
  const TestFolder folder("experiment_test");
  const std::string file = folder.write("small.json", kSmall).string();
  EXPECT_EQ(Experiment::load(file).to_json(), Experiment::from_json(kSmall, "small").to_json());
  EXPECT_EQ(Experiment::load(file, {"seed=9"}).settings().key.seed, 9u);
  const std::string missing = (folder / "missing.json").string();
  EXPECT_HAS(refusal([&] { Experiment::load(missing); }), missing + ": ");
  EXPECT_HAS(refusal([&] { Experiment::load(folder.path().string()); }), folder.path().string() + ": ");
  EXPECT_HAS(refusal([&] { Experiment::load(folder.write("cut.json", "{\"see").string()); }), "cut.json: ");
}

}  // namespace
}  // namespace remote_touch
