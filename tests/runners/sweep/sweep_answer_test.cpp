#include "runners/sweep/sweep_answer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "runners/sweep/answer_text.h"
#include "runners/sweep/sweep.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_answer_test {
namespace {

std::string text_of(const Figure& answer, const SweepResult& result) {
  return answer_text(answer, result.runs_in(RunState::done).size(),
                     result.run_count() - result.runs_in(RunState::not_sampled).size());
}

constexpr int kRuns = 10;
constexpr const char* kConfig = R"({"title": "a sweep"})";

// A sweep over r_c (2), a method (2) and x (3). In one of ten runs more of each cell the proxy popped
// through: 3, 4, 5, ...
SweepResult sweep() {
  SweepResult result;
  result.axes = {{"r_c", "m", "", std::vector<double>{0.005, 0.01}},
                 {"method", "1", "", std::vector<std::int32_t>{0, 1}, 1, {"old", "new"}},
                 {"x", "m/s^2", "", std::vector<double>{1, 2, 3}}};
  result.replicates = kRuns;
  result.measures = {{"popped_through", "1", "", {}}, {"max_force", "N", "", {}}};
  result.start(false);
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    const std::size_t cell = result.cell_of(run);
    result.state[run] = RunState::done;
    std::get<std::vector<double>>(result.measures[0].values)[run] =
        result.replicate_of(run) < 3 + static_cast<int>(cell % 3) * 2 ? 1 : 0;
    std::get<std::vector<double>>(result.measures[1].values)[run] = static_cast<double>(run);
  }
  return result;
}

std::vector<std::string> tables(const SweepQuestion& question) {
  std::vector<std::string> names;
  for (const Table& table : sweep_answer(sweep(), kConfig, question).tables) names.push_back(table.name);
  return names;
}
std::string why(const SweepQuestion& question, const SweepResult& result = sweep()) {
  return refusal([&] { sweep_answer(result, kConfig, question); });
}

TEST(SweepAnswers, WithoutAQuestionHaveLimitsAndMeans) {
  const Figure answer = sweep_answer(sweep(), kConfig, {});
  EXPECT_EQ(answer.name, kAnswerName);
  EXPECT_EQ(answer.title, "a sweep");
  EXPECT_EQ(answer.tables.front().name, "limits");
  EXPECT_HAS(
      answer.caption,
      "the x at which popped_through is above 0.5 in 50 % of the runs. Along the axis the event becomes "
      "more probable.");
  const std::vector<std::string> names = tables({});
  for (const char* name : {"mean_popped_through", "mean_max_force"})
    EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
}

TEST(SweepAnswers, TheEventOfASlaveIsThatItTouched) {
  SweepResult result = sweep();
  result.measures[0].name = "slave_touched";
  EXPECT_EQ(default_event(result), "slave_touched");
  EXPECT_HAS(sweep_answer(result, kConfig, {}).caption, "the x at which slave_touched is above 0.5");
  result.measures[0].name = "slave_contact_fraction";
  EXPECT_EQ(default_event(result), "");
}

TEST(SweepAnswers, HaveWhatWasAsked) {
  SweepQuestion means;
  means.means = {"max_force"}, means.by = {"r_c"};
  EXPECT_EQ(tables(means).front(), "mean_max_force");
  SweepQuestion differences;
  differences.differences = {"max_force"};
  const Figure answer = sweep_answer(sweep(), kConfig, differences);
  EXPECT_EQ(answer.tables.front().name, "difference_max_force");
  EXPECT_HAS(answer.caption,
             "from method = old, in pairs of runs with the same replicate, whose noise is independent;");
}

// One panel with a curve for each method, over r_c.
TEST(SweepAnswers, DrawTheLimitOverTheFirstAxisOfNumbers) {
  SweepQuestion question;
  question.limit = "popped_through", question.along = "x";
  const Figure answer = sweep_answer(sweep(), kConfig, question);
  ASSERT_EQ(answer.panels.size(), 1u);
  const Panel& panel = answer.panels.front();
  EXPECT_EQ(panel.x_label, "r_c");
  EXPECT_EQ(panel.y_label, "limit");
  ASSERT_EQ(panel.curves.size(), 4u);
  EXPECT_EQ(panel.curves[0].style, CurveStyle::band);
  EXPECT_EQ(panel.curves[1].label, "method = old");
  EXPECT_EQ(panel.curves[3].label, "method = new");
  const Table& old = answer.tables[1];
  EXPECT_EQ(old.name, panel.curves[0].table);
  EXPECT_EQ(numbers(old, "r_c"), (std::vector<double>{0.005, 0.01}));
  EXPECT_EQ(numbers(old, "limit"), (std::vector<double>{2, 2}));
}

TEST(SweepAnswers, RefuseWhatTheSweepDoesNotHave) {
  SweepQuestion question;
  question.limit = "popped";
  EXPECT_EQ(why(question), "limit popped: expected one of popped_through, max_force");
  question.limit = "popped_through", question.along = "y";
  EXPECT_EQ(why(question), "along y: expected one of r_c, method, x");
  question.along = "method";
  EXPECT_EQ(why(question), "along method: expected an axis of at least two numbers");
  question.along = "x", question.level = 1;
  EXPECT_HAS(why(question), "expected a probability between 0 and 1");
  SweepQuestion differences;
  differences.differences = {"max_force"}, differences.between = "z";
  EXPECT_EQ(why(differences), "between z: expected one of r_c, method, x");
  SweepQuestion by;
  by.means = {"max_force"}, by.by = {"z"};
  EXPECT_EQ(why(by), "by z: expected one of r_c, method, x");
  SweepResult pending = sweep();
  for (RunState& state : pending.state) state = RunState::pending;
  EXPECT_EQ(why({}, pending), "the sweep: has no finished run: expected at least one");
}

TEST(SweepAnswers, RefuseOptionsWithoutEffect) {
  SweepQuestion between;
  between.means = {"max_force"}, between.between = "method";
  EXPECT_EQ(why(between), "between method: without effect: expected also a difference");
  SweepQuestion level;
  level.means = {"max_force"}, level.level = 0.9;
  EXPECT_HAS(why(level), "without effect: expected also a limit");
  SweepQuestion by;
  by.limit = "popped_through", by.by = {"r_c"};
  EXPECT_EQ(why(by), "by: without effect: expected also a mean or a difference");
}

// The names are those of the configuration.
TEST(SweepAnswers, TakeTheAxesWithCommonNoiseFromTheConfiguration) {
  SweepQuestion question;
  question.means = {"max_force"}, question.by = {"r_c", "x"};
  const auto runs = [&](const char* config) {
    const Table table = sweep_answer(sweep(), config, question).tables.front();
    return std::get<std::vector<std::int32_t>>(table.columns.back().values).front();
  };
  EXPECT_EQ(runs(R"({"axes": [{}, {"variants": []}, {}]})"), kRuns);
  EXPECT_EQ(runs(R"({"axes": [{}, {"common_noise": true}, {}]})"), kRuns);
  EXPECT_EQ(runs(R"({"axes": [{}, {"variants": [], "common_noise": false}, {}]})"), 2 * kRuns);
  EXPECT_EQ(runs("{}"), 2 * kRuns);
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

// A result with two columns of one name cannot be read. The list of refused names is in joint_axis.cpp.
TEST(SweepAnswers, AnAxisCannotHaveTheNameOfAColumn) {
  SweepQuestion question;
  question.limit = "popped_through", question.means = question.differences = {"max_force"};
  SweepResult noted = sweep();
  noted.note_kinds = {"no contact"}, noted.notes.assign(noted.run_count(), 0);
  std::set<std::string> columns;
  for (const Table& table : sweep_answer(noted, kConfig, question).tables)
    for (const Column& column : table.columns) columns.insert(column.name);
  for (const char* axis : {"r_c", "method", "x"}) columns.erase(axis);
  EXPECT_EQ(columns.size(), 14u);
  for (const std::string& name : columns)
    EXPECT_HAS(refusal([&] {
                 Sweep::from_json(R"({"experiment": "fig4.12", "axes": [{"name": ")" + name +
                                      R"(", "variants": [{"name": "a", "set": {"seed": 1}}]}]})",
                                  "mine.json");
               }),
               "a column of analyse has this name");
}

TEST(AnswerText, HasEachTableWithUnits) {
  SweepQuestion question;
  question.limit = "popped_through", question.along = "x";
  const Figure answer = sweep_answer(sweep(), kConfig, question);
  const std::string text = text_of(answer, sweep());
  EXPECT_HAS(text, "  r_c    method  limit  limit_low  limit_high  at_least  at_most  place   runs\n");
  EXPECT_HAS(text, "  m              m/s^2  m/s^2      m/s^2       m/s^2     m/s^2\n");
  EXPECT_HAS(text, "  0.005  old     2      ");
  EXPECT_EQ(text.find("limits_1"), std::string::npos);
}

TEST(AnswerText, SaysWhatIsLeftOut) {
  SweepResult part = sweep();
  part.state[0] = part.state[7] = RunState::failed;
  EXPECT_HAS(text_of(sweep_answer(part, kConfig, {}), part),
             "note: 2 of 120 runs are not finished and are left out");
  EXPECT_EQ(text_of(sweep_answer(sweep(), kConfig, {}), sweep()).find("note"), std::string::npos);
}

}  // namespace
}  // namespace remote_touch::sweep_answer_test
