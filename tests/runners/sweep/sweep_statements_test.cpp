// A sweep states what it runs: parts that overwrite each other are refused, and every run has the values that
// the file states for its cell.
#include "runners/sweep/sweep_statements.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "runners/sweep/cell_text.h"
#include "runners/sweep/sweep.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_statements_test {
namespace {

using Plain = nlohmann::json;
using Texts = std::vector<std::string>;

constexpr const char* kScenes =
    R"([{"name": "moving-lift", "acceleration_m_per_s2": 3}, {"name": "flat-grid"}])";

// {"parameter": path, "values": values}
std::string axis(const std::string& path, const std::string& values) {
  return R"({"parameter": ")" + path + R"(", "values": )" + values + "}";
}

Sweep sweep_over(const Texts& axes, const std::string& set = "{}", const Texts& overrides = {}) {
  std::string list;
  for (const std::string& one : axes) list += (list.empty() ? "" : ", ") + one;
  return Sweep::from_json(R"({"experiment": "fig4.12", "axes": [)" + list +
                              R"(], "measures": ["mean_steps"], "set": )" + set + "}",
                          "mine.json", overrides);
}
std::string why(const Texts& axes, const std::string& set = "{}", const Texts& overrides = {}) {
  return refusal([&] { sweep_over(axes, set, overrides); });
}
void expect_accepted(const Texts& axes, const std::string& set = "{}", const Texts& overrides = {}) {
  EXPECT_NO_THROW(sweep_over(axes, set, overrides)) << set;
}

const std::string kNoise = axis("scenario.noise_sigma_m", "[0, 0.001]");
const std::string kAcceleration = axis("scenario.acceleration_m_per_s2", "[1, 20]");
const std::string kScene = axis("scenario", kScenes);
const std::string kStart = axis("trajectory.start_m.1", "[0, 0.01]");

TEST(OverlappingAxes, AreRefusedWithBothPaths) {
  EXPECT_EQ(
      why({kAcceleration, kScene}),
      "mine.json: axes.1 scenario: overlaps axes.0 scenario.acceleration_m_per_s2: expected each parameter "
      "once, and none that contains another");
  EXPECT_HAS(why({kScene, kAcceleration}),
             "axes.1 scenario.acceleration_m_per_s2: overlaps axes.0 scenario: ");
  EXPECT_HAS(why({kNoise, kAcceleration, kNoise}),
             "axes.2 scenario.noise_sigma_m: overlaps axes.0 scenario.noise_sigma_m: ");
  const std::string starts = axis("trajectory.start_m", "[[0, 0, 0], [0, 0.01, 0]]");
  EXPECT_HAS(why({starts, kStart}), "axes.1 trajectory.start_m.1: overlaps axes.0 trajectory.start_m: ");
}

// Other spellings of one position are the same parameter.
TEST(OverlappingAxes, AreFoundByTheirPosition) {
  EXPECT_HAS(why({kStart, axis("trajectory.start_m.01", "[0.02]")}),
             "axes.1 trajectory.start_m.01: overlaps axes.0 trajectory.start_m.1: ");
  EXPECT_HAS(why({kScene}, R"({"scenario.columns.": 50})"),
             "set.scenario.columns.: is overwritten by the axis ");
}

TEST(OverlappingAxes, NamesThatBeginAlikeAreOthers) {
  expect_accepted({axis("scenario.rows", "[50, 60]"), axis("trajectory.start_m.1", "[0, 0.01]"),
                   axis("trajectory.start_m.0", "[0, 0.01]")});
}

TEST(OverwrittenValues, ValuesOfSetAreRefused) {
  EXPECT_EQ(why({kAcceleration}, R"({"scenario.acceleration_m_per_s2": 2})"),
            "mine.json: set.scenario.acceleration_m_per_s2: is overwritten by the axis "
            "scenario.acceleration_m_per_s2: expected one of them");
  EXPECT_HAS(why({kScene}, R"({"scenario.columns": 50})"),
             "set.scenario.columns: is overwritten by the axis ");
  // The object states one value, and the axis states others.
  EXPECT_HAS(why({kNoise}, R"({"scenario": {"name": "moving-lift", "noise_sigma_m": 0.002}})"),
             "set.scenario: is overwritten by the axis scenario.noise_sigma_m: ");
  // Null states that there are no faults.
  EXPECT_HAS(why({axis("faults.dropout_probability", "[0, 0.5]")}, R"({"faults": null})"),
             "set.faults: is overwritten by the axis faults.dropout_probability: ");
  EXPECT_HAS(why({kNoise}, R"({"scenario.columns": 50, "scenario": {"name": "moving-lift"}})"),
             "set.scenario.columns: is overwritten by set.scenario: ");
  EXPECT_HAS(why({kNoise}, R"({"scenario": {"name": "moving-lift", "columns": 60}, "scenario.columns": 50})"),
             "set.scenario: is overwritten by set.scenario.columns: ");
}

TEST(OverwrittenValues, ValuesOfTheCommandLineAreRefused) {
  EXPECT_EQ(
      why({kNoise}, "{}", {"scenario.noise_sigma_m=0.002"}),
      "--set scenario.noise_sigma_m=0.002: is overwritten by the axis scenario.noise_sigma_m: expected one "
      "of them");
  EXPECT_HAS(why({kScene}, "{}", {"scenario.columns=50"}),
             "--set scenario.columns=50: is overwritten by the axis scenario: ");
  EXPECT_HAS(why({kNoise}, "{}", {R"(scenario={"name": "moving-lift", "noise_sigma_m": 0})"}),
             "is overwritten by the axis scenario.noise_sigma_m: ");
  EXPECT_HAS(why({kNoise}, "{}", {R"(set={"scenario.noise_sigma_m": 0})"}),
             "mine.json: set.scenario.noise_sigma_m: is overwritten by the axis ");
}

// An object that --set gives would remove a value that the user has set.
TEST(OverwrittenValues, AreRefusedWhereTheObjectAroundThemIsReplaced) {
  const std::string object = R"(scenario={"name": "moving-lift"})";
  EXPECT_EQ(why({kAcceleration}, "{}", {"scenario.columns=50", object}),
            "--set scenario.columns=50: is overwritten by --set scenario: expected one of them");
  EXPECT_EQ(why({kAcceleration}, R"({"scenario.columns": 50})", {object}),
            "mine.json: set.scenario.columns: is overwritten by --set scenario: expected one of them");
  EXPECT_HAS(
      why({kAcceleration}, "{}", {"axes.0.values=[2]", R"(axes=[{"parameter": "seed", "values": [1]}])"}),
      "--set axes.0.values=[2]: is overwritten by --set axes: ");
}

// --set experiment.x changes the experiment before `set` and the axes do.
TEST(OverwrittenValues, ValuesOfTheOwnExperimentAreRefused) {
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

// An axis may replace a value of the experiment file, and --set may replace a value of `set`.
TEST(OverwrittenValues, OthersAreAccepted) {
  expect_accepted({kNoise}, R"({"scenario": {"name": "moving-lift", "columns": 50}})");
  expect_accepted({kNoise}, R"({"scenario": {"name": "moving-lift"}, "scenario.columns": 50})");
  expect_accepted({kNoise}, "{}", {R"(scenario={"name": "moving-lift"})", "scenario.columns=50"});
  expect_accepted({kNoise}, R"({"scenario.columns": 50})", {"scenario.columns=60"});
  expect_accepted({kNoise}, R"({"scenario.columns": 50})",
                  {R"(scenario={"name": "moving-lift", "columns": 50})"});
  expect_accepted({kNoise}, "{}", {"seed=3", "seed=4"});
  // A list cannot be given without the element that an axis changes.
  expect_accepted({kStart}, R"({"trajectory.start_m": [0.01, 0, 0]})");
  // An object in a list can be given without it.
  const std::string rules = R"({"fixtures": [{"name": "everywhere", "radius_m": 0.1}]})";
  expect_accepted({axis("fixtures.0.stiffness_N_per_m", "[100, 200]")}, rules);
  EXPECT_HAS(why({axis("fixtures.0.radius_m", "[0.1, 0.2]")}, rules),
             "set.fixtures: is overwritten by the axis ");
}

TEST(Statements, ARunWithAnotherValueIsRefused) {
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

// A change at 0 s is made before the first tick.
TEST(Statements, AnAxisThatAChangeOverwritesAtTheStartIsRefused) {
  const std::string stiffness = axis("renderer.stiffness_N_per_m", "[300, 500]");
  const auto at = [](const char* time_s) {
    return std::string(R"({"changes": [{"time_s": )") + time_s +
           R"(, "parameter": "renderer.stiffness_N_per_m", "value": 300}]})";
  };
  EXPECT_EQ(
      why({stiffness}, at("0")),
      "mine.json: cell 1: axis renderer.stiffness_N_per_m = 500: the run has 300.0: expected a value that "
      "nothing else changes");
  expect_accepted({stiffness}, at("0.1"));
  expect_accepted({axis("renderer.damping_Ns_per_m", "[0, 1]")}, at("0"));
  const std::string estimate =
      R"({"changes": [{"time_s": 0, "parameter": "renderer.velocity_estimate", "value": 0}]})";
  EXPECT_HAS(why({axis("renderer.velocity_estimate", "[false, true]")}, estimate),
             "cell 1: axis renderer.velocity_estimate = true: the run has false: ");
}

// A double would state another seed, or would state two seeds as one.
TEST(Statements, IntegersThatADoubleDoesNotHaveAreNames) {
  const SweepResult plan = sweep_over({axis("seed", "[9007199254740992, 9007199254740993, 3]")}).plan();
  EXPECT_EQ(plan.axes[0].value_names, (Texts{"9007199254740992", "9007199254740993", "3"}));
  EXPECT_EQ(cell_of({"--cell", "seed=9007199254740993"}, plan), 1u);
  EXPECT_EQ(cell_of({"--cell", "seed=3"}, plan), 2u);
  EXPECT_TRUE(sweep_over({axis("seed", "[9007199254740991, 3]")}).plan().axes[0].value_names.empty());
}

// Six digits are what a person types. A cell is not chosen where they name several.
TEST(Cells, ANumberThatNamesSeveralValuesIsRefused) {
  const SweepResult plan =
      sweep_over({axis("scenario.acceleration_m_per_s2", "[1.000001, 1, 2.0000001]")}).plan();
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

TEST(Cells, MayBeNamedByValuesWithCommas) {
  const std::string starts = axis("trajectory.start_m", "[[0, 0, 0], [0, 0.01, 0]]");
  const SweepResult plan = sweep_over({starts, axis("renderer.steps_per_tick", "[1, 2]")}).plan();
  const std::string start = "start_m=" + plan.axes[0].value_names.at(1);
  ASSERT_NE(start.find(','), std::string::npos) << start;
  EXPECT_EQ(cell_of({"--cell", start + ",steps_per_tick=1"}, plan), 2u);
  EXPECT_EQ(cell_of({"--cell", "steps_per_tick=2," + start}, plan), 3u);
  EXPECT_HAS(refusal([&] {
               cell_of({"--cell", start}, plan);
             }),
             "expected start_m=VALUE,steps_per_tick=VALUE");
  EXPECT_HAS(refusal([&] { cell_of({"--cell", start + ",other=1"}, plan); }), "expected for start_m one of ");
}

// `inspect` shows the earlier names in a result of schema /2.
TEST(Cells, ARefusalNamesWhatWasRenamed) {
  const SweepResult plan = sweep_over({axis("renderer.contact_motion", R"(["tangent-plane", "regions"])"),
                                       axis("trajectory.surface", R"(["newest-frame", "moving"])")})
                               .plan();
  const auto refused = [&](const std::string& text) {
    return refusal([&] { cell_of({"--cell", text}, plan); });
  };
  EXPECT_HAS(refused("contact_rule=tangent_plane,per_frame=true"),
             "expected contact_motion=VALUE,surface=VALUE; contact_rule is now contact_motion; per_frame is "
             "now surface");
  EXPECT_HAS(refused("contact_motion=tangent-plane,per_frame=true"), "; per_frame is now surface");
  EXPECT_HAS(refused("contact_motion=tangent-plane,surface=true"),
             "expected for surface one of newest-frame, moving; true is now newest-frame");
  EXPECT_TRUE(refused("contact_motion=regions").ends_with("expected contact_motion=VALUE,surface=VALUE"));
  EXPECT_EQ(cell_of({"--cell", "contact_motion=regions,surface=moving"}, plan), 3u);
}

TEST(Statements, OneNumberInTwoSpellingsComesTwice) {
  EXPECT_HAS(why({axis("scenario.noise_sigma_m", "[0, 0.0]")}),
             "axes.0.values: 0.0 appears twice: expected once");
  EXPECT_HAS(why({axis("trajectory.start_m.0", "[0.01, -0.0, 0]")}), "axes.0.values: 0 appears twice");
  EXPECT_HAS(why({axis("seed", R"([1, "1"])")}), "appears twice");
}

TEST(Statements, AResultWithOtherAxesOrMeasuresIsNotOfTheSweep) {
  const Sweep sweep = sweep_over({kNoise, kAcceleration});
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
}  // namespace remote_touch::sweep_statements_test
