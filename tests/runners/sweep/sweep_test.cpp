// The definition, axes and cells of a sweep. sweep_refusals_test.cpp has what is refused.
#include "runners/sweep/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runners/experiment/settings/json_parameters.h"
#include "runners/sweep/stored_sweep.h"
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

// Axes that set several parameters together: coupled parameters and variants.
constexpr const char* kRadii = R"({"name": "r_c", "parameters": ["renderer.r1_m", "renderer.r2_m"],
  "values": [[0.004, 0.0042], [0.005, 0.0052]]})";
constexpr const char* kVariants = R"({"name": "variant", "variants": [{"name": "as printed"},
  {"name": "slow", "set": {"renderer.steps_per_tick": 7, "renderer.xi": 0.25}},
  {"name": "other", "set": {"renderer": {"name": "proxy", "stiffness_N_per_m": 400}}}]})";
// Does not overlap kRadii.
constexpr const char* kSpeeds = R"({"name": "variant", "variants": [{"name": "as printed"},
  {"name": "slow", "set": {"renderer.steps_per_tick": 7}}, {"name": "other", "set": {"renderer.xi": 0.25}}]})";
constexpr const char* kNoise = R"({"parameter": "scenario.noise_sigma_m", "values": [0.001, 0.002]})";

Sweep over_radii_and_variants() {
  return Sweep::from_json(
      R"({"experiment": "fig4.12", "replicates": 2, "measures": ["mean_steps"], "axes": [)" +
          std::string(kRadii) + ", " + kSpeeds + "]}",
      "mine.json");
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

TEST(Sweeps, SurviveARoundTrip) {
  const std::vector<std::vector<std::string>> cases = {
      {},
      {"axes.0.scale=log", "axes.0.from=1e-3"},
      {R"(axes.0={"parameter": "renderer.step_rule", "values": ["fixed", "variable"]})"},
      {R"(axes.0={"parameter": "trajectory.start_m", "values": [[0, 0, 0], [0, 0, 0.01]]})"},
      {R"(axes.0={"parameter": "seed", "values": [18446744073709551615, 1]})"},
      {"refine.budget=50", "refine.levels=2", "refine.threshold=0.25"},
      {"replicates=7", "title=grün", "scenario.columns=150"},
      {"set={}", std::string("axes=[") + kRadii + ", " + kSpeeds + "]"},
      {R"(axes.1={"common_noise": false, )" + std::string(kVariants + 1), "set={}"}};
  for (const auto& overrides : cases) {
    const Sweep sweep = small(overrides), again = Sweep::from_json(sweep.to_json(), "again");
    EXPECT_EQ(again.to_json(), sweep.to_json());
    EXPECT_EQ(again.plan().state, sweep.plan().state);
    EXPECT_EQ(again.title(), sweep.title());
    EXPECT_NO_THROW(again.require_fits(sweep.plan(), "file"));
    for (std::size_t cell = 0; cell < sweep.plan().cell_count(); ++cell)
      EXPECT_EQ(again.experiment(cell, 1).to_json(), sweep.experiment(cell, 1).to_json()) << cell;
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

TEST(Overrides, ReachTheSweepOrItsExperiment) {
  const Sweep sweep = small({"replicates=3", "axes.0.count=5", "title=other", "renderer.xi=0.25",
                             "refine.budget=99", "refine.measure=mean_steps", "refine.threshold=3"});
  const SweepResult plan = sweep.plan();
  EXPECT_EQ(sweep.title(), "other");
  EXPECT_EQ(plan.axes[0].length(), 5u);
  EXPECT_EQ(sweep.refinement()->budget, 99u);
  EXPECT_EQ(sweep.refinement()->first_replicates, 3);
  EXPECT_EQ(sweep.refinement()->measure, "mean_steps");
  EXPECT_EQ(sweep.refinement()->threshold, 3);
  EXPECT_EQ(value_in(sweep, 4, "renderer.xi"), 0.25);
  // Settings of the command line are applied after those of the file.
  EXPECT_EQ(value_in(small({"haptic_rate_hz=800"}), 0, "haptic_rate_hz"), 800);
  EXPECT_EQ(value_in(small({"set={}"}), 0, "haptic_rate_hz"), 1000);
  EXPECT_FALSE(small().refinement().has_value());
  EXPECT_TRUE(small().plan().round.empty());
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
TEST(Titles, OfRunsNameTheValuesOfTheirCell) {
  const std::string stored = Experiment::load("fig4.12").settings().title;
  EXPECT_EQ(value_in(small(), 5, "title"),
            stored +
                ", changed: haptic_rate_hz=900, renderer.steps_per_tick=1, "
                "scenario.noise_sigma_m=0.005, scenario.acceleration_m_per_s2=2");
  const Sweep joint = over_radii_and_variants();
  EXPECT_TRUE(joint.title().ends_with(", over r_c and variant")) << joint.title();
  const std::string title = value_in(joint, 4, "title");
  EXPECT_TRUE(title.ends_with("changed: r_c=0.005, variant=slow")) << title;
}

// The steps of a range need not divide evenly: each value is one of the whole axis, to the last bit.
TEST(Sweeps, KeepEveryNthValueWhenThinned) {
  const Sweep listed =
      along(R"({"parameter": "scenario.noise_sigma_m", "values": [0, 1e-3, 2e-3, 3e-3, 4e-3]})");
  EXPECT_EQ(numbers(listed.thinned(3)), (std::vector<double>{0, 3e-3}));
  EXPECT_EQ(numbers(listed.thinned(9)), (std::vector<double>{0}));
  EXPECT_EQ(listed.thinned(1).to_json(), listed.to_json());
  EXPECT_EQ(small().thinned(2).plan().replicates, 2);
  for (const char* scale : {"linear", "log"}) {
    const Sweep range = along(R"({"parameter": "scenario.noise_sigma_m", "from": 1e-3, "to": 7e-3, "count": 8,
                                  "common_noise": true, "scale": ")" +
                              std::string(scale) + "\"}");
    const std::vector<double> all = numbers(range);
    EXPECT_EQ(numbers(range.thinned(3)), (std::vector<double>{all[0], all[3], all[6]}));
    EXPECT_HAS(range.thinned(3).to_json(), "common_noise");
  }
  const SweepResult joint = over_radii_and_variants().thinned(2).plan();
  EXPECT_EQ(joint.axes[0].length(), 1u);
  EXPECT_EQ(joint.axes[1].value_names, (std::vector<std::string>{"as printed", "other"}));
}

// A list may hold any values of a parameter: integers, switches, choices, vectors, whole parts. A range may
// be used for integers, if all its values are integers.
TEST(Axes, CanListAnyValues) {
  const auto names = [](const std::string& path, const std::string& values) {
    const Sweep sweep = along(R"({"parameter": ")" + path + R"(", "values": )" + values + "}", {"set={}"});
    const Json list = Json::parse(values);
    EXPECT_EQ(sweep.plan().cell_count(), list.size());
    for (std::size_t i = 0; i < list.size(); ++i) EXPECT_EQ(value_in(sweep, i, path), list[i]) << path;
    return sweep.plan().axes[0].value_names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(names("renderer.steps_per_tick", "[30, 1, 7]"), Names{});
  EXPECT_EQ(names("renderer.step_rule", R"(["variable", "fixed"])"), (Names{"variable", "fixed"}));
  EXPECT_EQ(names("renderer.velocity_estimate", "[true, false]"), (Names{"true", "false"}));
  EXPECT_EQ(names("renderer.name", R"(["proxy"])"), Names{"proxy"});
  EXPECT_EQ(names("trajectory.start_m", "[[0, 0, 0], [0, 0, 0.25]]"), (Names{"[0,0,0]", "[0,0,0.25]"}));
  const Sweep range = along(R"({"parameter": "seed", "from": 1, "to": 9, "count": 5})");
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(value_in(range, i, "seed"), 2 * i + 1);
}

TEST(Axes, HaveNamesAndUnits) {
  const auto axis = [](const std::string& path) {
    return read_axis({{"parameter", path}, {"values", {1, 2}}}, "test", 0).coordinate;
  };
  EXPECT_EQ(axis("renderer.stiffness_N_per_m").name, "stiffness_N_per_m");
  EXPECT_EQ(axis("renderer.stiffness_N_per_m").long_name, "renderer.stiffness_N_per_m");
  const std::pair<const char*, const char*> units[] = {{"renderer.stiffness_N_per_m", "N/m"},
                                                       {"renderer.damping_Ns_per_m", "N s/m"},
                                                       {"renderer.theta_deg", "deg"},
                                                       {"scenario.acceleration_m_per_s2", "m/s^2"},
                                                       {"scenario.start_velocity_m_per_s", "m/s"},
                                                       {"scenario.frame_rate_hz", "Hz"},
                                                       {"scenario.turbidity_per_m", "1/m"},
                                                       {"scenario.rate_per_min", "1/min"},
                                                       {"safety.max_force_N", "N"},
                                                       {"device.mass_kg", "kg"},
                                                       {"duration_s", "s"},
                                                       {"renderer.xi", "1"},
                                                       {"trajectory.poses.2.4", "deg"},
                                                       {"trajectory.poses.2.6", "s"},
                                                       {"trajectory.waypoints.0.3", "m/s"},
                                                       {"trajectory.waypoints.0.99", "1"},
                                                       {"scenario.centre_m.1", "m"}};
  for (const auto& [path, unit] : units) EXPECT_EQ(axis(path).units, unit) << path;
}

TEST(JointAxes, HaveACoordinateWithNameAndUnit) {
  const auto coordinate = [](const std::string& more) {
    return along("{" + more + std::string(kRadii + 1)).plan().axes.at(0);
  };
  const Column plain = coordinate("");
  EXPECT_EQ(plain.name, "r_c");
  EXPECT_EQ(plain.units, "m");
  EXPECT_EQ(plain.long_name, "renderer.r1_m, renderer.r2_m");
  EXPECT_EQ(std::get<std::vector<double>>(plain.values), (std::vector<double>{0.004, 0.005}));
  const Column labels = coordinate(R"("unit": "mm", "labels": [5, 10], )");
  EXPECT_EQ(labels.units, "mm");
  EXPECT_EQ(std::get<std::vector<double>>(labels.values), (std::vector<double>{5, 10}));
  EXPECT_EQ(coordinate(R"("labels": ["narrow", "wide"], )").value_names,
            (std::vector<std::string>{"narrow", "wide"}));
}

TEST(Variants, SetOnlyWhatTheyName) {
  const Sweep sweep = along(kVariants, {"set={}"});
  const Json printed = value_in(sweep, 0, "renderer");
  EXPECT_EQ(printed, value_in(along(kNoise, {"set={}"}), 0, "renderer"));
  Json slow = printed;
  slow["steps_per_tick"] = 7, slow["xi"] = 0.25;
  EXPECT_EQ(value_in(sweep, 1, "renderer"), slow);
  EXPECT_EQ(value_in(sweep, 2, "renderer.stiffness_N_per_m"), 400);
}

// Then a difference between two variants is not one between two noises.
TEST(Variants, HaveCommonNoiseUnlessToldOtherwise) {
  const auto cell = [](const std::string& axes, std::size_t i) {
    return value_in(along(axes, {"set={}"}), i, "cell");
  };
  const std::string both = std::string(kNoise) + ", ", common = both + kVariants;
  EXPECT_EQ(cell(common, 4), cell(common, 3));
  EXPECT_NE(cell(common, 3), cell(common, 0));
  EXPECT_EQ(value_in(along(common, {"set={}"}), 4, "replicate", 1), 1);
  EXPECT_EQ(cell(both + R"({"common_noise": false, )" + std::string(kVariants + 1), 4), 4);
  EXPECT_EQ(cell(R"({"common_noise": true, )" + std::string(kNoise + 1), 1), 0);
}

// A double would state another seed, or would state two seeds as one.
TEST(Cells, IntegersThatADoubleDoesNotHaveAreNames) {
  const auto plan = [](const std::string& seeds) {
    return along(R"({"parameter": "seed", "values": )" + seeds + "}").plan();
  };
  const SweepResult large = plan("[9007199254740992, 9007199254740993, 3]");
  EXPECT_EQ(large.axes[0].value_names,
            (std::vector<std::string>{"9007199254740992", "9007199254740993", "3"}));
  EXPECT_EQ(cell_of({"--cell", "seed=9007199254740993"}, large), 1u);
  EXPECT_EQ(cell_of({"--cell", "seed=3"}, large), 2u);
  EXPECT_TRUE(plan("[9007199254740991, 3]").axes[0].value_names.empty());
}

// Six digits are what a person types. A cell is not chosen where they name several.
TEST(Cells, ANumberThatNamesSeveralValuesIsRefused) {
  const SweepResult plan =
      along(R"({"parameter": "scenario.acceleration_m_per_s2", "values": [1.000001, 1, 2.0000001]})").plan();
  const auto cell = [&](const std::string& value) {
    return cell_of({"--cell", "acceleration_m_per_s2=" + value}, plan);
  };
  EXPECT_EQ(cell("1"), 1u);
  EXPECT_EQ(cell("1.0"), 1u);
  EXPECT_EQ(cell("1.000001"), 0u);
  EXPECT_EQ(cell("2"), 2u);
  EXPECT_EQ(refusal([&] { cell("1.0000001"); }),
            "--cell acceleration_m_per_s2=1.0000001: expected for acceleration_m_per_s2 a number with more "
            "digits, or the indices on the axes: 2 values are 1 with six digits");
}

TEST(Cells, MayBeNamedByCoordinatesAndByValuesWithCommas) {
  const SweepResult joint = over_radii_and_variants().plan();
  EXPECT_EQ(cell_of({"--cell", "r_c=0.005,variant=slow"}, joint), 4u);
  EXPECT_EQ(cell_of({"--cell", "variant=as printed,r_c=0.004"}, joint), 0u);
  const SweepResult plan = along(R"({"parameter": "trajectory.start_m", "values": [[0, 0, 0], [0, 0.01, 0]]},
                                    {"parameter": "renderer.xi", "values": [0.1, 0.2]})")
                               .plan();
  const std::string start = "start_m=" + plan.axes[0].value_names.at(1);
  ASSERT_NE(start.find(','), std::string::npos) << start;
  EXPECT_EQ(cell_of({"--cell", start + ",xi=0.1"}, plan), 2u);
  EXPECT_EQ(cell_of({"--cell", "xi=0.2," + start}, plan), 3u);
  EXPECT_HAS(refusal([&] { cell_of({"--cell", start + ",other=1"}, plan); }), "expected for start_m one of ");
}

}  // namespace
}  // namespace remote_touch::sweep_test
