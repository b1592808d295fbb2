// The definition, axes and cells of a sweep. The test command_line/sweep_bad_input tests refusals, too.
#include "runners/sweep/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/experiment/settings/json_parameters.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_test {
namespace {

constexpr const char* kSmall = R"({"title": "small", "experiment": "fig4.12",
  "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
  "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.01, "count": 3},
           {"parameter": "scenario.acceleration_m_per_s2", "from": 0, "to": 6, "count": 4}],
  "replicates": 2, "measures": ["popped_through", "mean_steps"]})";

Sweep small(const std::vector<std::string>& overrides = {}) {
  return Sweep::from_json(kSmall, "small.json", overrides);
}
Sweep along(const std::string& axis, const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> all = {"axes=[" + axis + "]"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return small(all);
}
// Returns the value at a path like "scenario.noise_sigma_m" in the experiment of a cell.
Json value_in(const Sweep& sweep, std::size_t cell, const std::string& path, int replicate = 0) {
  std::string pointer = "/" + path;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  return Json::parse(sweep.experiment(cell, replicate).to_json())[Json::json_pointer(pointer)];
}
std::vector<double> numbers(const Sweep& sweep) {
  return std::get<std::vector<double>>(sweep.plan().axes.at(0).values);
}

TEST(Sweeps, AllFilesAreStoredAndResolve) {
  const std::filesystem::path folder = std::filesystem::path(REMOTE_TOUCH_SOURCE_DIR) / "data/sweeps";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    files += entry.path().extension() == ".json";
  EXPECT_EQ(embedded_sweeps().size(), files);
  for (const EmbeddedText& stored : embedded_sweeps()) {
    SCOPED_TRACE(stored.name);
    EXPECT_EQ(stored.json, bytes_of(folder / (std::string(stored.name) + ".json")));
    const Sweep sweep = Sweep::load(stored.name);
    EXPECT_FALSE(sweep.title().empty());
    EXPECT_EQ(Sweep::from_json(sweep.to_json(), "again").to_json(), sweep.to_json());
  }
}

// The map of fig 4.13 has 76 values of sigma and 71 of a, with the ends that the dissertation gives.
TEST(Sweeps, HaveTheMapOfFigure413) {
  const SweepResult plan = Sweep::load("fig4.13").plan();
  ASSERT_EQ(plan.axes.size(), 2u);
  EXPECT_EQ(plan.axes[0].length(), 76u);
  EXPECT_EQ(plan.axes[1].length(), 71u);
  EXPECT_EQ(std::get<std::vector<double>>(plan.axes[0].values).back(), 0.015);
  EXPECT_EQ(std::get<std::vector<double>>(plan.axes[1].values).back(), 7);
  EXPECT_EQ(plan.runs_in(RunState::pending).size(), 5396u);
}

TEST(Sweeps, SurviveARoundTrip) {
  const std::vector<std::vector<std::string>> cases = {
      {},
      {"axes.0.scale=log", "axes.0.from=1e-3"},
      {R"(axes.0={"parameter": "renderer.step_rule", "values": ["fixed", "variable"]})"},
      {R"(axes.0={"parameter": "trajectory.start_m", "values": [[0, 0, 0], [0, 0, 0.01]]})"},
      {R"(axes.0={"parameter": "seed", "values": [18446744073709551615, 1]})"},
      {"refine.budget=50", "refine.levels=2", "refine.threshold=0.25"},
      {"replicates=7", "title=grün", "scenario.columns=150"}};
  for (const auto& overrides : cases) {
    const Sweep sweep = small(overrides), again = Sweep::from_json(sweep.to_json(), "again");
    EXPECT_EQ(again.to_json(), sweep.to_json());
    EXPECT_EQ(again.plan().state, sweep.plan().state);
    EXPECT_EQ(again.title(), sweep.title());
    for (std::size_t cell = 0; cell < sweep.plan().cell_count(); ++cell)
      EXPECT_EQ(again.experiment(cell, 1).to_json(), sweep.experiment(cell, 1).to_json()) << cell;
  }
}

TEST(Sweeps, KeepEveryNthValueWhenThinned) {
  const SweepResult plan = Sweep::load("fig4.13").thinned(5).plan();
  const SweepResult whole = Sweep::load("fig4.13").plan();
  ASSERT_EQ(plan.cell_count(), 16u * 15u);
  for (std::size_t axis = 0; axis < 2; ++axis)
    for (std::size_t i = 0; i < plan.axes[axis].length(); ++i)
      EXPECT_NEAR(std::get<std::vector<double>>(plan.axes[axis].values)[i],
                  std::get<std::vector<double>>(whole.axes[axis].values)[5 * i], 1e-12);
  const Sweep listed =
      along(R"({"parameter": "scenario.noise_sigma_m", "values": [0, 1e-3, 2e-3, 3e-3, 4e-3]})");
  EXPECT_EQ(numbers(listed.thinned(3)), (std::vector<double>{0, 3e-3}));
  EXPECT_EQ(numbers(listed.thinned(9)), (std::vector<double>{0}));
  EXPECT_EQ(listed.thinned(1).to_json(), listed.to_json());
  EXPECT_EQ(small().thinned(2).plan().replicates, 2);
  // The steps of a range need not divide evenly: each value is one of the whole axis, to the last bit.
  for (const char* scale : {"linear", "log"}) {
    const Sweep range = along(R"({"parameter": "scenario.noise_sigma_m", "from": 1e-3, "to": 7e-3, "count": 8,
                                  "common_noise": true, "scale": ")" +
                              std::string(scale) + "\"}");
    const std::vector<double> all = numbers(range);
    EXPECT_EQ(numbers(range.thinned(3)), (std::vector<double>{all[0], all[3], all[6]}));
    EXPECT_HAS(range.thinned(3).to_json(), "common_noise");
  }
}

// The last axis changes fastest. Only the axes, the keys of the noise and the title of the experiment change.
TEST(Sweeps, ACellIsTheExperimentWithItsValues) {
  const Sweep sweep = small();
  Json plain =
      Json::parse(Experiment::load("fig4.12", {"haptic_rate_hz=900", "renderer.steps_per_tick=1"}).to_json());
  for (std::size_t cell = 0; cell < 12; ++cell)
    for (int replicate = 0; replicate < 2; ++replicate) {
      plain["scenario"]["noise_sigma_m"] = std::vector{0.0, 0.005, 0.01}[cell / 4];
      plain["scenario"]["acceleration_m_per_s2"] = std::vector{0.0, 2.0, 4.0, 6.0}[cell % 4];
      plain["cell"] = cell, plain["replicate"] = replicate;
      Json run = Json::parse(sweep.experiment(cell, replicate).to_json());
      run["title"] = plain["title"];  // see Titles
      EXPECT_EQ(run, plain);
      EXPECT_EQ(sweep.plan().cell_at(sweep.plan().axis_indices(cell)), cell);
    }
}

TEST(Sweeps, HaveTheRequestedMeasuresOrAll) {
  ASSERT_EQ(small().measures().size(), 2u);
  EXPECT_EQ(small().measures()[1].name, std::string("mean_steps"));
  EXPECT_EQ(small({R"(measures=["mean_steps", "popped_through"])"}).plan().measures[0].name, "mean_steps");
  Json json = Json::parse(kSmall);
  json.erase("measures");
  EXPECT_EQ(Sweep::from_json(json.dump(), "x").measures().size(), measures().size());
}

// A path in a sweep's file starts at the file's own folder.
TEST(Sweeps, AcceptAnExperimentByNameByFileOrInline) {
  const TestFolder folder("sweep_test");
  const std::string experiment = Experiment::load("fig4.12", {"seed=5", "title=mine"}).to_json();
  folder.write("below/mine.json", experiment);
  Json json = Json::parse(kSmall);
  json["experiment"] = "mine.json";
  const Sweep beside = Sweep::load(folder.write("below/sweep.json", json.dump()).string());
  json["experiment"] = Json::parse(experiment);
  const Sweep written = Sweep::from_json(json.dump(), "written");
  EXPECT_EQ(beside.to_json(), written.to_json());
  EXPECT_EQ(value_in(beside, 3, "seed"), 5);
  EXPECT_HAS(refusal([&] { small({"experiment=moon"}); }), "moon: cannot be read");
}

TEST(Sweeps, AnErrorInAFileBeginsWithItsName) {
  const TestFolder folder("sweep_file_test");
  const std::string file = (folder / "sweep.json").string(), own = (folder / "mine.json").string();
  Json json = Json::parse(kSmall);
  const auto why = [&](const std::vector<std::string>& overrides = {}) {
    folder.write("sweep.json", json.dump());
    return refusal([&] { Sweep::load(file, overrides); });
  };
  json["replicates"] = 0;
  EXPECT_TRUE(why().starts_with(file + ": replicates = 0: expected ")) << why();
  EXPECT_TRUE(why({"seed=3"}).starts_with(file + ": replicates = 0: "));
  json["replicates"] = 2;
  json["set"]["renderer.xi"] = -1;
  EXPECT_TRUE(why().starts_with(file + ": renderer.xi = -1: expected ")) << why();
  json["set"].erase("renderer.xi");
  json["axes"][0]["to"] = 7;
  EXPECT_TRUE(why().starts_with(file + ": cell 1,0: scenario.noise_sigma_m = 3.5: ")) << why();
  json["axes"][0]["to"] = 0.01;
  Json experiment = Json::parse(Experiment::load("fig4.12").to_json());
  experiment["renderer"]["xi"] = -1;
  folder.write("mine.json", experiment.dump());
  json["experiment"] = "mine.json";
  EXPECT_TRUE(why().starts_with(own + ": renderer.xi = -1")) << why();
}

TEST(Sweeps, ARefusalOfAnOverrideDoesNotNameTheFile) {
  const TestFolder folder("sweep_override_test");
  const std::string file = folder.write("sweep.json", kSmall).string();
  const auto why = [&](const std::string& assignment) {
    return refusal([&] { Sweep::load(file, {assignment}); });
  };
  EXPECT_TRUE(why("replicates=0").starts_with("replicates = 0: "));
  EXPECT_TRUE(why("axes.0.count=0").starts_with("axes.0.count = 0: "));
  EXPECT_TRUE(why("renderer.xi=-1").starts_with("renderer.xi = -1: "));
  EXPECT_TRUE(why("measures=[]").starts_with("measures: "));
  EXPECT_TRUE(why("scenario.noise_sigma_m=0").starts_with("--set scenario.noise_sigma_m=0: "));
}

TEST(Axes, CanBeLinearOrLogarithmic) {
  EXPECT_EQ(numbers(along(R"({"parameter": "frame_latency_s", "from": 0, "to": 1, "count": 5})")),
            (std::vector{0.0, 0.25, 0.5, 0.75, 1.0}));
  EXPECT_EQ(
      numbers(along(R"({"parameter": "scenario.noise_sigma_m", "from": 0.01, "to": 0.002, "count": 2})")),
      (std::vector{0.01, 0.002}));
  EXPECT_EQ(numbers(along(R"({"parameter": "duration_s", "from": 0.5, "to": 9, "count": 1})")),
            (std::vector{0.5}));
  EXPECT_EQ(
      numbers(along(R"({"parameter": "duration_s", "from": 1e-2, "to": 1e3, "count": 6, "scale": "log"})")),
      (std::vector{0.01, 0.1, 1.0, 10.0, 100.0, 1000.0}));
  // The steps are equal to rounding, and the ends are as they were written.
  const auto steps =
      numbers(along(R"({"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 76})"));
  for (std::size_t i = 0; i < 76; ++i) EXPECT_NEAR(steps[i], 0.0002 * static_cast<double>(i), 1e-17);
  for (const char* scale : {"linear", "log"})
    for (const char* count : {"3", "4", "6", "7", "11", "49"}) {
      const auto range =
          numbers(along(R"({"parameter": "frame_latency_s", "from": 0.1, "to": 0.3, "count": )" +
                        std::string(count) + R"(, "scale": ")" + scale + "\"}"));
      EXPECT_EQ(range.front(), 0.1);
      EXPECT_EQ(range.back(), 0.3) << count << " " << scale;
    }
}

// Refinement halves the steps. The values of the first round stay the same, bit for bit.
TEST(Axes, RefinementKeepsTheFirstRound) {
  for (const char* scale : {"linear", "log"}) {
    const std::vector<std::string> axis = {std::string("axes.0.scale=") + scale, "axes.0.from=0.0007",
                                           "axes.0.count=7"};
    auto refined = axis;
    refined.insert(refined.end(), {"refine.budget=1000", "refine.levels=3"});
    const auto coarse = numbers(small(axis)), fine = numbers(small(refined));
    ASSERT_EQ(fine.size(), 49u);
    for (std::size_t i = 0; i < 7; ++i) EXPECT_EQ(fine[8 * i], coarse[i]) << scale;
    EXPECT_TRUE(std::is_sorted(fine.begin(), fine.end()));
  }
}

// A list may hold any values of a parameter: integers, switches, choices, vectors, whole parts.
TEST(Axes, CanListAnyValues) {
  const auto cells = [](const std::string& path, const std::string& values) {
    const Sweep sweep = along(R"({"parameter": ")" + path + R"(", "values": )" + values + "}", {"set={}"});
    const Json list = Json::parse(values);
    EXPECT_EQ(sweep.plan().cell_count(), list.size());
    for (std::size_t i = 0; i < list.size(); ++i) EXPECT_EQ(value_in(sweep, i, path), list[i]) << path;
    return sweep.plan().axes[0];
  };
  EXPECT_EQ(cells("renderer.steps_per_tick", "[30, 1, 7]").value_names.size(), 0u);
  EXPECT_EQ(std::get<std::vector<double>>(cells("renderer.xi", "[0.5, 0.1]").values),
            (std::vector{0.5, 0.1}));
  EXPECT_EQ(cells("renderer.step_rule", R"(["variable", "fixed"])").value_names,
            (std::vector<std::string>{"variable", "fixed"}));
  EXPECT_EQ(cells("renderer.velocity_estimate", "[true, false]").value_names,
            (std::vector<std::string>{"true", "false"}));
  EXPECT_EQ(cells("renderer.name", R"(["proxy"])").value_names, std::vector<std::string>{"proxy"});
  EXPECT_HAS(refusal([&] { cells("renderer.name", R"(["proxy", "tracked-sheet"])"); }),
             "axis renderer.name = \"tracked-sheet\": expected the axis renderer, with values like");
  EXPECT_EQ(cells("trajectory.start_m", "[[0, 0, 0], [0, 0, 0.25]]").value_names[1], "[0,0,0.25]");
  EXPECT_EQ(cells("seed", "[3, 18446744073709551615]").units, "1");
}

// A range may be used for a parameter that accepts only integers, if all its values are integers.
TEST(Axes, MustMeetIntegers) {
  const Sweep sweep = along(R"({"parameter": "seed", "from": 1, "to": 9, "count": 5})");
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(value_in(sweep, i, "seed"), 2 * i + 1);
  EXPECT_HAS(refusal([] { along(R"({"parameter": "seed", "from": 1, "to": 9, "count": 4})"); }),
             "cell 1: seed = 3.6");
}

TEST(Axes, AreNamedWithUnits) {
  const auto axis = [](const std::string& path) {
    return along(R"({"parameter": ")" + path + R"(", "from": 0.5, "to": 2, "count": 1})").plan().axes[0];
  };
  EXPECT_EQ(axis("renderer.stiffness_N_per_m").name, "stiffness_N_per_m");
  EXPECT_EQ(axis("renderer.stiffness_N_per_m").long_name, "renderer.stiffness_N_per_m");
  const std::pair<const char*, const char*> units[] = {{"renderer.stiffness_N_per_m", "N/m"},
                                                       {"renderer.damping_Ns_per_m", "N s/m"},
                                                       {"renderer.theta_deg", "deg"},
                                                       {"scenario.acceleration_m_per_s2", "m/s^2"},
                                                       {"scenario.start_velocity_m_per_s", "m/s"},
                                                       {"scenario.frame_rate_hz", "Hz"},
                                                       {"duration_s", "s"},
                                                       {"scenario.start_depth_m", "m"},
                                                       {"renderer.xi", "1"}};
  for (const auto& [path, unit] : units) EXPECT_EQ(axis(path).units, unit) << path;
}

TEST(Overrides, ReachTheSweepOrItsExperiment) {
  const Sweep sweep =
      small({"replicates=3", "axes.0.count=5", "title=other", "renderer.xi=0.25", "refine.budget=99"});
  const SweepResult plan = sweep.plan();
  EXPECT_EQ(sweep.title(), "other");
  EXPECT_EQ(plan.axes[0].length(), 5u);
  EXPECT_EQ(sweep.refinement()->budget, 99u);
  EXPECT_EQ(sweep.refinement()->first_replicates, 3);
  EXPECT_EQ(value_in(sweep, 4, "renderer.xi"), 0.25);
  // Settings of the command line are applied after those of the file.
  EXPECT_EQ(value_in(small({"haptic_rate_hz=800"}), 0, "haptic_rate_hz"), 800);
  EXPECT_EQ(value_in(small({"set={}"}), 0, "haptic_rate_hz"), 1000);
}

TEST(Titles, NameWhatWasChanged) {
  EXPECT_EQ(small().title(), "small");
  EXPECT_EQ(small({"axes.0.count=5", "renderer.xi=0.25"}).title(),
            "small, changed: axes.0.count=5, renderer.xi=0.25");
  EXPECT_EQ(small({"replicates=2"}).title(), "small");  // the value is unchanged
  const std::string stored = Experiment::load("fig4.12").settings().title;
  EXPECT_EQ(small({"title=", "renderer.xi=0.25"}).title(),
            stored +
                ", changed: haptic_rate_hz=900, renderer.steps_per_tick=1, renderer.xi=0.25, over "
                "scenario.noise_sigma_m and scenario.acceleration_m_per_s2");
}

// The trace of a cell then does not have the title of a run with other values.
TEST(Titles, TitlesOfRunsNameTheValuesOfTheirCell) {
  const std::string stored = Experiment::load("fig4.12").settings().title;
  EXPECT_EQ(value_in(small(), 5, "title"),
            stored +
                ", changed: haptic_rate_hz=900, renderer.steps_per_tick=1, "
                "scenario.noise_sigma_m=0.005, scenario.acceleration_m_per_s2=2");
  const Sweep again = Sweep::from_json(small().to_json(), "again");
  EXPECT_EQ(value_in(again, 5, "title"), value_in(small(), 5, "title"));
}

TEST(Refinement, HasItsRuleAndFirstRound) {
  EXPECT_FALSE(small().refinement().has_value());
  EXPECT_TRUE(small().plan().round.empty());
  const Sweep sweep =
      small({"refine.budget=50", "refine.levels=2", "refine.max_replicates=9", "refine.measure=mean_steps",
             "refine.threshold=3", R"(axes.1={"parameter": "seed", "values": [4, 5]})"});
  EXPECT_EQ(sweep.refinement()->strides, (std::vector<std::size_t>{4, 1}));
  EXPECT_EQ(sweep.refinement()->measure, "mean_steps");
  EXPECT_EQ(sweep.refinement()->threshold, 3);
  const SweepResult plan = sweep.plan();
  EXPECT_EQ(plan.run_count(), 9u * 2 * 9);
  for (std::size_t run = 0; run < plan.run_count(); ++run) {
    const bool is_first = plan.axis_indices(plan.cell_of(run))[0] % 4 == 0 && plan.replicate_of(run) < 2;
    EXPECT_EQ(plan.state[run], is_first ? RunState::pending : RunState::not_sampled);
    EXPECT_EQ(plan.round[run], is_first ? 0 : -1);
  }
}

}  // namespace
}  // namespace remote_touch::sweep_test
