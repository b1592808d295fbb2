// A sweep states what it runs: parts that overwrite each other are refused, as are axes that state nothing.
// The test command_line/refusals has more refusals; random_sweeps_test.cpp tries parts at random.
#include "runners/sweep/sweep.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::sweep_refusals_test {
namespace {

using Plain = nlohmann::json;
using Texts = std::vector<std::string>;

// {"parameter": path, "values": values}
std::string axis(const std::string& path, const std::string& values) {
  return R"({"parameter": ")" + path + R"(", "values": )" + values + "}";
}
// Axes of several parameters. rest: without the brace at its end.
std::string joint(const std::string& rest) {
  return R"({"name": "r_c", )" + rest + "}";
}
std::string radii(const std::string& rest) {
  return joint(R"("parameters": ["renderer.r1_m", "renderer.r2_m"], )" + rest);
}
std::string variants(const std::string& list) {
  return R"({"name": "variant", "variants": )" + list + "}";
}

const std::string kNoise = axis("scenario.noise_sigma_m", "[0, 0.001]");
const std::string kAcceleration = axis("scenario.acceleration_m_per_s2", "[1, 20]");
const std::string kScene =
    axis("scenario", R"([{"name": "moving-lift", "acceleration_m_per_s2": 3}, {"name": "flat-grid"}])");
const std::string kStart = axis("trajectory.start_m.1", "[0, 0.01]");
const std::string kStiffness = axis("renderer.stiffness_N_per_m", "[300, 500]");
const std::string kSeed = axis("seed", "[1]");

struct Statements {
  std::string axes, set = "{}";
  Texts overrides = {};

  std::string refused() const {
    return refusal([&] {
      Sweep::from_json(R"({"experiment": "fig4.12", "axes": [)" + axes +
                           R"(], "measures": ["mean_steps"], "set": )" + set + "}",
                       "mine.json", overrides);
    });
  }
};

// A change of the stiffness of the renderer, or of another parameter.
std::string change_at(const std::string& time_s, const std::string& parameter = "stiffness_N_per_m",
                      const std::string& value = "300") {
  return R"({"changes": [{"time_s": )" + time_s + R"(, "parameter": "renderer.)" + parameter +
         R"(", "value": )" + value + "}]}";
}

TEST(Refusals, OfAxesAndValuesThatOverwriteEachOther) {
  const std::string moving = R"(scenario={"name": "moving-lift"})";
  const std::pair<Statements, std::string> cases[] = {
      // Axes that overlap: other spellings of one position are the same parameter.
      {{kAcceleration + "," + kScene},
       "mine.json: axes.1 scenario: overlaps axes.0 scenario.acceleration_m_per_s2: expected each parameter once, "
       "and none that contains another"},
      {{kStart + "," + axis("trajectory.start_m.01", "[0.02]")},
       "axes.1 trajectory.start_m.01: overlaps axes.0 trajectory.start_m.1: "},
      {{radii(R"("values": [[0.004, 0.0042]])") + "," + axis("renderer.r2_m", "[0.01]")},
       "axes.1 renderer.r2_m: overlaps axes.0 renderer.r2_m"},
      // Values of `set`. An object states one value where the axis states others; null states that there are
      // no
      // faults.
      {{kAcceleration, R"({"scenario.acceleration_m_per_s2": 2})"},
       "mine.json: set.scenario.acceleration_m_per_s2: is overwritten by the axis "
       "scenario.acceleration_m_per_s2: expected one of them"},
      {{kScene, R"({"scenario.columns.": 50})"}, "set.scenario.columns.: is overwritten by the axis "},
      {{kNoise, R"({"scenario": {"name": "moving-lift", "noise_sigma_m": 0.002}})"},
       "set.scenario: is overwritten by the axis scenario.noise_sigma_m: "},
      {{axis("faults.dropout_probability", "[0, 0.5]"), R"({"faults": null})"},
       "set.faults: is overwritten by the axis faults.dropout_probability: "},
      {{axis("fixtures.0.radius_m", "[0.1, 0.2]"),
        R"({"fixtures": [{"name": "everywhere", "radius_m": 0.1}]})"},
       "set.fixtures: is overwritten by the axis "},
      {{radii(R"("values": [[0.004, 0.0042]])"), R"({"renderer.r2_m": 0.02})"},
       "set.renderer.r2_m: is overwritten by the axis r_c (renderer.r2_m)"},
      {{kNoise, R"({"scenario.columns": 50, "scenario": {"name": "moving-lift"}})"},
       "set.scenario.columns: is overwritten by set.scenario: "},
      {{kNoise, R"({"scenario": {"name": "moving-lift", "columns": 60}, "scenario.columns": 50})"},
       "set.scenario: is overwritten by set.scenario.columns: "},
      // Values of the command line, and an object of it that would remove a value that the user has set.
      {{kScene, "{}", {"scenario.columns=50"}},
       "--set scenario.columns=50: is overwritten by the axis scenario: "},
      {{kAcceleration, "{}", {"scenario.columns=50", moving}},
       "--set scenario.columns=50: is overwritten by --set scenario: expected one of them"},
      {{kAcceleration, R"({"scenario.columns": 50})", {moving}},
       "mine.json: set.scenario.columns: is overwritten by --set scenario: expected one of them"},
      {{kAcceleration, "{}", {"axes.0.values=[2]", "axes=[" + kSeed + "]"}},
       "--set axes.0.values=[2]: is overwritten by --set axes: "},
      // A change at 0 s is made before the first tick.
      {{axis("renderer.velocity_estimate", "[false, true]"), change_at("0", "velocity_estimate", "0")},
       "cell 1: axis renderer.velocity_estimate = true: the run has false: "}};
  for (const auto& [statements, text] : cases) EXPECT_HAS(statements.refused(), text);
}

TEST(Refusals, OfAxesThatStateNothing) {
  const std::pair<std::string, std::string> cases[] = {
      {axis("scenario.noise_sigma_m", "[0, 0.0]"), "axes.0.values: 0.0 appears twice: expected once"},
      {axis("trajectory.start_m.0", "[0.01, -0.0, 0]"), "axes.0.values: 0 appears twice"},
      {axis("seed", R"([1, "1"])"), "appears twice"},
      {axis("renderer.name", R"(["proxy", "tracked-sheet"])"),
       "axis renderer.name = \"tracked-sheet\": expected the axis renderer, with values like"},
      {R"({"name": "r=c", "parameters": ["seed"], "values": [[1]]})",
       "axes.0.name = \"r=c\": expected a letter, then letters, digits and _"},
      {radii(R"("values": [[0.005]])"),
       "axes.0.values.0: [0.005]: expected a list of 2 values, one for each parameter"},
      {radii(R"("values": [[0.005, 0.006], [0.005, 0.007]])"), "0.005 appears twice"},
      {radii(R"("values": [[0.005, 0.006]], "unit": "mm")"),
       "axes.0.unit = \"mm\": expected m, the unit of renderer.r1_m, or labels"},
      {radii(R"("values": [[0.005, 0.006]], "labels": [1, 2])"),
       "axes.0.labels: expected 1 numbers or as many names"},
      {radii(R"("values": [[0.005, 0.006]], "label": [1])"), "axes.0.label"},
      {joint(R"("parameters": ["renderer", "renderer.r1_m"], "values": [[{"name": "proxy"}, 0.01]])"),
       "axes.0.parameters: renderer.r1_m overlaps renderer"},
      {joint(R"("parameters": ["trajectory.poses.0.."], "values": [[1]])"),
       "axes.0.parameters: \"trajectory.poses.0..\": expected the path of a parameter"},
      {joint(R"("parameters": ["safety.max_force_N"], "values": [[1]])"), "only live runs use section"},
      {variants("[]"), "axes.0.variants: expected a list of"},
      {variants(R"([{"name": "a"}, {"name": "b"}])"), "axes.0.variants: none sets a parameter"},
      {variants(R"([{"name": "a", "set": {"": 1}}])"),
       "axes.0.variants.0.set: \"\": expected the path of a parameter"},
      {variants(R"([{"set": {"seed": 1}}])"), "axes.0.variants.0.name: expected a name"},
      {variants(R"([{"name": "a", "set": {"seed": 1}}, {"name": "a", "set": {"seed": 2}}])"),
       "\"a\" appears twice"},
      {variants(R"([{"name": "a", "set": {"renderer.name": "tracked-sheet"}}])"),
       "axis renderer.name = \"tracked-sheet\": expected renderer, with values like"},
      {variants(R"([{"name": "a", "set": {"renderer": {"name": "proxy"}, "renderer.xi": 0.5}}])"),
       "axes.0.variants.0.set: renderer.xi overlaps renderer"}};
  for (const auto& [axes, text] : cases) EXPECT_HAS(Statements{axes}.refused(), text);
}

// An axis may replace a value of the experiment file, and --set may replace a value of `set`. A list cannot
// be given without the element that an axis changes, but an object in a list can be.
TEST(Refusals, AcceptValuesThatDoNotOverwriteEachOther) {
  const Statements cases[] = {
      {axis("scenario.rows", "[50, 60]") + "," + kStart + "," + axis("trajectory.start_m.0", "[0, 0.01]")},
      {kNoise, R"({"scenario": {"name": "moving-lift", "columns": 50}})"},
      {kNoise, R"({"scenario": {"name": "moving-lift"}, "scenario.columns": 50})"},
      {kNoise, "{}", {R"(scenario={"name": "moving-lift"})", "scenario.columns=50"}},
      {kNoise, R"({"scenario.columns": 50})", {"scenario.columns=60"}},
      {kNoise, R"({"scenario.columns": 50})", {R"(scenario={"name": "moving-lift", "columns": 50})"}},
      {kNoise, "{}", {"seed=3", "seed=4"}},
      {kStart, R"({"trajectory.start_m": [0.01, 0, 0]})"},
      {axis("fixtures.0.stiffness_N_per_m", "[100, 200]"),
       R"({"fixtures": [{"name": "everywhere", "radius_m": 0.1}]})"},
      {kStiffness, change_at("0.1")},
      {axis("renderer.damping_Ns_per_m", "[0, 1]"), change_at("0")}};
  for (const Statements& each : cases) EXPECT_EQ(each.refused(), "no InputError") << each.axes << each.set;
}

// --set experiment.x changes the experiment before `set` and the axes do.
TEST(Refusals, OfValuesOfTheOwnExperiment) {
  const auto why_with = [](const std::string& set, const Texts& overrides) {
    Plain sweep = Plain::parse(R"({"axes": [{"parameter": "seed", "values": [1, 2]}]})");
    sweep["experiment"] = Plain::parse(Experiment::load("fig4.12").to_json());
    sweep["set"] = Plain::parse(set);
    return refusal([&] { Sweep::from_json(sweep.dump(), "mine.json", overrides); });
  };
  EXPECT_HAS(why_with("{}", {"experiment.seed=4"}),
             "--set experiment.seed=4: is overwritten by the axis seed: ");
  EXPECT_HAS(why_with(R"({"duration_s": 0.7})", {"experiment.duration_s=0.6"}),
             "is overwritten by set.duration_s: ");
  EXPECT_HAS(why_with("{}", {"duration_s=0.7", "experiment.duration_s=0.6"}),
             "is overwritten by --set duration_s: ");
  EXPECT_EQ(why_with(R"({"duration_s": 0.7})", {"experiment.haptic_rate_hz=900"}), "no InputError");
}

// A refusal of an override does not name the file.
TEST(Refusals, NameTheFileWithTheMistake) {
  const TestFolder folder("sweep_file_test");
  const std::string file = (folder / "sweep.json").string(), own = (folder / "mine.json").string();
  Plain sound =
      Plain::parse(R"({"experiment": "fig4.12", "replicates": 2, "measures": ["mean_steps"], "set": {},
    "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.01, "count": 3}]})");
  Plain experiment = Plain::parse(Experiment::load("fig4.12").to_json());
  experiment["renderer"]["xi"] = -1;
  folder.write("mine.json", experiment.dump());
  const auto why = [&](const char* pointer, const Plain& value, const Texts& overrides = {}) {
    Plain json = sound;
    json[Plain::json_pointer(pointer)] = value;
    folder.write("sweep.json", json.dump());
    return refusal([&] { Sweep::load(file, overrides); });
  };
  const std::pair<std::string, std::string> cases[] = {
      {why("/replicates", 0), file + ": replicates = 0: expected "},
      {why("/replicates", 0, {"seed=3"}), file + ": replicates = 0: "},
      {why("/set/renderer.xi", -1), file + ": renderer.xi = -1: expected "},
      {why("/axes/0/to", 7), file + ": cell 1: scenario.noise_sigma_m = 3.5: "},
      {why("/experiment", "mine.json"), own + ": renderer.xi = -1"},
      {why("/replicates", 1, {"axes.0.count=0"}), "axes.0.count = 0: "},
      {why("/replicates", 1, {"renderer.xi=-1"}), "renderer.xi = -1: "},
      {why("/replicates", 1, {"measures=[]"}), "measures: "}};
  for (const auto& [found, beginning] : cases) EXPECT_TRUE(found.starts_with(beginning)) << found;
}

TEST(Refusals, OfARunWithAnotherValue) {
  const Experiment run = Experiment::load("fig4.12", {"scenario.acceleration_m_per_s2=3", "faults={}"});
  EXPECT_EQ(refusal([&] { require_run(run, "scenario.acceleration_m_per_s2", 20); }),
            "axis scenario.acceleration_m_per_s2 = 20: the run has 3.0: expected a value that nothing else "
            "changes");
  const auto is_refused = [&](const char* path, const char* value) {
    return refusal([&] { require_run(run, path, Json::parse(value)); }) != "no InputError";
  };
  EXPECT_FALSE(is_refused("scenario", R"({"name": "moving-lift", "acceleration_m_per_s2": 3})"));
  EXPECT_TRUE(is_refused("scenario", R"({"name": "moving-lift", "acceleration_m_per_s2": 4})"));
  EXPECT_TRUE(is_refused("scenario", R"({"speed": 4})"));
  EXPECT_FALSE(is_refused("trajectory.start_m", "[0, 0.0, 0]"));
  EXPECT_TRUE(is_refused("trajectory.start_m", "[0, 0, 1]"));
  EXPECT_TRUE(is_refused("trajectory.start_m", "[0, 0]"));
  EXPECT_FALSE(is_refused("trajectory.start_m.2", "0"));
  EXPECT_FALSE(is_refused("depth_pipeline", "null"));
  EXPECT_TRUE(is_refused("faults", "null"));
  EXPECT_FALSE(is_refused("faults", "{}"));
  EXPECT_TRUE(is_refused("renderer.velocity_estimate", "1"));
  EXPECT_TRUE(is_refused("nothing", "1"));
}

TEST(Refusals, OfAResultThatIsNotOfTheSweep) {
  const Sweep sweep = Sweep::from_json(R"({"experiment": "fig4.12", "measures": ["mean_steps"], "axes": [)" +
                                           kNoise + "," + kAcceleration + "]}",
                                       "mine.json");
  const auto why_not = [&](auto&& change) {
    SweepResult stored = sweep.plan();
    change(stored);
    return refusal([&] { sweep.require_fits(stored, "map.h5"); });
  };
  EXPECT_EQ(why_not([](SweepResult&) {}), "no InputError");
  const std::string axes = "map.h5: damaged (its axes are not those of its configuration)";
  EXPECT_EQ(why_not([](SweepResult& r) { r.axes[1].values = std::vector<double>{1, 19}; }), axes);
  EXPECT_EQ(why_not([](SweepResult& r) { r.axes[1].long_name = "scenario.rows"; }), axes);
  EXPECT_EQ(why_not([](SweepResult& r) { std::swap(r.axes[0], r.axes[1]); }), axes);
  EXPECT_EQ(why_not([](SweepResult& r) { r.axes.pop_back(); }), axes);
  const std::string arrays = "map.h5: damaged (its arrays do not fit its configuration)";
  EXPECT_EQ(why_not([](SweepResult& r) { r.replicates = 2; }), arrays);
  EXPECT_EQ(why_not([](SweepResult& r) { r.measures[0].name = "max_force"; }), arrays);
}

}  // namespace
}  // namespace remote_touch::sweep_refusals_test
