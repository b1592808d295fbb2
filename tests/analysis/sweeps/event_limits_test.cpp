// Limits of an event along an axis, on results made by hand.
#include "analysis/sweeps/event_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "analysis/statistics/proportion.h"

namespace remote_touch::event_limits_test {
namespace {

constexpr int kRuns = 100;

// A sweep over two methods and these values of x; events[method][i] of 100 runs of a cell have the event.
SweepResult sweep_of(const std::vector<double>& x, const std::vector<std::vector<int>>& events) {
  SweepResult result;
  std::vector<std::int32_t> places;
  std::vector<std::string> names;
  for (std::size_t method = 0; method < events.size(); ++method)
    places.push_back(static_cast<std::int32_t>(method)), names.push_back("m" + std::to_string(method));
  result.axes = {{"method", "1", "", places, 1, names}, {"x", "m", "", x}};
  result.replicates = kRuns;
  result.measures = {{"event", "1", "", {}}};
  result.start(false);
  auto& values = std::get<std::vector<double>>(result.measures[0].values);
  for (std::size_t method = 0; method < events.size(); ++method)
    for (std::size_t i = 0; i < x.size(); ++i)
      for (int replicate = 0; replicate < kRuns; ++replicate) {
        const std::size_t run = result.run(result.cell_at({method, i}), replicate);
        result.state[run] = RunState::done;
        values[run] = replicate < events[method][i] ? 1 : 0;
      }
  return result;
}

Table limits_of(const SweepResult& result, double level = 0.5, double threshold = 0.5) {
  return event_limits(result, {"event", threshold, 1, level}).table;
}

std::string place(const Table& table, std::size_t row) {
  for (const Column& column : table.columns)
    if (column.name == "place")
      return column
          .value_names[static_cast<std::size_t>(std::get<std::vector<std::int32_t>>(column.values)[row])];
  return {};
}

TEST(EventLimits, AreWhereTheShareCrossesTheLevel) {
  const Table table = limits_of(sweep_of({1, 2, 4}, {{0, 25, 75}, {20, 60, 100}}));
  EXPECT_DOUBLE_EQ(numbers(table, "limit")[0], 3);
  EXPECT_DOUBLE_EQ(numbers(table, "limit")[1], 1.75);
  EXPECT_EQ(place(table, 0), "inside");
  EXPECT_DOUBLE_EQ(numbers(limits_of(sweep_of({1, 2, 4}, {{0, 25, 75}}), 0.1), "limit")[0], 1.4);
}

TEST(EventLimits, AnEventMayBecomeLessProbable) {
  const SweepResult result = sweep_of({1, 2, 4}, {{75, 25, 0}});
  EXPECT_FALSE(event_limits(result, {"event", 0.5, 1, 0.5}).rises);
  EXPECT_DOUBLE_EQ(numbers(limits_of(result), "limit")[0], 1.5);
  EXPECT_TRUE(event_limits(sweep_of({1, 2, 4}, {{0, 25, 75}}), {"event", 0.5, 1, 0.5}).rises);
}

// The share of events at the ends of the interval is that of Wilson: 25 of 100 and 75 of 100.
TEST(EventLimits, HaveTheIntervalOfTheWilsonCurves) {
  const Table table = limits_of(sweep_of({1, 2}, {{25, 75}}));
  const auto [low, high] = wilson_interval(25, kRuns);
  const auto [next_low, next_high] = wilson_interval(75, kRuns);
  EXPECT_NEAR(numbers(table, "limit_low")[0], 1 + (0.5 - high) / (next_high - high), 1e-12);
  EXPECT_NEAR(numbers(table, "limit_high")[0], 1 + (0.5 - low) / (next_low - low), 1e-12);
  EXPECT_LT(numbers(table, "limit_low")[0], numbers(table, "limit")[0]);
}

// The intervals of 25 and 75 of 100 runs with the event are off 0.5, those of 45 and 55 are not.
TEST(EventLimits, AreEnclosedByTheValuesThatDifferClearlyFromTheLevel) {
  const Table table =
      limits_of(sweep_of({1, 2, 4, 8}, {{0, 25, 75, 100}, {0, 45, 55, 100}, {40, 60, 80, 90}}));
  EXPECT_EQ(numbers(table, "at_least")[0], 2);
  EXPECT_EQ(numbers(table, "at_most")[0], 4);
  EXPECT_EQ(numbers(table, "at_least")[1], 1);
  EXPECT_EQ(numbers(table, "at_most")[1], 8);
  const Table falling = limits_of(sweep_of({1, 2, 4}, {{75, 25, 0}, {100, 55, 52}}));
  EXPECT_EQ(numbers(falling, "at_least")[0], 1);
  EXPECT_EQ(numbers(falling, "at_most")[0], 2);
  EXPECT_EQ(numbers(falling, "at_least")[1], 1);
  EXPECT_TRUE(std::isnan(numbers(falling, "at_most")[1]));
}

TEST(EventLimits, CountTheRunsWithANote) {
  SweepResult result = sweep_of({1, 2}, {{25, 75}});
  EXPECT_EQ(limits_of(result).columns.back().name, "runs");
  result.note_kinds = {"no contact"};
  result.notes.assign(result.run_count(), 0);
  result.notes[0] = result.notes[kRuns] = 1;
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(limits_of(result).columns.back().values),
            std::vector<std::int32_t>{2});
}

// The shares 0.4 and 0.2 are pooled to 0.3, because the event can only become more probable.
TEST(EventLimits, IgnoreAStepBack) {
  const Table table = limits_of(sweep_of({1, 2, 3, 4}, {{0, 40, 20, 70}}));
  EXPECT_DOUBLE_EQ(numbers(table, "limit")[0], 3.5);
}

TEST(EventLimits, OutsideTheValuesAreNotKnown) {
  const Table table = limits_of(sweep_of({1, 2}, {{0, 10}, {90, 100}, {0, 100}}));
  EXPECT_TRUE(std::isnan(numbers(table, "limit")[0]));
  EXPECT_EQ(place(table, 0), "above the last value");
  EXPECT_TRUE(std::isnan(numbers(table, "limit")[1]));
  EXPECT_EQ(place(table, 1), "below the first value");
  EXPECT_EQ(place(table, 2), "inside");
}

TEST(EventLimits, ARowThatChangesTheOtherWayHasNone) {
  const Table table = limits_of(sweep_of({1, 2, 3}, {{0, 50, 100}, {0, 50, 100}, {100, 100, 0}}));
  EXPECT_EQ(place(table, 0), "inside");
  EXPECT_EQ(place(table, 2), "changes the other way");
  EXPECT_TRUE(std::isnan(numbers(table, "limit")[2]));
}

TEST(EventLimits, ALevelThatIsReachedExactlyIsInside) {
  EXPECT_DOUBLE_EQ(numbers(limits_of(sweep_of({1, 2}, {{0, 90}}), 0.9), "limit")[0], 2);
  EXPECT_DOUBLE_EQ(numbers(limits_of(sweep_of({1, 2}, {{70, 100}}), 0.7), "limit")[0], 1);
}

TEST(EventLimits, DoNotDependOnTheOrderOfTheValues) {
  const Table sorted = limits_of(sweep_of({1, 2, 4}, {{0, 25, 75}}));
  const Table mixed = limits_of(sweep_of({4, 1, 2}, {{75, 0, 25}}));
  EXPECT_EQ(numbers(mixed, "limit"), numbers(sorted, "limit"));
  EXPECT_EQ(numbers(mixed, "limit_high"), numbers(sorted, "limit_high"));
}

TEST(EventLimits, UseFinishedRunsOnly) {
  SweepResult result = sweep_of({1, 2, 4}, {{0, 25, 75}});
  for (int replicate = 0; replicate < kRuns; ++replicate)
    result.state[result.run(result.cell_at({0, 1}), replicate)] = RunState::failed;
  const Table table = limits_of(result);
  EXPECT_DOUBLE_EQ(numbers(table, "limit")[0], 3);  // between 1 and 4
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(table.columns.back().values)[0], 2 * kRuns);
  for (RunState& state : result.state) state = RunState::pending;
  EXPECT_EQ(place(limits_of(result), 0), "no runs");
}

// The last value of the axis has no runs, so it is not known whether the limit is above it.
TEST(EventLimits, AreNotSaidToBeOutsideAnAxisWhoseEndHasNoRuns) {
  SweepResult result = sweep_of({1, 2, 4}, {{0, 0, 100}, {0, 0, 0}});
  for (int replicate = 0; replicate < kRuns; ++replicate)
    result.state[result.run(result.cell_at({0, 2}), replicate)] = RunState::pending;
  EXPECT_EQ(place(limits_of(result), 0), "above the values with runs");
  EXPECT_EQ(place(limits_of(result), 1), "above the last value");
  result = sweep_of({1, 2, 4}, {{0, 100, 100}, {0, 50, 100}});
  for (int replicate = 0; replicate < kRuns; ++replicate)
    result.state[result.run(result.cell_at({0, 0}), replicate)] = RunState::pending;
  EXPECT_EQ(place(limits_of(result), 0), "below the values with runs");
}

TEST(EventLimits, AnEventIsAMeasureAboveTheThreshold) {
  SweepResult result = sweep_of({1, 2}, {{0, 100}});
  for (double& value : std::get<std::vector<double>>(result.measures[0].values)) value = 3 + 2 * value;
  EXPECT_DOUBLE_EQ(numbers(limits_of(result, 0.5, 4), "limit")[0], 1.5);
  EXPECT_EQ(place(limits_of(result, 0.5, 6), 0), "above the last value");
}

TEST(EventLimits, HaveTheValuesOfTheOtherAxes) {
  const Table table = limits_of(sweep_of({1, 2}, {{0, 100}, {0, 100}}));
  EXPECT_EQ(table.columns[0].name, "method");
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(table.columns[0].values), (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(table.columns[0].value_names[1], "m1");
  EXPECT_EQ(table.columns[1].units, "m");
}

}  // namespace
}  // namespace remote_touch::event_limits_test
