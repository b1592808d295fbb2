// Experiments: stored, from files and with overrides; what they resolve to and what they refuse.
#include "runners/experiment/catalog/experiment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/experiment/settings/json_parameters.h"
#include "tests/support/test_files.h"

namespace remote_touch::experiment_test {
namespace {

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

void expect_has_all(const Json& resolved, const Json& part) {
  for (const auto& [name, value] : part.items()) EXPECT_EQ(resolved[name], value) << part << ": " << name;
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
    const Json file = Json::parse(stored.json), resolved = Json::parse(text);
    for (const auto& [key, value] : file.items()) {
      if (key == "fixtures" || key == "sequence") {
        ASSERT_EQ(resolved[key].size(), value.size());
        for (std::size_t i = 0; i < value.size(); ++i) expect_has_all(resolved[key][i], value[i]);
      } else if (value.is_object()) {
        expect_has_all(resolved[key], value);
      } else {
        EXPECT_EQ(resolved[key], value) << key;
      }
    }
  }
}

constexpr const char* kSmall = R"({"seed": 5, "scenario": {"name": "flat-grid", "columns": 7},
    "renderer": {"name": "proxy", "xi": 0.25}, "trajectory": {"name": "waypoints"}})";

Json resolved(const std::vector<std::string>& overrides) {
  return Json::parse(Experiment::from_json(kSmall, "small", overrides).to_json());
}

TEST(Experiments, ApplyDefaultsThenFileThenOverrides) {
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

TEST(Experiments, InvalidOverridesAreRefused) {
  const auto why = [](const std::string& assignment) { return refusal([&] { resolved({assignment}); }); };
  EXPECT_HAS(why("seed"), "--set seed: expected key=value");
  EXPECT_HAS(why("=3"), "--set =3: expected key=value");
  EXPECT_HAS(why("seed.x=3"), "--set seed.x=3: the path continues below a plain value");
  EXPECT_HAS(why("scenario=3"), "scenario");
  EXPECT_HAS(why("renderer.=3"), "renderer");
  EXPECT_HAS(why("title=\xff"), "title");
  EXPECT_HAS(why("renderer.xi=" + std::string(1000, '[')), "renderer.xi");
  EXPECT_HAS(why("renderer.xi=" + std::string(1000, '[') + std::string(1000, ']')), "renderer.xi");
}

TEST(Experiments, RefuseSettingsThatContradictEachOther) {
  const auto why = [](const std::string& assignment) { return refusal([&] { resolved({assignment}); }); };
  EXPECT_HAS(why("renderer.r1_m=0.006"), "renderer.r1_m = 0.006: expected below r2_m = 0.00501");
  EXPECT_HAS(why("renderer.r3_m=0.005"), "renderer.r2_m = 0.00501: expected below r3_m = 0.005");
  EXPECT_HAS(why("trajectory.waypoints=[]"), "trajectory.waypoints = []");
  EXPECT_HAS(why("trajectory.waypoints=[[0,0,0,-1]]"), "trajectory.waypoints");
  EXPECT_HAS(why(R"(scenario={"name":"recording"})"), "scenario.path");
}

// --- fixture rules ---

TEST(Experiments, FixturesAreAListInOrder) {
  EXPECT_EQ(resolved({})["fixtures"], Json::array());
  const std::string two = R"(fixtures=[{"name": "half-space", "radius_m": 0.03}, {"name": "everywhere"}])";
  const Json changed = resolved({two, "fixtures.1.radius_m=0.5", "fixtures.0.normal=[0,1,0]"})["fixtures"];
  ASSERT_EQ(changed.size(), 2u);
  EXPECT_EQ(changed[0]["name"], "half-space");
  EXPECT_EQ(changed[0]["radius_m"], 0.03);
  EXPECT_EQ(changed[0]["normal"], Json::parse("[0.0, 1.0, 0.0]"));
  EXPECT_EQ(changed[1]["name"], "everywhere");
  EXPECT_EQ(changed[1]["radius_m"], 0.5);
}

TEST(Experiments, RefuseInvalidFixtures) {
  const auto why = [](const std::string& list, const std::string& change = "seed=1") {
    return refusal([&] { resolved({"fixtures=" + list, change}); });
  };
  for (const char* list : {"3", "{}", "{\"name\": \"everywhere\"}", "everywhere"})
    EXPECT_HAS(why(list), "fixtures: expected a list of {") << list;
  for (const char* list : {"[{}]", "[null]", "[{\"radius_m\": 1}]"})
    EXPECT_HAS(why(list), "fixtures.0: missing: expected {\"name\"") << list;
  EXPECT_HAS(why("[3]"), "fixtures.0 = 3: not an object: expected {\"name\"");
  EXPECT_HAS(why("[[]]"), "fixtures.0 = []: not an object: expected {\"name\"");
  EXPECT_HAS(why("[\"everywhere\"]"),
             "fixtures.0 = \"everywhere\": not an object: expected {\"name\": \"everywhere\"}");
  const std::string one = R"([{"name": "everywhere"}])";
  EXPECT_HAS(
      why(one, "fixtures.0.name=moon"),
      "fixtures.0.name = \"moon\": expected everywhere, half-space, near-point, hue-range, image-mask");
  EXPECT_HAS(why(one, "fixtures.0.name=3"), "fixtures.0.name = 3");
  EXPECT_HAS(why(one, "fixtures.0.radius=1"), "fixtures.0.radius: unknown; did you mean fixtures.0.radius_m");
  EXPECT_HAS(why(one, "fixtures.0.radius_m=2"), "fixtures.0.radius_m = 2: expected -1 to 1");
  EXPECT_HAS(why(one, "fixtures.0.schedule=[[0,1.5]]"), "fixtures.0.schedule: strength 1.5");
  EXPECT_HAS(why(one, "fixtures.1.radius_m=1"), "expected an index of the list, 0 to 0");
  EXPECT_HAS(why("[]", "fixtures.0.radius_m=1"), "fixtures");
  EXPECT_HAS(why(R"([{"name": "everywhere"}, {"name": "half-space", "normal": [0, 0, 0]}])"),
             "fixtures.1.normal: expected longer than 0");
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

TEST(Experiments, RefuseWithTheMessageOfTheManual) {
  EXPECT_EQ(refusal([] { Experiment::load("fig4.11", {"renderer.stiffness_N_per_m=-3"}); }),
            "renderer.stiffness_N_per_m = -3: expected 0 to 10000");
  EXPECT_EQ(refusal([] { Experiment::load("fig4.11", {"haptic_rate_hz=fast"}); }),
            "haptic_rate_hz = \"fast\": expected a number from 100 to 10000");
}

TEST(Experiments, AnUnknownKeyIsRefusedWithTheNearest) {
  const auto nearest = [](const std::string& assignment) {
    return refusal([&] { Experiment::load("fig4.11", {assignment}); });
  };
  EXPECT_EQ(nearest("renderer.stiffnes=3"),
            "renderer.stiffnes: unknown; did you mean renderer.stiffness_N_per_m");
  EXPECT_HAS(nearest("renderer.stifness_N_per_m=3"), "renderer.stiffness_N_per_m");
  EXPECT_HAS(nearest("renderer.r1=3"), "did you mean renderer.r1_m");
  EXPECT_HAS(nearest("scenario.colums=3"), "did you mean scenario.columns");
  EXPECT_HAS(nearest("trajectory.waypoint=3"), "did you mean trajectory.waypoints");
  EXPECT_HAS(nearest("duration=3"), "duration: unknown; did you mean duration_s");
  EXPECT_HAS(nearest("sede=3"), "did you mean seed");
  // Sections are searched together with the parameters of the run.
  EXPECT_HAS(nearest("fixturs=3"), "fixturs: unknown; did you mean fixtures");
  EXPECT_HAS(nearest("saftey.ramp_s=3"), "did you mean safety");
  EXPECT_HAS(nearest("renderer.nam=proxy"), "did you mean renderer.name");
  EXPECT_HAS(nearest("run.seed=3"), "run: unknown");
  // A key without its section is named with it.
  EXPECT_HAS(nearest("spacing_m=0.001"), "spacing_m: unknown; did you mean scenario.spacing_m");
  EXPECT_HAS(nearest("r1_m=0.001"), "r1_m: unknown; did you mean renderer.r1_m");
}

TEST(Experiments, AnotherNameKeepsNoParameterThatOnlyTheFormerEntryHas) {
  EXPECT_EQ(refusal([] { Experiment::load("fig4.12", {"scenario.name=flat-grid"}); }),
            "scenario.acceleration_m_per_s2: flat-grid has no such parameter: expected --set "
            "'scenario={\"name\": \"flat-grid\"}', which replaces the whole object");
  EXPECT_EQ(refusal([] { Experiment::load("fig4.12", {"scenario={\"name\": \"flat-grid\"}"}); }),
            "no InputError");
  EXPECT_HAS(refusal([] { Experiment::load("fig4.12", {"scenario.name=moon"}); }),
             "scenario.name = \"moon\"");
  EXPECT_HAS(refusal([] {
               Experiment::load("fig4.12", {"scenario.name=flat-grid", "scenario.x_m=1"});
             }),
             "flat-grid has no such parameter");
}

TEST(Experiments, ASweepIsRefusedByItsCommand) {
  EXPECT_EQ(refusal([] { Experiment::from_json(R"({"experiment": "fig4.12", "axes": []})", "mine.json"); }),
            "mine.json: is a sweep: expected `remote-touch sweep mine.json -o FILE`");
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
  EXPECT_EQ(
      why(R"({"scenario": "flat-grid"})"),
      "scenario = \"flat-grid\": not an object: expected {\"name\": \"flat-grid\"}, with parameters beside "
      "the name");
  EXPECT_HAS(why(R"({"scenario": {"columns": 3}})"), "scenario: missing");
  EXPECT_HAS(why(R"({"scenario": {"name": "moon"}})"), "scenario.name = \"moon\": expected flat-grid, ");
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

TEST(Experiments, AnErrorInAFileBeginsWithItsName) {
  const TestFolder folder("experiment_file_test");
  const std::string file = (folder / "mine.json").string();
  const auto why = [&](const std::string& text, const std::vector<std::string>& overrides = {}) {
    folder.write("mine.json", text);
    return refusal([&] { Experiment::load(file, overrides); });
  };
  const std::string rest = R"("renderer": {"name": "proxy"}, "trajectory": {"name": "waypoints"}})";
  const std::string wrong = R"({"scenario": {"name": "flat-grid", "spacing_m": 7}, )" + rest;
  EXPECT_TRUE(why(wrong).starts_with(file + ": scenario.spacing_m = 7: expected ")) << why(wrong);
  EXPECT_TRUE(why(wrong, {"seed=9"}).starts_with(file + ": scenario.spacing_m = 7: expected "));
  EXPECT_EQ(why(wrong, {"scenario.spacing_m=0.002"}), "no InputError");
  EXPECT_TRUE(why("{}").starts_with(file + ": scenario: missing"));
  EXPECT_TRUE(why("[]").starts_with(file + ": not an object"));
  EXPECT_TRUE(why("{").starts_with(file + ": parse error"));
}

TEST(Experiments, ARefusalOfAnOverrideDoesNotNameTheFile) {
  const TestFolder folder("experiment_override_test");
  const auto why = [&](const std::string& text, const std::string& assignment) {
    const std::string file = folder.write("mine.json", text).string();
    return refusal([&] { Experiment::load(file, {assignment}); });
  };
  EXPECT_TRUE(why(kSmall, "scenario.spacing_m=7").starts_with("scenario.spacing_m = 7: expected "));
  EXPECT_TRUE(why(kSmall, "seed=-1").starts_with("seed = -1: expected "));
  EXPECT_TRUE(why(kSmall, "seed").starts_with("--set seed: expected "));
  EXPECT_TRUE(why(kSmall, "renderer.r1_m=0.0051").starts_with("renderer.r1_m = "));
  // This holds even if the text of the file is wrong.
  EXPECT_TRUE(why("{}", "scenario=3").starts_with("scenario = 3: "));
  EXPECT_TRUE(why("{}", "=3").starts_with("--set =3: "));
  EXPECT_TRUE(why(R"({"seed": 3})", "seed.x=1").starts_with("--set seed.x=1: "));
}

}  // namespace
}  // namespace remote_touch::experiment_test
