// Means and paired differences of a sweep, on results made by hand.
#include "analysis/sweeps/sweep_means.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_result.h"
#include "analysis/trace/interval_estimates.h"
#include "analysis/trace/paired_test.h"

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
