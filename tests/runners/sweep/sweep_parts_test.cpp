#include "runners/sweep/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runners/sweep/stored_sweep.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_parts_test {
namespace {

// The part of a sweep that a process runs.

// 12 cells of 2 replicates.
Sweep twelve(const std::vector<std::string>& overrides = {}) {
  return Sweep::from_json(R"({"experiment": "fig4.12", "replicates": 2,
    "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.01, "count": 3},
             {"parameter": "renderer.steps_per_tick", "values": [1, 2, 3, 30]}]})",
                          "twelve.json", overrides);
}

// Every run of the first round is in one shard, with all replicates of its cell, and shards differ by one
// cell at most. A shard holds no other run.
TEST(Shards, ShareTheCells) {
  for (const Sweep& sweep : {twelve(), twelve({"refine.budget=99", "refine.levels=1"})})
    for (const int count : {2, 3, 7, 20}) {
      const SweepResult whole = sweep.plan();
      std::vector<int> owners(whole.run_count(), 0);
      std::size_t min_count = whole.run_count(), max = 0;
      for (int index = 1; index <= count; ++index) {
        const SweepResult part = sweep.plan({index, count});
        ASSERT_TRUE(part.part);
        EXPECT_EQ(part.run_count(), whole.run_count());
        EXPECT_EQ(part.runs_in(RunState::pending).size(), part.held_count());
        for (std::size_t place = 0; place < part.held_count(); ++place) {
          const std::size_t run = part.run_at(place);
          ++owners[run];
          EXPECT_EQ(part.place_of(run), place);
          for (int replicate = 0; replicate < 2; ++replicate)
            EXPECT_TRUE(part.place_of(part.run(part.cell_of(run), replicate)));
        }
        min_count = std::min(min_count, part.held_count()), max = std::max(max, part.held_count());
      }
      for (std::size_t run = 0; run < owners.size(); ++run)
        EXPECT_EQ(owners[run], whole.state[run] == RunState::pending ? 1 : 0);
      EXPECT_LE(max - min_count, 2u);  // replicates of one cell
    }
}

TEST(Shards, TheOnlyOneIsWhole) {
  const SweepResult whole = twelve().plan({1, 1});
  EXPECT_FALSE(whole.part);
  EXPECT_EQ(whole.runs_in(RunState::pending).size(), 24u);
}

// All 1e11 runs would need 6 TB; a shard needs what its own runs need.
TEST(Shards, OfALargeSweepHoldTheirOwnRunsOnly) {
  const std::string noise =
      R"(axes=[{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.01, "count": 100000})";
  const std::string steps =
      R"(, {"parameter": "renderer.steps_per_tick", "from": 1, "to": 100, "count": 100}])";
  const Sweep sweep = twelve({noise + steps, "replicates=10000"});
  const SweepResult part = sweep.plan({3, 1000000});
  EXPECT_EQ(part.run_count(), 100000000000u);
  EXPECT_EQ(part.held_count(), 100000u);
  EXPECT_EQ(part.run_at(0), 20000u) << "cell 2";
  EXPECT_EQ(part.run_at(99999), 90000029999u) << "cell 9 * 1000000 + 2";
  EXPECT_HAS(refusal([&] {
               sweep.plan({1, 1000});
             }),
             "100000000 runs in one file: expected at most 10000000");
  EXPECT_HAS(refusal([&] { sweep.plan(); }), "100000000000 runs in one file: expected at most 10000000");
  const std::string seeds = R"(, {"parameter": "seed", "from": 1, "to": 100000, "count": 100000})";
  EXPECT_HAS(refusal([&] {
               twelve({noise + seeds + steps, "replicates=10000"});
             }),
             "more than 1000000000000000 runs");
  EXPECT_HAS(refusal([&] {
               twelve({noise + seeds + "]", "replicates=1"});
             }),
             "more than 4294967296 cells: expected");
}

TEST(Shards, OfAMergedFileAreWrittenAsRanges) {
  const auto text_of = [](const std::string& text) { return parse_shards(text, "a.h5").text(); };
  EXPECT_EQ(text_of("2/7"), "2/7");
  EXPECT_EQ(text_of("1-3,7/1000"), "1-3,7/1000");
  EXPECT_EQ(text_of("7,2,1,3/9"), "1-3,7/9");
  EXPECT_EQ(text_of("1-4/4"), "1-4/4");
  for (const char* text : {"", "/", "3", "1-/3", "-2/3", "0-2/3", "2-4/3", "1,,2/3", "1-2", "a-b/3", "1/3/5"})
    EXPECT_HAS(refusal([&] { parse_shards(text, "a.h5"); }),
               std::string("a.h5: shard ") + text + ": expected i/N");
}

TEST(Shards, AreWrittenAsIndexOfCount) {
  EXPECT_EQ(parse_shard("2/7").index, 2);
  EXPECT_EQ(parse_shard("2/7").count, 7);
  EXPECT_EQ(parse_shard("1/1").text(), "1/1");
  for (const char* text : {"", "/", "3", "1/", "/3", "0/3", "4/3", "-1/3", "1/-3", "1/0", "a/b", "1/3/5",
                           " 1/3", "1/3 ", "+1/3", "1.0/3", "1/1000001", "99999999999/99999999999"}) {
    const std::string why = refusal([&] { parse_shard(text); });
    EXPECT_HAS(why, std::string("--shard ") + text + ": expected i/N");
  }
}

std::string from_environment(const std::vector<std::pair<const char*, const char*>>& variables) {
  const auto value_of = [&](const std::string& name) -> const char* {
    for (const auto& [known, value] : variables)
      if (name == known) return value;
    return nullptr;
  };
  std::string shard = "none";
  const std::string why = refusal([&] {
    if (const auto found = shard_from_environment(value_of)) shard = found->text();
  });
  return why == "no InputError" ? shard : why;
}

TEST(Shards, AreThoseOfSlurmOrMpirun) {
  const char *id = "SLURM_ARRAY_TASK_ID", *count = "SLURM_ARRAY_TASK_COUNT", *min = "SLURM_ARRAY_TASK_MIN",
             *step = "SLURM_ARRAY_TASK_STEP", *rank = "OMPI_COMM_WORLD_RANK", *size = "OMPI_COMM_WORLD_SIZE";
  EXPECT_EQ(from_environment({}), "none");
  EXPECT_EQ(from_environment({{id, "2"}, {count, "3"}, {min, "1"}, {step, "1"}}), "2/3");
  EXPECT_EQ(from_environment({{id, "0"}, {count, "3"}}), "1/3");  // --array=0-2
  EXPECT_EQ(from_environment({{id, "14"}, {count, "3"}, {min, "10"}, {step, "2"}}),
            "3/3");  // --array=10-14:2
  EXPECT_EQ(from_environment({{rank, "0"}, {size, "4"}}), "1/4");
  EXPECT_EQ(from_environment({{rank, "3"}, {size, "4"}}), "4/4");
  EXPECT_EQ(from_environment({{id, "1"}, {count, "2"}, {min, "1"}, {rank, "3"}, {size, "4"}}), "1/2");
  EXPECT_EQ(from_environment({{rank, "3"}}), "none");
  EXPECT_EQ(from_environment({{id, ""}, {count, ""}, {rank, ""}, {size, "4"}}), "none");  // empty is not set
  EXPECT_HAS(from_environment({{id, "two"}, {count, "3"}}), "SLURM_ARRAY_TASK_ID = two: expected integers");
  EXPECT_HAS(from_environment({{id, "-1"}, {count, "3"}}), "SLURM_ARRAY_TASK_ID = -1: expected");
  EXPECT_HAS(from_environment({{id, "7"}, {count, "3"}, {min, "1"}}),
             "SLURM_ARRAY_TASK_ID = 7: expected i/N");
  EXPECT_HAS(from_environment({{rank, "4"}, {size, "4"}}), "OMPI_COMM_WORLD_RANK = 4: expected i/N");
  EXPECT_HAS(from_environment({{rank, "1"}, {size, "1.5"}}), "OMPI_COMM_WORLD_SIZE = 1.5: expected integers");
}

// The cells of a sweep that are checked, and those of its first round.

SweepResult grid(const std::vector<std::size_t>& lengths) {
  SweepResult result;
  for (const std::size_t length : lengths)
    result.axes.push_back({"axis", "1", "an axis", std::vector<double>(length)});
  return result;
}

TEST(CheckedCells, AreAllOfASmallGrid) {
  std::vector<std::size_t> all(6 * 7);
  std::iota(all.begin(), all.end(), std::size_t{0});
  EXPECT_EQ(checked_cells(grid({6, 7})), all);
  EXPECT_EQ(checked_cells(grid({100, 200})).size(), 20000u);
}

// The least gap between neighbours of 20000 spread cells of 1e9 is 50000.
TEST(CheckedCells, OfALargeGridAreSpreadAndHaveEachValue) {
  const SweepResult large = grid({10000, 100, 1000});
  const std::vector<std::size_t> cells = checked_cells(large);
  EXPECT_LE(cells.size(), 20000u + 11100u);
  EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
  EXPECT_EQ(cells.front(), 0u);
  EXPECT_EQ(cells.back(), 999999999u);
  std::vector<std::set<std::size_t>> seen(3);
  for (const std::size_t cell : cells)
    for (std::size_t axis = 0; axis < 3; ++axis) seen[axis].insert(large.axis_indices(cell)[axis]);
  EXPECT_EQ(seen[0].size(), 10000u);
  EXPECT_EQ(seen[1].size(), 100u);
  EXPECT_EQ(seen[2].size(), 1000u);
  for (std::size_t i = 1; i < cells.size(); ++i) EXPECT_LE(cells[i] - cells[i - 1], 50000u);
}

std::vector<SweepAxis> axes(const std::vector<std::pair<std::size_t, std::size_t>>& length_and_stride) {
  std::vector<SweepAxis> all;
  for (const auto& [length, stride] : length_and_stride) {
    SweepAxis axis;
    axis.settings.resize(length), axis.stride = stride;
    all.push_back(axis);
  }
  return all;
}

TEST(FirstRound, HasTheCellsWhoseIndicesAreMultiplesOfTheStrides) {
  const SweepResult result = grid({5, 3, 9});
  const std::vector<SweepAxis> refined = axes({{5, 4}, {3, 1}, {9, 2}});
  std::vector<std::size_t> expected, found;
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell) {
    const std::vector<std::size_t> at = result.axis_indices(cell);
    if (at[0] % 4 == 0 && at[2] % 2 == 0) expected.push_back(cell);
  }
  const FirstRound first(result, refined);
  for (std::size_t i = 0; i < first.count(); ++i) found.push_back(first.cell(i));
  EXPECT_EQ(found, expected);
}

// A sweep states what it runs: parts that overwrite each other are refused, and every run has the values that
// the file states for its cell.

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
}  // namespace remote_touch::sweep_parts_test
