#include "analysis/sweeps/sweep_means.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/interval_estimates.h"

// Means and paired differences of a sweep, on results made by hand.
namespace remote_touch::sweep_means_test {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Two values of x and two methods, the second running fastest; values[cell] has the measure of each
// replicate.
SweepResult sweep_of(const std::vector<std::vector<double>>& values, const std::string& unit = "m",
                     const std::string& meaning = "depth of it") {
  SweepResult result;
  result.axes = {{"x", "m", "", std::vector<double>{0.1, 0.2}},
                 {"method", "1", "", std::vector<std::int32_t>{0, 1}, 1, {"old", "new"}}};
  result.replicates = static_cast<int>(values.front().size());
  result.measures = {{"depth", unit, meaning, {}}};
  result.start(false);
  auto& all = std::get<std::vector<double>>(result.measures[0].values);
  for (std::size_t cell = 0; cell < values.size(); ++cell)
    for (int replicate = 0; replicate < result.replicates; ++replicate) {
      result.state[result.run(cell, replicate)] = RunState::done;
      all[result.run(cell, replicate)] = values[cell][static_cast<std::size_t>(replicate)];
    }
  return result;
}

// Each cell has its own noise; or the two methods have the same; or all cells share a stream of the
// replicate; or the first value of x is fixed.
const CellStreams kOwn = independent_streams(4);
CellStreams changed_streams(const std::function<void(CellStreams&)>& change) {
  CellStreams streams = kOwn;
  change(streams);
  return streams;
}
const CellStreams kCommonMethods = changed_streams([](CellStreams& s) { s.noise_cell = {0, 0, 2, 2}; });
const CellStreams kRegistered = changed_streams([](CellStreams& s) {
  for (RandomStreams& draws : s.draws) draws.of_replicate = true;
});
const CellStreams kFixed = changed_streams([](CellStreams& s) { s.draws[0] = s.draws[1] = {}; });

std::vector<std::int32_t> counts(const Table& table, const char* name) {
  for (const Column& column : table.columns)
    if (column.name == name) return std::get<std::vector<std::int32_t>>(column.values);
  return {};
}

// The 97.5 % point of Student's t with 2 degrees of freedom is 4.30265, with 4 it is 2.77645.
TEST(SweepMeans, HaveStudentsIntervalOfEachCell) {
  const Table table =
      sweep_means(sweep_of({{1, 2, 3}, {5, 5, 5}, {0, 4, 8}, {1, 1, 4}}), "depth", {0, 1}, kOwn);
  EXPECT_EQ(numbers(table, "value"), (std::vector<double>{2, 5, 4, 2}));
  EXPECT_NEAR(numbers(table, "high")[0], 2 + 4.30265 / std::sqrt(3.0), 1e-5);
  EXPECT_NEAR(numbers(table, "low")[2], 4 - 4 * 4.30265 / std::sqrt(3.0), 1e-4);
  EXPECT_TRUE(std::isnan(numbers(table, "low")[1]));  // no scatter
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{0.1, 0.1, 0.2, 0.2}));
  EXPECT_EQ(counts(table, "runs"), (std::vector<std::int32_t>{3, 3, 3, 3}));
}

// The scatter is that within the cells, not that between them.
TEST(SweepMeans, PoolTheAxesThatAreNotNamed) {
  const Table table =
      sweep_means(sweep_of({{1, 2, 3}, {11, 12, 13}, {0, 0, 0}, {0, 0, 0}}), "depth", {0}, kOwn);
  EXPECT_EQ(numbers(table, "value")[0], 7);
  EXPECT_NEAR(numbers(table, "high")[0], 7 + 2.77645 / std::sqrt(6.0), 1e-5);  // 4 degrees: no Hall
  EXPECT_EQ(counts(table, "runs")[0], 6);
  const Table whole =
      sweep_means(sweep_of({{1, 2, 3}, {11, 12, 13}, {0, 0, 0}, {0, 0, 0}}), "depth", {}, kOwn);
  EXPECT_EQ(numbers(whole, "value"), (std::vector<double>{3.5}));
}

TEST(SweepMeans, OfAnEventHaveTheExactInterval) {
  const Table table = sweep_means(
      sweep_of({{0, 1, 1, 1}, {0, 0, 0, 0}, {1, 1, 1, 1}, {0, 1, 0, kUnknown}}, "1", "1 when it happened"),
      "depth", {0, 1}, kOwn);
  const auto [low, high] = exact_interval(3, 4);
  EXPECT_EQ(numbers(table, "value")[0], 0.75);
  EXPECT_EQ(numbers(table, "low")[0], low);
  EXPECT_EQ(numbers(table, "high")[0], high);
  EXPECT_DOUBLE_EQ(numbers(table, "value")[3], 1.0 / 3);
  EXPECT_EQ(numbers(table, "high")[3], exact_interval(2, 4).second);
  EXPECT_EQ(counts(table, "unknown"), (std::vector<std::int32_t>{0, 0, 0, 1}));
}

// Runs that share the stream of their replicate are one, whichever cells are pooled; equal runs of a fixed
// cell are one, and certain.
TEST(SweepMeans, CountSharedAndEqualRunsOnce) {
  const SweepResult result = sweep_of({{1, 2, 3}, {3, 4, 5}, {1, 2, 3}, {3, 4, 5}});
  const Table shared = sweep_means(result, "depth", {}, kRegistered);
  EXPECT_EQ(counts(shared, "runs")[0], 3);
  EXPECT_EQ(numbers(shared, "value")[0], 3);
  EXPECT_NEAR(numbers(shared, "high")[0], 3 + 4.30265 / std::sqrt(3.0), 1e-5);  // of 2, 3, 4
  const SweepResult equal = sweep_of({{2, 2, 2}, {4, 4, 4}, {1, 2, 3}, {3, 4, 5}});
  const Table fixed = sweep_means(equal, "depth", {0}, kFixed);
  EXPECT_EQ(numbers(fixed, "value")[0], 3);
  EXPECT_TRUE(std::isnan(numbers(fixed, "low")[0]) && std::isnan(numbers(fixed, "high")[0]));
  EXPECT_EQ(counts(fixed, "runs"), (std::vector<std::int32_t>{2, 6}));
  EXPECT_EQ(std::get<std::vector<std::string>>(fixed.columns.back().values)[0], "6 equal runs count as 2");
  const Table difference = sweep_differences(equal, "depth", 1, {0}, kFixed);
  EXPECT_EQ(numbers(difference, "value")[0], 2);
  EXPECT_TRUE(std::isnan(numbers(difference, "p")[0]) && std::isnan(numbers(difference, "low")[0]));
  EXPECT_EQ(counts(difference, "runs")[0], 1);
}

TEST(SweepMeans, LeaveOutWhatHasNoValue) {
  SweepResult result = sweep_of({{1, 2, kUnknown}, {kUnknown, kUnknown, kUnknown}, {4, 6, 8}, {1, 1, 4}});
  result.state[result.run(2, 0)] = RunState::failed;
  const Table table = sweep_means(result, "depth", {0, 1}, kOwn);
  EXPECT_EQ(numbers(table, "value")[0], 1.5);
  EXPECT_TRUE(std::isnan(numbers(table, "value")[1]));
  EXPECT_EQ(numbers(table, "value")[2], 7);
  EXPECT_EQ(counts(table, "runs"), (std::vector<std::int32_t>{2, 0, 2, 3}));
  EXPECT_EQ(counts(table, "unknown"), (std::vector<std::int32_t>{1, 3, 0, 0}));
}

// A force that is 0 in every run is no event: its interval is not one of a proportion.
TEST(SweepMeans, OfZerosHaveNoScatter) {
  const Table table = sweep_means(sweep_of({{0, 0}, {0, 0}, {0, 1}, {1, 1}}), "depth", {0, 1}, kOwn);
  EXPECT_TRUE(std::isnan(numbers(table, "high")[0]));
  EXPECT_GT(numbers(table, "high")[2], 1);
}

// Two methods with the same noise are not two samples of it.
TEST(SweepMeans, RunsWithCommonNoiseCountAsOne) {
  const SweepResult result = sweep_of({{1, 2, 3}, {3, 4, 5}, {0, 0, 0}, {0, 0, 0}});
  const Table table = sweep_means(result, "depth", {0}, kCommonMethods);
  EXPECT_EQ(numbers(table, "value")[0], 3);
  EXPECT_NEAR(numbers(table, "high")[0], 3 + 4.30265 / std::sqrt(3.0), 1e-5);  // of 2, 3, 4
  EXPECT_EQ(counts(table, "runs")[0], 3);
  EXPECT_EQ(counts(sweep_means(result, "depth", {0}, kOwn), "runs")[0], 6);
}

TEST(SweepDifferences, PairsWithCommonNoiseCountAsOne) {
  const SweepResult result = sweep_of({{1, 2, 3}, {3, 4, 5}, {2, 4, 6}, {6, 8, 10}});
  const Table table = sweep_differences(result, "depth", 0, {}, kCommonMethods);
  EXPECT_EQ(counts(table, "runs")[0], 3);
  EXPECT_EQ(numbers(table, "value")[0], 3);  // of 2, 3, 4
  EXPECT_NEAR(numbers(table, "high")[0], 3 + 4.30265 / std::sqrt(3.0), 1e-5);
}

TEST(SweepDifferences, RowsWithoutPairsAreNotAdjusted) {
  SweepResult result =
      sweep_of({{0, 0, 0, 0, 0, 1}, {1, 1, 1, 1, 0, 1}, {0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}}, "1",
               "1 when it happened");
  for (int replicate = 0; replicate < 6; ++replicate)
    result.state[result.run(2, replicate)] = RunState::failed;
  const Table table = sweep_differences(result, "depth", 1, {0}, kOwn);
  EXPECT_EQ(numbers(table, "adjusted_p")[0], 0.125);
  EXPECT_TRUE(std::isnan(numbers(table, "p")[1]) && std::isnan(numbers(table, "adjusted_p")[1]));
}

TEST(SweepDifferences, AreThoseOfPairs) {
  const SweepResult result = sweep_of({{1, 2, 3}, {2, 4, 3}, {10, 20, 30}, {11, 21, 31}});
  const Table table = sweep_differences(result, "depth", 1, {0}, kOwn);
  EXPECT_EQ(numbers(table, "value"), (std::vector<double>{1, 1}));
  EXPECT_EQ(counts(table, "runs"), (std::vector<std::int32_t>{3, 3}));
  EXPECT_NEAR(numbers(table, "high")[0], 1 + 4.30265 / std::sqrt(3.0), 1e-5);
  EXPECT_TRUE(
      std::isnan(numbers(table, "high")[1]));       // the pairs differ alike, although their values scatter
  EXPECT_TRUE(std::isnan(numbers(table, "p")[0]));  // no test of three pairs reaches 0.05
  EXPECT_EQ(table.columns[1].name, "method");
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(table.columns[1].values), (std::vector<std::int32_t>{1, 1}));
}

TEST(SweepDifferences, OfAnEventCountThePairsThatDiffer) {
  const SweepResult result =
      sweep_of({{0, 0, 0, 0, 0, 1}, {1, 1, 1, 1, 0, 1}, {0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}}, "1",
               "1 when it happened");
  const Table table = sweep_differences(result, "depth", 1, {0}, kOwn);
  EXPECT_DOUBLE_EQ(numbers(table, "value")[0], 4.0 / 6);
  EXPECT_EQ(numbers(table, "low")[0], 0);    // p is above 0.05
  EXPECT_EQ(numbers(table, "p")[0], 0.125);  // 2 / 2^4
  EXPECT_EQ(numbers(table, "adjusted_p")[0], 0.25);
  EXPECT_EQ(numbers(table, "p")[1], 1);
}

TEST(SweepDifferences, SkipPairsOfWhichOneHasNoValue) {
  SweepResult result = sweep_of({{1, 2, 3}, {2, kUnknown, 3}, {0, 0, 2}, {1, 1, 2}});
  result.state[result.run(2, 2)] = RunState::failed;
  const Table table = sweep_differences(result, "depth", 1, {0}, kOwn);
  EXPECT_EQ(counts(table, "runs"), (std::vector<std::int32_t>{2, 2}));
  EXPECT_EQ(numbers(table, "value"), (std::vector<double>{0.5, 1}));
}

// A tally may have more runs than an integer of 32 bits counts.
TEST(SweepMeans, CountMoreThanTwoBillionRuns) {
  EXPECT_EQ(counts_in_column({1, 2147483647}), Values(std::vector<std::int32_t>{1, 2147483647}));
  EXPECT_EQ(counts_in_column({1, 3000000000}), Values(std::vector<double>{1, 3e9}));
}

}  // namespace
}  // namespace remote_touch::sweep_means_test

namespace remote_touch::event_limits_test {
namespace {

// Limits of an event along an axis, on results made by hand.

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
  return event_limits(result, {"event", threshold, 1, level}, independent_streams(result.cell_count())).table;
}

std::optional<bool> direction(const SweepResult& result) {
  return event_limits(result, {"event", 0.5, 1, 0.5}, independent_streams(result.cell_count())).rises;
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
  EXPECT_DOUBLE_EQ(numbers(table, "value")[0], 3);
  EXPECT_DOUBLE_EQ(numbers(table, "value")[1], 1.75);
  EXPECT_EQ(place(table, 0), "inside");
  EXPECT_DOUBLE_EQ(numbers(limits_of(sweep_of({1, 2, 4}, {{0, 25, 75}}), 0.1), "value")[0], 1.4);
}

TEST(EventLimits, AnEventMayBecomeLessProbable) {
  const SweepResult result = sweep_of({1, 2, 4}, {{75, 25, 0}});
  EXPECT_EQ(direction(result), false);
  EXPECT_DOUBLE_EQ(numbers(limits_of(result), "value")[0], 1.5);
  EXPECT_EQ(direction(sweep_of({1, 2, 4}, {{0, 25, 75}})), true);
}

// The intervals of 25 and 75 of 100 runs with the event are off 0.5, those of 45 and 55 are not.
TEST(EventLimits, AreEnclosedByTheValuesThatDifferClearlyFromTheLevel) {
  const Table table =
      limits_of(sweep_of({1, 2, 4, 8}, {{0, 25, 75, 100}, {0, 45, 55, 100}, {40, 60, 80, 90}}));
  EXPECT_EQ(numbers(table, "low")[0], 2);
  EXPECT_EQ(numbers(table, "high")[0], 4);
  EXPECT_EQ(numbers(table, "low")[1], 1);
  EXPECT_EQ(numbers(table, "high")[1], 8);
  const Table falling = limits_of(sweep_of({1, 2, 4}, {{75, 25, 0}, {100, 55, 52}}));
  EXPECT_EQ(numbers(falling, "low")[0], 1);
  EXPECT_EQ(numbers(falling, "high")[0], 2);
  EXPECT_EQ(numbers(falling, "low")[1], 1);
  EXPECT_TRUE(std::isnan(numbers(falling, "high")[1]));
}

std::vector<std::int32_t> counts(const Table& table, const std::string& name) {
  for (const Column& column : table.columns)
    if (column.name == name) return std::get<std::vector<std::int32_t>>(column.values);
  return {};
}

TEST(EventLimits, CountTheRunsWithANote) {
  SweepResult result = sweep_of({1, 2}, {{25, 75}});
  EXPECT_TRUE(counts(limits_of(result), "noted_runs").empty());
  result.note_kinds = {"no contact"};
  result.notes.assign(result.run_count(), 0);
  result.notes[0] = result.notes[kRuns] = 1;
  EXPECT_EQ(counts(limits_of(result), "noted_runs"), std::vector<std::int32_t>{2});
}

// No run, every run, or a single run has the event: nothing shows a direction, and a stated one is obeyed.
TEST(EventLimits, HaveNoDirectionWithoutEvidence) {
  const std::vector<double> x = {1, 2, 3, 4};
  for (const int events : {0, kRuns}) {
    const std::vector<int> all(4, events);
    const SweepResult result = sweep_of(x, {all, all});
    const Table table = limits_of(result);
    EXPECT_EQ(direction(result), std::nullopt);
    EXPECT_EQ(place(table, 0), events == 0 ? "none of the runs" : "all of the runs");
    EXPECT_TRUE(std::isnan(numbers(table, "low")[0]) && std::isnan(numbers(table, "high")[0]));
    for (const bool rises : {true, false}) {
      const Table stated =
          event_limits(result, {"event", 0.5, 1, 0.5, rises}, independent_streams(result.cell_count())).table;
      EXPECT_EQ(place(stated, 0), (events == 0) == rises ? "above the last value" : "below the first value");
      EXPECT_EQ(numbers(stated, (events == 0) == rises ? "low" : "high")[0], (events == 0) == rises ? 4 : 1);
    }
  }
  EXPECT_EQ(direction(sweep_of(x, {{0, 0, 0, 1}})), std::nullopt);
  EXPECT_EQ(direction(sweep_of(x, {{1, 0, 0, 0}, {0, 0, 0, 1}})), std::nullopt);
  EXPECT_EQ(direction(sweep_of(x, {{0, 0, 0, 10}})), true);
}

// An unknown outcome is neither an event nor its absence: the limit is that of the known runs, the interval
// covers both, and the row counts them.
TEST(EventLimits, KeepUnknownOutcomesApart) {
  SweepResult result = sweep_of({1, 2, 3}, {{0, 20, 100}});
  auto& values = std::get<std::vector<double>>(result.measures[0].values);
  for (int i = 0; i < 40; ++i) values[result.run(1, kRuns - 1 - i)] = std::nan("");
  const Table table = limits_of(result);
  EXPECT_NEAR(numbers(table, "value")[0], 2 + (0.5 - 20. / 60) / (1 - 20. / 60), 1e-12);
  EXPECT_EQ(numbers(table, "low")[0], 1);
  EXPECT_EQ(counts(table, "unknown"), std::vector<std::int32_t>{40});
  EXPECT_EQ(std::get<std::vector<std::string>>(table.columns[table.columns.size() - 2].values)[0],
            "at one value 40 of 100 runs unknown");
}

// Fixed cells count as one run, which is certain.
TEST(EventLimits, OfFixedCellsAreCertain) {
  const SweepResult result = sweep_of({1, 3, 5, 7, 9}, {{0, 0, 100, 100, 100}});
  CellStreams fixed = independent_streams(result.cell_count());
  for (RandomStreams& draws : fixed.draws) draws = {};
  const EventLimits limits = event_limits(result, {"event", 0.5, 1, 0.5}, fixed);
  EXPECT_EQ(limits.rises, true);
  EXPECT_EQ(numbers(limits.table, "low")[0], 3);
  EXPECT_EQ(numbers(limits.table, "high")[0], 5);
  EXPECT_EQ(counts(limits.table, "runs"), std::vector<std::int32_t>{5});
}

// Runs that share random numbers along the axis count as one, also if only counts are known.
TEST(EventLimits, CountClusters) {
  const SweepResult result = sweep_of({1, 2, 4}, {{0, 25, 75}, {20, 60, 100}});
  CellStreams common = independent_streams(result.cell_count()), registered = common;
  common.noise_cell = {0, 0, 0, 3, 3, 3};
  for (RandomStreams& draws : registered.draws) draws.of_replicate = true;
  const LimitQuestion question{"event", 0.5, 1, 0.5};
  const std::vector<double>& values = result.measure("event");
  const CellCounts of_cells{[&](std::size_t cell) { return event_counts(result, values, cell); }};
  for (const CellStreams& streams : {common, registered})
    for (const Table& table : {event_limits(result, question, streams).table,
                               event_limits(result, of_cells, question, streams).table}) {
      EXPECT_EQ(counts(table, "runs"), (std::vector<std::int32_t>{kRuns, kRuns}));
      EXPECT_EQ(std::get<std::vector<std::string>>(table.columns[table.columns.size() - 2].values)[0],
                "300 runs share random numbers and count as 100");
    }
}

// The shares 0.4 and 0.2 are pooled to 0.3, because the event can only become more probable.
TEST(EventLimits, IgnoreAStepBack) {
  const Table table = limits_of(sweep_of({1, 2, 3, 4}, {{0, 40, 20, 70}}));
  EXPECT_DOUBLE_EQ(numbers(table, "value")[0], 3.5);
}

TEST(EventLimits, OutsideTheValuesAreNotKnown) {
  const Table table = limits_of(sweep_of({1, 2}, {{0, 10}, {90, 100}, {0, 100}}));
  EXPECT_TRUE(std::isnan(numbers(table, "value")[0]));
  EXPECT_EQ(place(table, 0), "above the last value");
  EXPECT_TRUE(std::isnan(numbers(table, "value")[1]));
  EXPECT_EQ(place(table, 1), "below the first value");
  EXPECT_EQ(place(table, 2), "inside");
}

TEST(EventLimits, ARowThatChangesTheOtherWayHasNone) {
  const Table table = limits_of(sweep_of({1, 2, 3}, {{0, 50, 100}, {0, 50, 100}, {100, 100, 0}}));
  EXPECT_EQ(place(table, 0), "inside");
  EXPECT_EQ(place(table, 2), "changes the other way");
  EXPECT_TRUE(std::isnan(numbers(table, "value")[2]));
}

TEST(EventLimits, ALevelThatIsReachedExactlyIsInside) {
  EXPECT_DOUBLE_EQ(numbers(limits_of(sweep_of({1, 2}, {{0, 90}}), 0.9), "value")[0], 2);
  EXPECT_DOUBLE_EQ(numbers(limits_of(sweep_of({1, 2}, {{70, 100}}), 0.7), "value")[0], 1);
}

TEST(EventLimits, UseFinishedRunsOnly) {
  SweepResult result = sweep_of({1, 2, 4}, {{0, 25, 75}});
  for (int replicate = 0; replicate < kRuns; ++replicate)
    result.state[result.run(result.cell_at({0, 1}), replicate)] = RunState::failed;
  const Table table = limits_of(result);
  EXPECT_DOUBLE_EQ(numbers(table, "value")[0], 3);  // between 1 and 4
  EXPECT_EQ(counts(table, "runs")[0], 2 * kRuns);
  for (RunState& state : result.state) state = RunState::pending;
  EXPECT_EQ(place(limits_of(result), 0), "no runs");
}

// The last value of the axis has no runs, so it is not known whether the limit is above it.
TEST(EventLimits, AreNotSaidToBeOutsideAnAxisWhoseEndHasNoRuns) {
  SweepResult result = sweep_of({1, 2, 4}, {{0, 0, 100}, {0, 0, 0}, {0, 50, 100}});
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
  EXPECT_DOUBLE_EQ(numbers(limits_of(result, 0.5, 4), "value")[0], 1.5);
  EXPECT_EQ(place(limits_of(result, 0.5, 6), 0), "none of the runs");
}

TEST(EventLimits, OfACurveThatRisesAndFallsAreNone) {
  const Table table = limits_of(sweep_of({1, 2, 3, 4, 5}, {{0, 100, 100, 100, 0}, {0, 0, 50, 100, 100}}));
  EXPECT_EQ(place(table, 0), "rises and falls");
  EXPECT_TRUE(std::isnan(numbers(table, "value")[0]));
  EXPECT_EQ(place(table, 1), "inside");
}

// Values with 5 runs borrow from their neighbours only if both curves have independent runs. The second
// curve draws nothing.
TEST(EventLimits, AreComparedWithTheRunsOfBothCurves) {
  SweepResult result = sweep_of({1, 2, 3, 4, 5, 6}, {{0, 0, 0, 100, 100, 100}, {0, 0, 0, 100, 100, 100}});
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    const std::size_t replicate = static_cast<std::size_t>(result.replicate_of(run));
    const std::size_t cell = result.cell_of(run);
    if (replicate >= 8 || (cell < 6 && (replicate + cell) % 8 < 3)) result.state[run] = RunState::pending;
  }
  const LimitQuestion question{"event", 0.5, 1, 0.5, true};
  CellStreams streams = independent_streams(result.cell_count());
  for (std::size_t cell = 6; cell < 12; ++cell) streams.draws[cell] = {};
  const auto low = [&] {
    return numbers(limit_comparisons(result, question, 0, streams, LimitComparison::difference), "low")[0];
  };
  EXPECT_FALSE(std::isnan(low()));
  for (std::size_t cell = 0; cell < 6; ++cell) streams.noise_cell[cell] = 0;
  EXPECT_TRUE(std::isnan(low()));
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
