// Answers of questions about a sweep: tables, captions, curves and text.
#include "runners/sweep/sweep_answer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "runners/sweep/sweep.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_answer_test {
namespace {

std::string text_of(const Figure& answer, const SweepResult& result) {
  return answer_text(answer, result.runs_in(RunState::done).size(),
                     result.run_count() - result.runs_in(RunState::not_sampled).size());
}

constexpr int kRuns = 10;
// The configuration of a sweep over x and a method that pools x; `more` belongs to the axis of x.
std::string config_over_x(const std::string& experiment, const std::string& more = "") {
  return R"({"title": "a sweep", "experiment": {"scenario": {"name": "flat-grid", "noise_sigma_m": 0.001}, "renderer": {"name": "penalty"},
    "trajectory": {"name": "waypoints", "waypoints": [[0, 0.05, 0, 0]]}, "duration_s": 0.02)" +
         experiment + R"(}, "axes": [{"parameter": "scenario.spacing_m", "values": [0.005, 0.01]},
    {"name": "method", "variants": [{"name": "old"}, {"name": "new", "set": {"renderer.stiffness_N_per_m": 500}}]},
    {"parameter": "haptic_rate_hz", "values": [500, 600, 700])" +
         more + "}]}";
}
const std::string kConfig = config_over_x("");

// A sweep over r_c (2), a method (2) and x (3). In 1, 5 and 9 of ten runs of the cells over x the proxy
// popped through.
SweepResult sweep() {
  SweepResult result;
  result.axes = {{"r_c", "m", "", std::vector<double>{0.005, 0.01}},
                 {"method", "1", "", std::vector<std::int32_t>{0, 1}, 1, {"old", "new"}},
                 {"x", "m/s^2", "", std::vector<double>{1, 2, 3}}};
  result.replicates = kRuns;
  result.measures = {{"popped_through", "1", "1 when the proxy popped through", {}},
                     {"max_force", "N", "", {}}};
  result.start(false);
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    const std::size_t cell = result.cell_of(run);
    result.state[run] = RunState::done;
    std::get<std::vector<double>>(result.measures[0].values)[run] =
        result.replicate_of(run) < 1 + static_cast<int>(cell % 3) * 4 ? 1 : 0;
    std::get<std::vector<double>>(result.measures[1].values)[run] = static_cast<double>(run);
  }
  return result;
}

std::string why(const SweepQuestion& question, const SweepResult& result = sweep()) {
  return refusal([&] { sweep_answer(result, kConfig, question); });
}

TEST(SweepAnswers, TheEventOfASlaveIsThatItTouched) {
  SweepResult result = sweep();
  result.measures[0].name = "slave_touched";
  EXPECT_EQ(default_event(result), "slave_touched");
  EXPECT_HAS(sweep_answer(result, kConfig, {}).caption, "the x at which slave_touched is above 0.5");
  result.measures[0].long_name = "fraction of ticks with a force on the slave";
  EXPECT_EQ(default_event(result), "");
}

// One panel with a curve for each method, over r_c.
TEST(SweepAnswers, DrawTheLimitOverTheFirstAxisOfNumbers) {
  SweepQuestion question;
  question.limit = "popped_through", question.along = "x";
  const Figure answer = sweep_answer(sweep(), kConfig, question);
  ASSERT_EQ(answer.panels.size(), 1u);
  const Panel& panel = answer.panels.front();
  EXPECT_EQ(panel.x_label, "r_c");
  EXPECT_EQ(panel.y_label, "x");
  ASSERT_EQ(panel.curves.size(), 4u);
  EXPECT_EQ(panel.curves[0].style, CurveStyle::intervals);
  EXPECT_EQ(panel.curves[1].label, "method = old");
  EXPECT_EQ(panel.curves[3].label, "method = new");
  const Table& old = answer.tables[1];
  EXPECT_EQ(old.name, panel.curves[0].table);
  EXPECT_EQ(numbers(old, "r_c"), (std::vector<double>{0.005, 0.01}));
  EXPECT_EQ(numbers(old, "value"), (std::vector<double>{2, 2}));
}

TEST(SweepAnswers, RefuseWhatTheSweepDoesNotHaveAndOptionsWithoutEffect) {
  const std::pair<void (*)(SweepQuestion&), const char*> cases[] = {
      {[](auto& q) { q.limit = "popped"; }, "limit popped: expected one of popped_through, max_force"},
      {[](auto& q) { q.limit = "popped_through", q.along = "y"; }, "along y: expected one of r_c, method, x"},
      {[](auto& q) { q.limit = "popped_through", q.along = "method"; },
       "along method: expected an axis of at least two numbers"},
      {[](auto& q) { q.limit = "popped_through", q.level = 1; }, "expected a probability between 0 and 1"},
      {[](auto& q) { q.limit = "popped_through", q.threshold = std::nan(""); },
       "above: expected a finite number"},
      {[](auto& q) { q.differences = {"max_force"}, q.between = "z"; },
       "between z: expected one of r_c, method, x"},
      {[](auto& q) { q.means = {"max_force"}, q.by = {"z"}; }, "by z: expected one of r_c, method, x"},
      {[](auto& q) { q.means = {"max_force"}, q.between = "method"; },
       "between method: without effect: expected also a difference or a limit"},
      {[](auto& q) { q.means = {"max_force"}, q.level = 0.9; }, "without effect: expected also a limit"},
      {[](auto& q) { q.limit = "popped_through", q.by = {"r_c"}; },
       "by: without effect: expected also a mean or a difference"}};
  for (const auto& [change, text] : cases) {
    SweepQuestion question;
    change(question);
    EXPECT_HAS(why(question), text);
  }
  SweepResult pending = sweep();
  for (RunState& state : pending.state) state = RunState::pending;
  EXPECT_EQ(why({}, pending), "the sweep: has no finished run: expected at least one");
}

// The column `runs` of the first table.
std::vector<std::int32_t> runs_of(const std::string& config, const SweepQuestion& question) {
  const Table table = sweep_answer(sweep(), config, question).tables.front();
  for (const Column& column : table.columns)
    if (column.name == "runs") return std::get<std::vector<std::int32_t>>(column.values);
  return {-1};
}

// Runs that share random numbers by the configuration count as one: those of common noise, those of one
// replicate if there is a registration error, equal runs, and, if the configuration says nothing, all that
// might.
TEST(SweepAnswers, CountIndependentRunsByTheConfiguration) {
  const std::string slave = R"(, "slave": {"natural_frequency_hz": 10}, "feedback": {"force": "none"})";
  const std::string registered = slave + R"(, "registration": {"offset_m": 0.01})";
  SweepQuestion question;
  question.means = {"max_force"}, question.by = {"method"};
  const auto runs = [&](const std::string& config) { return runs_of(config, question).front(); };
  EXPECT_EQ(runs(config_over_x("")), 6 * kRuns);
  EXPECT_EQ(runs(config_over_x("", R"(, "common_noise": true)")), 2 * kRuns);
  EXPECT_EQ(runs(config_over_x(registered)), kRuns);
  EXPECT_EQ(runs(config_over_x(registered, R"(, "common_noise": true)")), kRuns);
  std::string silent = config_over_x("");
  silent.replace(silent.find("0.001"), 5, "0");
  EXPECT_EQ(runs(silent), 6);  // one for each cell
  EXPECT_EQ(runs("{}"), kRuns);
  EXPECT_HAS(sweep_answer(sweep(), "{}", question).caption, "does not tell which runs share random numbers");
}

std::string replaced(std::string text, const std::string& part, const std::string& by) {
  return text.replace(text.find(part), part.size(), by);
}

// A seed is its value, wherever it is set: the noise of two seeds is independent, that of one is shared.
TEST(SweepAnswers, CountSeedsByTheirValue) {
  SweepQuestion question;
  question.means = {"max_force"};
  const auto runs = [&](const std::string& config, const char* by) {
    question.by = {by};
    return runs_of(config, question).front();
  };
  const std::string registered = config_over_x(R"(, "slave": {"natural_frequency_hz": 10},
    "feedback": {"force": "none"}, "registration": {"offset_m": 0.01})");
  const auto cases = [&](const std::string& values) {
    return replaced(registered, R"("parameter": "scenario.spacing_m", "values": [0.005, 0.01])",
                    R"("name": "case", "parameters": ["seed", "scenario.spacing_m"],
                       "labels": [1, 2], "values": )" +
                        values);
  };
  EXPECT_EQ(runs(cases("[[5, 0.005], [5, 0.01]]"), "method"), kRuns);
  EXPECT_EQ(runs(cases("[[5, 0.005], [6, 0.01]]"), "method"), 2 * kRuns);
  const std::string seeds = replaced(kConfig, R"({"name": "old"})", R"({"name": "old", "set": {"seed": 7}})");
  EXPECT_EQ(runs(kConfig, "r_c"), 3 * kRuns);
  EXPECT_EQ(runs(seeds, "r_c"), 6 * kRuns);
  question.differences = {"max_force"}, question.between = "method";
  EXPECT_HAS(sweep_answer(sweep(), kConfig, question).caption, "the same noise");
  EXPECT_HAS(sweep_answer(sweep(), seeds, question).caption, "whose noise is independent");
}

// The rounding of the disparity may be all of a sensor's noise: then its runs are equal.
TEST(SweepAnswers, ASensorThatOnlyRoundsDrawsNothing) {
  const std::string scene = replaced(kConfig, R"({"name": "flat-grid", "noise_sigma_m": 0.001})", R"({
    "name": "mesh-scene", "mesh": "block", "mesh_size_m": 0.2, "sensor": "active-stereo"})");
  const std::string sensor = replaced(scene, R"("scenario.spacing_m", "values": [0.005, 0.01])",
                                      R"("scenario.disparity_step_px", "values": [0.5, 0.01])");
  SweepQuestion question;
  question.means = {"max_force"}, question.by = {"r_c"};
  EXPECT_EQ(runs_of(sensor, question), (std::vector<std::int32_t>{6, 3 * kRuns}));
}

// A statement on what the runs of a pair share holds for all pairs: the first cell may draw nothing.
TEST(SweepAnswers, TellWhatPairsShare) {
  SweepQuestion question;
  question.differences = {"max_force"}, question.between = "x";
  const auto caption = [&](std::string config, const char* first_axis) {
    const std::string spacing = R"("scenario.spacing_m", "values": [0.005, 0.01])";
    config.replace(config.find(spacing), spacing.size(), first_axis);
    config.replace(config.find("0.001"), 5, "0");
    return sweep_answer(sweep(), config, question).caption;
  };
  const std::string registered =
      R"(, "slave": {"natural_frequency_hz": 10}, "feedback": {"force": "none"}, "registration": {"offset_m": 0})";
  EXPECT_HAS(caption(kConfig, R"("scenario.noise_sigma_m", "values": [0, 0.002])"),
             "whose noise is independent.");
  EXPECT_HAS(caption(kConfig, R"("scenario.spacing_m", "values": [0.005, 0.02])"),
             "which draw no random number.");
  EXPECT_HAS(caption(config_over_x(registered), R"("registration.offset_m", "values": [0, 0.002])"),
             "some of which share random numbers.");
}

// All tests of one command are one family.
TEST(SweepAnswers, AdjustAllTestsTogether) {
  SweepQuestion question;
  question.limit = "popped_through", question.along = "x", question.between = "method";
  question.differences = {"max_force", "popped_through"};
  const Figure answer = sweep_answer(sweep(), config_over_x(""), question);
  EXPECT_HAS(answer.caption, "over all 14 tests of this answer");
  std::vector<std::string> names;
  for (const Table& table : answer.tables) names.push_back(table.name);
  for (const char* name : {"limit_difference", "limit_ratio"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
}

// Without a direction a method whose runs are all equal still has its marks.
TEST(SweepAnswers, DrawMethodsThatAreNeverLost) {
  SweepResult result = sweep();
  for (double& value : std::get<std::vector<double>>(result.measures[0].values)) value = 0;
  SweepQuestion question;
  question.limit = "popped_through", question.along = "x";
  const Figure answer = sweep_answer(result, config_over_x(""), question);
  ASSERT_EQ(answer.panels.size(), 1u);
  const std::vector<Curve>& curves = answer.panels.front().curves;
  ASSERT_EQ(curves.size(), 4u);
  EXPECT_EQ(curves[1].label, "method = old: none of the runs");
  EXPECT_EQ(curves[3].label, "method = new: none of the runs");
}

// A limit that is never reached is a mark at the end of the axis, with a legend entry.
TEST(SweepAnswers, DrawLimitsThatAreBeyondTheAxis) {
  SweepResult result = sweep();
  auto& values = std::get<std::vector<double>>(result.measures[0].values);
  for (std::size_t run = 0; run < result.run_count(); ++run)
    if (result.axis_indices(result.cell_of(run))[1] == 1) values[run] = 0;  // "new" is never lost
  SweepQuestion question;
  question.limit = "popped_through", question.along = "x";
  const Figure answer = sweep_answer(result, config_over_x(""), question);
  const std::vector<Curve>& curves = answer.panels.front().curves;
  ASSERT_EQ(curves.size(), 4u);
  EXPECT_EQ(curves[3].label, "method = new: above the last value");
  EXPECT_EQ(curves[2].style, CurveStyle::intervals);
  for (const Table& table : answer.tables) {
    if (table.name != curves[3].table) continue;
    EXPECT_EQ(numbers(table, "value"), (std::vector<double>{3, 3}));
  }
}

// The means of sweep() over axes with so many values of r_c, method and x.
Figure means_over(int radii, int methods, int values, const std::vector<std::string>& by = {}) {
  SweepResult result = sweep();
  std::vector<double> r_c, x;
  for (int i = 0; i < radii; ++i) r_c.push_back(0.001 * (i + 1));
  for (int i = 0; i < values; ++i) x.push_back(i);
  result.axes[0].values = r_c, result.axes[2].values = x;
  std::vector<std::int32_t> method(methods);
  for (int i = 0; i < methods; ++i) method[i] = i;
  result.axes[1].values = method, result.axes[1].value_names.clear();
  for (int i = 0; i < methods; ++i) result.axes[1].value_names.push_back("m" + std::to_string(i));
  result.start(false);
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    result.state[run] = RunState::done;
    for (Column& measure : result.measures) std::get<std::vector<double>>(measure.values)[run] = run % 2;
  }
  SweepQuestion question;
  question.means = {"max_force"}, question.by = by;
  return sweep_answer(result, kConfig, question);
}

// More than eight curves: another axis is across, or has a panel for each value, or the first eight are
// drawn.
TEST(SweepAnswers, DrawManyCurves) {
  const Figure longest = means_over(2, 2, 9);
  ASSERT_EQ(longest.panels.size(), 1u);
  EXPECT_EQ(longest.panels[0].x_label, "x");
  EXPECT_EQ(longest.panels[0].curves.size(), 2 * 4u);
  const Figure multiples = means_over(3, 5, 4);
  ASSERT_EQ(multiples.panels.size(), 3u);
  EXPECT_HAS(multiples.panels[1].title, ": r_c = 0.002 m");
  EXPECT_EQ(multiples.panels[1].curves.size(), 2 * 5u);
  EXPECT_EQ(multiples.panels[1].curves[1].label, "method = m0");
  const Figure first = means_over(2, 9, 1, {"r_c", "method"});
  ASSERT_EQ(first.panels.size(), 1u);
  EXPECT_EQ(first.panels[0].curves.size(), 2 * 8u);
  EXPECT_HAS(first.panels[0].title, ", the first 8 of 9 curves");
  EXPECT_HAS(first.caption, "The panel of mean_max_force has the first 8 of 9 curves; the table has all. ");
  std::set<std::string> tables;
  for (const Table& table : multiples.tables) EXPECT_TRUE(tables.insert(table.name).second) << table.name;
}

TEST(SweepAnswers, DrawMeansOfMethodsAsDots) {
  const Figure answer = means_over(2, 3, 2, {"method"});
  ASSERT_EQ(answer.panels.size(), 1u);
  ASSERT_EQ(answer.panels[0].curves.size(), 2u);
  EXPECT_EQ(answer.panels[0].curves[1].style, CurveStyle::dots);
  EXPECT_EQ(answer.tables.back().columns[0].value_names, (std::vector<std::string>{"m0", "m1", "m2"}));
}

TEST(SweepAnswers, CurvesOfLikeLookingValuesAreTwo) {
  SweepResult result = sweep();
  result.axes[1] = {"seed", "1", "", std::vector<double>{10000001, 10000002}};
  SweepQuestion question;
  question.limit = "popped_through", question.along = "x";
  const Figure answer = sweep_answer(result, kConfig, question);
  ASSERT_EQ(answer.panels.front().curves.size(), 4u);
  EXPECT_EQ(answer.panels.front().curves[3].label, "seed = 10000002");
  EXPECT_HAS(text_of(answer, result), "10000002");
}

// A result with two columns of one name cannot be read: the column of the answer gives way.
TEST(SweepAnswers, AnAxisMayHaveTheNameOfAColumn) {
  SweepQuestion question;
  question.limit = "popped_through", question.means = question.differences = {"max_force"};
  question.along = "x";
  for (const char* taken : {"value", "low", "runs", "method", "p", "note", "place"}) {
    SweepResult result = sweep();
    result.axes[1].name = taken;
    for (const Table& table : sweep_answer(result, kConfig, question).tables) {
      std::set<std::string> names;
      for (const Column& column : table.columns) EXPECT_TRUE(names.insert(column.name).second) << column.name;
    }
  }
}

TEST(AnswerText, HasEachTableWithUnits) {
  SweepQuestion question;
  question.limit = "popped_through", question.along = "x";
  const Figure answer = sweep_answer(sweep(), kConfig, question);
  const std::string text = text_of(answer, sweep());
  EXPECT_HAS(text, "    r_c  method  value    low   high  runs  unknown  method_of_answer  note");
  EXPECT_HAS(text, "      m          m/s^2  m/s^2  m/s^2\n");
  EXPECT_HAS(text, "  0.005  old         2  ");
  EXPECT_EQ(text.find("limits_1"), std::string::npos);
}

// `inspect` reads an outline, which has no runs.
TEST(StreamsOf, DoubtsAnOutlineWhoseConfigurationCannotBeRead) {
  SweepResult outline = sweep();
  outline.state.clear();
  for (Column& measure : outline.measures) measure.values = std::vector<double>{};
  const CellStreams streams = streams_of(outline, "{}");
  EXPECT_FALSE(streams.doubt.empty());
  EXPECT_FALSE(streams.is_fixed(0));
}

}  // namespace
}  // namespace remote_touch::sweep_answer_test
