// Means and paired differences of a sweep or a tally, and limits of an event along an axis, on results made
// by hand.
#include "analysis/sweeps/sweep_means.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/interval_estimates.h"
#include "tests/analysis/sweeps/example_sweeps.h"
#include "tests/analysis/sweeps/example_tally.h"

namespace remote_touch::sweep_means_test {
namespace {

using namespace made_sweeps;

template <class T>
std::vector<T> column(const Table& table, const std::string& name) {
  for (const Column& each : table.columns)
    if (each.name == name) return std::get<std::vector<T>>(each.values);
  return {};
}
std::vector<std::int32_t> counts(const Table& table, const std::string& name) {
  return column<std::int32_t>(table, name);
}
std::string note(const Table& table) {
  return column<std::string>(table, "note")[0];
}

// Two values of x and two methods, the second running fastest; values[cell] has the values of both measures
// in each replicate.
SweepResult sweep_of(const std::vector<std::vector<double>>& values) {
  SweepResult result = sweep({{"x", "m", "", std::vector<double>{0.1, 0.2}}, names("method", {"old", "new"})},
                             static_cast<int>(values.front().size()));
  for (std::size_t run = 0; run < result.run_count(); ++run)
    event(result)[run] = depth(result)[run] =
        values[result.cell_of(run)][static_cast<std::size_t>(result.replicate_of(run))];
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

// Half of the interval of the mean of three numbers n, n + 1, n + 2. The 97.5 % point of Student's t with 2
// degrees of freedom is 4.30265, with 4 it is 2.77645.
const double kHalfOfThree = 4.30265 / std::sqrt(3.0);

// Runs without a value, and those that did not finish, are left out. Numbers that do not scatter have no
// interval.
TEST(SweepMeans, HaveStudentsIntervalOfEachCell) {
  SweepResult result = sweep_of({{1, 2, 3}, {5, 5, kNaN}, {0, 4, 8}, {kNaN, kNaN, kNaN}});
  const Table table = sweep_means(result, "depth", {0, 1}, kOwn);
  EXPECT_NEAR(numbers(table, "high")[0], 2 + kHalfOfThree, 1e-5);
  EXPECT_NEAR(numbers(table, "low")[2], 4 - 4 * kHalfOfThree, 1e-4);
  EXPECT_TRUE(std::isnan(numbers(table, "low")[1]));
  EXPECT_EQ(numbers(table, "value")[1], 5);
  EXPECT_TRUE(std::isnan(numbers(table, "value")[3]));
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{0.1, 0.1, 0.2, 0.2}));
  EXPECT_EQ(counts(table, "runs"), (std::vector<std::int32_t>{3, 2, 3, 0}));
  EXPECT_EQ(counts(table, "unknown"), (std::vector<std::int32_t>{0, 1, 0, 3}));
  result.state[result.run(2, 0)] = RunState::failed;
  EXPECT_EQ(numbers(sweep_means(result, "depth", {0, 1}, kOwn), "value")[2], 6);
}

// The scatter is that within the cells, not that between them.
TEST(SweepMeans, PoolTheAxesThatAreNotNamed) {
  const SweepResult result = sweep_of({{1, 2, 3}, {11, 12, 13}, {0, 0, 0}, {0, 0, 0}});
  const Table table = sweep_means(result, "depth", {0}, kOwn);
  EXPECT_EQ(numbers(table, "value")[0], 7);
  EXPECT_NEAR(numbers(table, "high")[0], 7 + 2.77645 / std::sqrt(6.0), 1e-5);  // 4 degrees: no Hall
  EXPECT_EQ(counts(table, "runs")[0], 6);
  EXPECT_EQ(numbers(sweep_means(result, "depth", {}, kOwn), "value"), (std::vector<double>{3.5}));
}

// A force that is 0 in every run is no event: its interval is not one of a proportion.
TEST(SweepMeans, OfAnEventHaveTheExactInterval) {
  const SweepResult result = sweep_of({{0, 1, 1, 1}, {0, 0, 0, 0}, {1, 1, 1, 1}, {0, 1, 0, kNaN}});
  const Table table = sweep_means(result, "event", {0, 1}, kOwn);
  const auto [low, high] = exact_interval(3, 4);
  EXPECT_EQ(numbers(table, "value")[0], 0.75);
  EXPECT_EQ(numbers(table, "low")[0], low);
  EXPECT_EQ(numbers(table, "high")[0], high);
  EXPECT_DOUBLE_EQ(numbers(table, "value")[3], 1.0 / 3);
  EXPECT_EQ(numbers(table, "high")[3], exact_interval(2, 4).second);
  EXPECT_EQ(counts(table, "unknown"), (std::vector<std::int32_t>{0, 0, 0, 1}));
  EXPECT_TRUE(std::isnan(numbers(sweep_means(result, "depth", {0, 1}, kOwn), "high")[1]));
}

// Runs that share the stream of their replicate are one, whichever cells are pooled, and so are two methods
// with the same noise; equal runs of a fixed cell are one, and certain.
TEST(SweepMeans, CountSharedAndEqualRunsOnce) {
  const SweepResult result = sweep_of({{1, 2, 3}, {3, 4, 5}, {1, 2, 3}, {3, 4, 5}});
  for (const Table& shared :
       {sweep_means(result, "depth", {}, kRegistered), sweep_means(result, "depth", {0}, kCommonMethods)}) {
    EXPECT_EQ(counts(shared, "runs")[0], 3);
    EXPECT_EQ(numbers(shared, "value")[0], 3);
    EXPECT_NEAR(numbers(shared, "high")[0], 3 + kHalfOfThree, 1e-5);  // of 2, 3, 4
  }
  EXPECT_EQ(counts(sweep_means(result, "depth", {0}, kOwn), "runs")[0], 6);
  const SweepResult equal = sweep_of({{2, 2, 2}, {4, 4, 4}, {1, 2, 3}, {3, 4, 5}});
  const Table fixed = sweep_means(equal, "depth", {0}, kFixed);
  EXPECT_EQ(numbers(fixed, "value")[0], 3);
  EXPECT_TRUE(std::isnan(numbers(fixed, "low")[0]) && std::isnan(numbers(fixed, "high")[0]));
  EXPECT_EQ(counts(fixed, "runs"), (std::vector<std::int32_t>{2, 6}));
  EXPECT_EQ(note(fixed), "6 equal runs count as 2");
  const Table difference = sweep_differences(equal, "depth", 1, {0}, kFixed);
  EXPECT_EQ(numbers(difference, "value")[0], 2);
  EXPECT_TRUE(std::isnan(numbers(difference, "p")[0]) && std::isnan(numbers(difference, "low")[0]));
  EXPECT_EQ(counts(difference, "runs")[0], 1);
}

TEST(SweepDifferences, PairsWithCommonNoiseCountAsOne) {
  const SweepResult result = sweep_of({{1, 2, 3}, {3, 4, 5}, {2, 4, 6}, {6, 8, 10}});
  const Table table = sweep_differences(result, "depth", 0, {}, kCommonMethods);
  EXPECT_EQ(counts(table, "runs")[0], 3);
  EXPECT_EQ(numbers(table, "value")[0], 3);  // of 2, 3, 4
  EXPECT_NEAR(numbers(table, "high")[0], 3 + kHalfOfThree, 1e-5);
}

// Pairs of which one run has no value, or did not finish, are left out.
TEST(SweepDifferences, AreThoseOfPairs) {
  SweepResult result = sweep_of({{1, 2, 3, 0}, {2, 4, 3, kNaN}, {10, 20, 30, 1}, {11, 21, 31, 9}});
  result.state[result.run(2, 3)] = RunState::failed;
  const Table table = sweep_differences(result, "depth", 1, {0}, kOwn);
  EXPECT_EQ(numbers(table, "value"), (std::vector<double>{1, 1}));
  EXPECT_EQ(counts(table, "runs"), (std::vector<std::int32_t>{3, 3}));
  EXPECT_NEAR(numbers(table, "high")[0], 1 + kHalfOfThree, 1e-5);
  EXPECT_TRUE(std::isnan(numbers(table, "high")[1])) << "the pairs differ alike, although values scatter";
  EXPECT_TRUE(std::isnan(numbers(table, "p")[0])) << "no test of three pairs reaches 0.05";
  EXPECT_EQ(table.columns[1].name, "method");
  EXPECT_EQ(counts(table, "method"), (std::vector<std::int32_t>{1, 1}));
}

// A row without pairs has no test, so that the p of the other is not adjusted.
TEST(SweepDifferences, OfAnEventCountThePairsThatDiffer) {
  SweepResult result =
      sweep_of({{0, 0, 0, 0, 0, 1}, {1, 1, 1, 1, 0, 1}, {0, 0, 0, 0, 0, 0}, {0, 0, 0, 0, 0, 0}});
  const Table table = sweep_differences(result, "event", 1, {0}, kOwn);
  EXPECT_DOUBLE_EQ(numbers(table, "value")[0], 4.0 / 6);
  EXPECT_EQ(numbers(table, "low")[0], 0);    // p is above 0.05
  EXPECT_EQ(numbers(table, "p")[0], 0.125);  // 2 / 2^4
  EXPECT_EQ(numbers(table, "adjusted_p")[0], 0.25);
  EXPECT_EQ(numbers(table, "p")[1], 1);
  for (int replicate = 0; replicate < 6; ++replicate)
    result.state[result.run(2, replicate)] = RunState::failed;
  const Table alone = sweep_differences(result, "event", 1, {0}, kOwn);
  EXPECT_EQ(numbers(alone, "adjusted_p")[0], 0.125);
  EXPECT_TRUE(std::isnan(numbers(alone, "p")[1]) && std::isnan(numbers(alone, "adjusted_p")[1]));
}

// A tally may have more runs than an integer of 32 bits counts.
TEST(SweepMeans, CountMoreThanTwoBillionRuns) {
  EXPECT_EQ(counts_in_column({1, 2147483647}), Values(std::vector<std::int32_t>{1, 2147483647}));
  EXPECT_EQ(counts_in_column({1, 3000000000}), Values(std::vector<double>{1, 3e9}));
}

// Four runs of the first cell: two kinds of notes in the first run, and a value that is infinite in the
// third.
TEST(TallyMeans, CountNotesAndRunsWithoutAValue) {
  SweepTally tally = example_plan(4);
  const auto add = [&](std::uint64_t run, double jump, std::uint64_t notes) {
    tally.add_done(tally.layout(), run, std::vector<double>{jump, 0, 0}, notes);
  };
  add(0, 1, 0b011), add(1, 2, 0b001), add(2, INFINITY, 0), add(3, 6, 0b100);
  EXPECT_EQ(noted_runs(tally, 0), 2);
  EXPECT_EQ(noted_runs(tally, 1), 0);
  const Table table = sweep_means(tally, "jump", {0, 1}, independent_streams(6));
  EXPECT_EQ(numbers(table, "value")[0], 3);
  for (const auto& [name, count] : {std::pair("runs", 3), {"unknown", 1}, {"noted_runs", 2}})
    EXPECT_EQ(counts(table, name)[0], count) << name;
  EXPECT_NE(note(table).find("of 3 of 4 runs that have a value"), std::string::npos);
}

// --- limits of an event ---

constexpr int kRuns = 100;

// A sweep over methods and these values of x; events[method][i] of 100 runs of a cell have the event.
SweepResult events_of(const std::vector<double>& x, const std::vector<std::vector<int>>& events) {
  Texts methods;
  for (std::size_t method = 0; method < events.size(); ++method)
    methods.push_back("m" + std::to_string(method));
  SweepResult result = sweep({names("method", methods), {"x", "m", "", x}}, kRuns);
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    const std::vector<std::size_t> at = result.axis_indices(result.cell_of(run));
    event(result)[run] = result.replicate_of(run) < events[at[0]][at[1]] ? 1 : 0;
  }
  return result;
}
// Sets the state of all runs of a cell.
void set_state(SweepResult& result, const std::vector<std::size_t>& cell, RunState state) {
  for (int replicate = 0; replicate < kRuns; ++replicate)
    result.state[result.run(result.cell_at(cell), replicate)] = state;
}

EventLimits all_of_limits(const SweepResult& result, double level = 0.5, double threshold = 0.5) {
  return event_limits(result, {"event", threshold, 1, level}, independent_streams(result.cell_count()));
}
Table limits_of(const SweepResult& result, double level = 0.5, double threshold = 0.5) {
  return all_of_limits(result, level, threshold).table;
}
std::optional<bool> direction(const SweepResult& result) {
  return all_of_limits(result).rises;
}

std::string place(const Table& table, std::size_t row) {
  for (const Column& each : table.columns)
    if (each.name == "place")
      return each
          .value_names[static_cast<std::size_t>(std::get<std::vector<std::int32_t>>(each.values)[row])];
  return {};
}

constexpr double kAny = -1;  // no limit is negative in these tests

void expect_number(double value, double expected) {
  if (expected == kAny) return;
  EXPECT_TRUE(std::isnan(expected) ? std::isnan(value) : std::abs(value - expected) < 1e-12) << value;
}

// The intervals of 25 and 75 of 100 runs with the event are off 0.5, those of 45 and 55 are not. The shares
// 0.4 and 0.2 are pooled to 0.3, because the event can only become more probable.
TEST(EventLimits, AreWhereTheShareCrossesTheLevel) {
  const struct {
    std::vector<double> x;
    std::vector<int> events;
    double level, value, low, high;
    const char* place;
  } rows[] = {{{1, 2, 4}, {0, 25, 75}, 0.5, 3, 2, 4, "inside"},
              {{1, 2, 4}, {20, 60, 100}, 0.5, 1.75, kAny, kAny, "inside"},
              {{1, 2, 4}, {0, 25, 75}, 0.1, 1.4, kAny, kAny, "inside"},
              {{1, 2, 4, 8}, {0, 45, 55, 100}, 0.5, kAny, 1, 8, "inside"},
              {{1, 2, 4}, {75, 25, 0}, 0.5, 1.5, 1, 2, "inside"},
              {{1, 2, 4}, {100, 55, 52}, 0.5, kNaN, 1, kNaN, "above the last value"},
              {{1, 2, 3, 4}, {0, 40, 20, 70}, 0.5, 3.5, kAny, kAny, "inside"},
              {{1, 2}, {0, 10}, 0.5, kNaN, kAny, kAny, "above the last value"},
              {{1, 2}, {90, 100}, 0.5, kNaN, kAny, kAny, "below the first value"},
              {{1, 2}, {0, 90}, 0.9, 2, kAny, kAny, "inside"},  // the level is reached exactly
              {{1, 2}, {70, 100}, 0.7, 1, kAny, kAny, "inside"}};
  for (const auto& row : rows) {
    SCOPED_TRACE(testing::PrintToString(row.events) + ", level " + std::to_string(row.level));
    const EventLimits limits = all_of_limits(events_of(row.x, {row.events}), row.level);
    EXPECT_EQ(limits.rises, row.events.front() < row.events.back());
    expect_number(numbers(limits.table, "value")[0], row.value);
    expect_number(numbers(limits.table, "low")[0], row.low);
    expect_number(numbers(limits.table, "high")[0], row.high);
    EXPECT_EQ(place(limits.table, 0), row.place);
  }
}

TEST(EventLimits, HaveTheOtherAxesAndNoLimitWhereARowHasAnotherShape) {
  const Table table = limits_of(
      events_of({1, 2, 3, 4, 5},
                {{0, 0, 50, 100, 100}, {0, 0, 50, 100, 100}, {0, 100, 100, 100, 0}, {100, 100, 100, 0, 0}}));
  EXPECT_EQ(place(table, 0), "inside");
  EXPECT_EQ(place(table, 2), "rises and falls");
  EXPECT_EQ(place(table, 3), "changes the other way");
  for (const std::size_t row : {2u, 3u}) EXPECT_TRUE(std::isnan(numbers(table, "value")[row]));
  EXPECT_EQ(table.columns[0].name, "method");
  EXPECT_EQ(counts(table, "method"), (std::vector<std::int32_t>{0, 1, 2, 3}));
  EXPECT_EQ(table.columns[0].value_names[1], "m1");
  EXPECT_EQ(table.columns[1].units, "m");
}

TEST(EventLimits, CountTheRunsWithANote) {
  SweepResult result = events_of({1, 2}, {{25, 75}});
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
    const SweepResult result = events_of(x, {all, all});
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
  EXPECT_EQ(direction(events_of(x, {{0, 0, 0, 1}})), std::nullopt);
  EXPECT_EQ(direction(events_of(x, {{1, 0, 0, 0}, {0, 0, 0, 1}})), std::nullopt);
  EXPECT_EQ(direction(events_of(x, {{0, 0, 0, 10}})), true);
}

// An unknown outcome is neither an event nor its absence: the limit is that of the known runs, the interval
// covers both, and the row counts them.
TEST(EventLimits, KeepUnknownOutcomesApart) {
  SweepResult result = events_of({1, 2, 3}, {{0, 20, 100}});
  for (int i = 0; i < 40; ++i) event(result)[result.run(1, kRuns - 1 - i)] = std::nan("");
  const Table table = limits_of(result);
  EXPECT_NEAR(numbers(table, "value")[0], 2 + (0.5 - 20. / 60) / (1 - 20. / 60), 1e-12);
  EXPECT_EQ(numbers(table, "low")[0], 1);
  EXPECT_EQ(counts(table, "unknown"), std::vector<std::int32_t>{40});
  EXPECT_EQ(note(table), "at one value 40 of 100 runs unknown");
}

// Fixed cells count as one run, which is certain.
TEST(EventLimits, OfFixedCellsAreCertain) {
  const SweepResult result = events_of({1, 3, 5, 7, 9}, {{0, 0, 100, 100, 100}});
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
  const SweepResult result = events_of({1, 2, 4}, {{0, 25, 75}, {20, 60, 100}});
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
      EXPECT_EQ(note(table), "300 runs share random numbers and count as 100");
    }
}

TEST(EventLimits, UseFinishedRunsOnly) {
  SweepResult result = events_of({1, 2, 4}, {{0, 25, 75}});
  set_state(result, {0, 1}, RunState::failed);
  const Table table = limits_of(result);
  EXPECT_DOUBLE_EQ(numbers(table, "value")[0], 3);  // between 1 and 4
  EXPECT_EQ(counts(table, "runs")[0], 2 * kRuns);
  for (RunState& state : result.state) state = RunState::pending;
  EXPECT_EQ(place(limits_of(result), 0), "no runs");
}

// The last value of the axis has no runs, so it is not known whether the limit is above it.
TEST(EventLimits, AreNotSaidToBeOutsideAnAxisWhoseEndHasNoRuns) {
  SweepResult result = events_of({1, 2, 4}, {{0, 0, 100}, {0, 0, 0}, {0, 50, 100}});
  set_state(result, {0, 2}, RunState::pending);
  EXPECT_EQ(place(limits_of(result), 0), "above the values with runs");
  EXPECT_EQ(place(limits_of(result), 1), "above the last value");
  result = events_of({1, 2, 4}, {{0, 100, 100}, {0, 50, 100}});
  set_state(result, {0, 0}, RunState::pending);
  EXPECT_EQ(place(limits_of(result), 0), "below the values with runs");
}

TEST(EventLimits, AnEventIsAMeasureAboveTheThreshold) {
  SweepResult result = events_of({1, 2}, {{0, 100}});
  for (double& value : event(result)) value = 3 + 2 * value;
  EXPECT_DOUBLE_EQ(numbers(limits_of(result, 0.5, 4), "value")[0], 1.5);
  EXPECT_EQ(place(limits_of(result, 0.5, 6), 0), "none of the runs");
}

// Values with 5 runs borrow from their neighbours only if both curves have independent runs. The second
// curve draws nothing.
TEST(EventLimits, AreComparedWithTheRunsOfBothCurves) {
  SweepResult result = events_of({1, 2, 3, 4, 5, 6}, {{0, 0, 0, 100, 100, 100}, {0, 0, 0, 100, 100, 100}});
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

}  // namespace
}  // namespace remote_touch::sweep_means_test
