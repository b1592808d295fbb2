#include "analysis/scorecard/threshold_summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analysis/scorecard/card_numbers.h"

namespace remote_touch::threshold_summary_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A sweep of two replicates at each of the noise levels 0 and 5 mm, or of four runs with the scene's own
// noise.
SweepResult jumps(const std::vector<double>& held, const std::vector<double>& jump, bool own_noise = false) {
  SweepResult result;
  const std::vector<double> levels = own_noise ? std::vector<double>{1} : std::vector<double>{0, 0.005};
  result.axes = {{"noise_sigma_m", "m", "", levels}};
  result.replicates = static_cast<int>(held.size() / levels.size());
  result.measures = {{"held", "1", "", {}}, {"max_relative_jump", "1", "", {}}};
  result.start(false);
  result.measures[0].values = held, result.measures[1].values = jump;
  for (RunState& state : result.state) state = RunState::done;
  return result;
}

const std::vector<std::pair<std::string, Better>> kJump = {{"max_relative_jump", Better::neither}};

SceneScore scene_of(const std::vector<SweepResult>& sweeps, bool own_noise = false,
                    const std::vector<std::pair<std::string, Better>>& measures = kJump) {
  return score({"scene", "", "", {{"held", 1}}, measures}, sweeps, own_noise);
}

Scorecard card_of(const std::vector<SceneScore>& scenes) {
  return {{"one", "two"}, {"", ""}, scenes};
}

TEST(ThresholdSummary, CountsSuccessfulRunsBelowTheThreshold) {
  // One jump of method one is at the threshold; method two fails in the two runs with noise.
  const SceneScore scene =
      scene_of({jumps({1, 1, 1, 1}, {0.01, 0.2, 0.0699, 0.07}), jumps({1, 1, 0, 0}, {0.3, 0.4, 0, 0})});
  const auto list = threshold_summary(card_of({scene}));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_STREQ(list[0].threshold.measure, "max_relative_jump");
  const ThresholdCounts &one = list[0].methods[0], &two = list[0].methods[1];
  EXPECT_EQ(one.below, 1);
  EXPECT_EQ(one.runs, 2);
  EXPECT_EQ(one.noise_free_below, 1);
  EXPECT_EQ(one.noise_free_runs, 2);
  EXPECT_EQ(one.scenes, 1);
  EXPECT_EQ(two.below, 0);
  EXPECT_EQ(two.runs, 0);
  EXPECT_EQ(two.noise_free_below, 0);
  EXPECT_EQ(two.noise_free_runs, 2);
  EXPECT_EQ(two.scenes, 0);
}

TEST(ThresholdSummary, RunsWithoutAValueDoNotCount) {
  const SceneScore scene =
      scene_of({jumps({1, 1, 1, 1}, {kNan, 0.2, 0.01, kNan}), jumps({1, 1, 1, 1}, {kNan, kNan, kNan, kNan})});
  const auto list = threshold_summary(card_of({scene}));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].methods[0].below, 1);
  EXPECT_EQ(list[0].methods[0].runs, 1);
  EXPECT_EQ(list[0].methods[0].noise_free_runs, 1);
  EXPECT_EQ(list[0].methods[1].runs, 0);
  EXPECT_EQ(list[0].methods[1].noise_free_runs, 0);
}

TEST(ThresholdSummary, EqualRunsWithoutNoiseCountOnce) {
  const SweepResult equal = jumps({1, 1, 1, 1}, {0.01, 0.01, 0.01, 0.02});
  const auto list = threshold_summary(card_of({scene_of({equal, equal})}));
  EXPECT_EQ(list.at(0).methods[0].noise_free_runs, 1);
  EXPECT_EQ(list[0].methods[0].runs, 2);
}

TEST(ThresholdSummary, AddsAllScenesThatReportTheMeasure) {
  const SweepResult some = jumps({1, 1, 1, 1}, {0.2, 0.3, 0.01, 0.09});
  const SceneScore silent = scene_of({some, some}, false, {{"held", Better::neither}});
  const SweepResult own_noise = jumps({1, 1, 1, 1}, {0.2, 0.3, 0.01, 0.09}, true);
  const SceneScore own = scene_of({own_noise, own_noise}, true);
  const auto list = threshold_summary(card_of({scene_of({some, some}), silent, own}));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].methods[1].scenes, 2);
  EXPECT_EQ(list[0].methods[1].below, 2);
  EXPECT_EQ(list[0].methods[1].runs, 2 + 4);
  EXPECT_EQ(list[0].methods[1].noise_free_runs, 2);
  EXPECT_TRUE(threshold_summary(card_of({silent})).empty());
}

TEST(ThresholdsTable, HasARowForEachThresholdAndMethod) {
  const SweepResult some = jumps({1, 1, 1, 1}, {0.2, 0.3, 0.01, 0.09});
  const Table table = thresholds_table(card_of({scene_of({some, some})}));
  EXPECT_EQ(table.name, "thresholds");
  EXPECT_EQ(values_of<std::vector<std::string>>(table, "method"), (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(values_of<std::vector<double>>(table, "threshold"), (std::vector<double>{0.07, 0.07}));
  EXPECT_EQ(values_of<std::vector<std::int32_t>>(table, "below"), (std::vector<std::int32_t>{1, 1}));
  EXPECT_EQ(values_of<std::vector<std::int32_t>>(table, "runs"), (std::vector<std::int32_t>{2, 2}));
  EXPECT_EQ(values_of<std::vector<std::int32_t>>(table, "noise_free_runs"),
            (std::vector<std::int32_t>{2, 2}));
  for (const Column& column : thresholds_table(card_of({})).columns) EXPECT_EQ(column.length(), 0u);
}

}  // namespace
}  // namespace remote_touch::threshold_summary_test
