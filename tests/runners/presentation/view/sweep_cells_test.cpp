#include "runners/presentation/view/sweep_cells.h"

#include <gtest/gtest.h>

#include <limits>

namespace remote_touch::sweep_cells_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A sweep with axes of these lengths, whose runs are all done with these values.
SweepResult sweep_of(std::vector<std::size_t> lengths, int replicates, std::vector<double> values) {
  SweepResult result;
  for (const std::size_t length : lengths)
    result.axes.push_back({"axis", "1", "", std::vector<double>(length, 0.0), 1, {}});
  result.replicates = replicates;
  result.measures.push_back({"popped_through", "1", "", std::vector<double>(), 1, {}});
  result.start(false);
  result.measures.front().values = std::move(values);
  result.state.assign(result.run_count(), RunState::done);
  return result;
}

std::vector<std::size_t> chosen(const SweepResult& result, std::size_t max = 6) {
  return default_runs(result, result.measure("popped_through"), 0.5, max);
}

// 0: holds, 1: fails. Rows of the first axis.
//   0 0 1 1
//   0 1 1 1
//   0 0 0 1
TEST(DefaultRuns, AreFailedCellsBesideCellsThatHold) {
  EXPECT_EQ(chosen(sweep_of({3, 4}, 1, {0, 0, 1, 1, 0, 1, 1, 1, 0, 0, 0, 1})),
            (std::vector<std::size_t>{2, 5, 6, 11}));
}

TEST(DefaultRuns, AreSpreadEvenlyWhereThereAreMany) {
  std::vector<double> values;
  for (int row = 0; row < 20; ++row)
    for (const double value : {0.0, 1.0}) values.push_back(value);
  EXPECT_EQ(chosen(sweep_of({20, 2}, 1, values), 3), (std::vector<std::size_t>{1, 19, 39}));
  EXPECT_EQ(chosen(sweep_of({20, 2}, 1, values), 1), (std::vector<std::size_t>{1}));
}

TEST(DefaultRuns, UseTheFirstFailedReplicateOfACellThatMostlyFails) {
  EXPECT_EQ(chosen(sweep_of({3}, 3, {0, 0, 0, 0, 1, 1, 1, 1, 1})), (std::vector<std::size_t>{4}));
  // One of three is not most, so the limit comes after that cell.
  EXPECT_EQ(chosen(sweep_of({3}, 3, {0, 0, 0, 0, 1, 0, 1, 1, 1})), (std::vector<std::size_t>{6}));
}

// Refinement leaves cells out; the next one that was run counts.
TEST(DefaultRuns, ANeighbourIsTheNextCellWithRuns) {
  SweepResult result = sweep_of({5}, 1, {0, kNaN, kNaN, 1, 1});
  result.state[1] = result.state[2] = RunState::not_sampled;
  EXPECT_EQ(chosen(result), (std::vector<std::size_t>{3}));
}

TEST(DefaultRuns, AreAnyFailuresOrElseTheExtremesIfThereIsNoLimit) {
  EXPECT_EQ(chosen(sweep_of({3}, 1, {1, 1, 1})), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(chosen(sweep_of({4}, 1, {0.2, 0.4, 0.1, kNaN})), (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(chosen(sweep_of({4}, 1, {0.2, 0.4, 0.1, kNaN}), 1), (std::vector<std::size_t>{1}));
  EXPECT_EQ(chosen(sweep_of({2}, 1, {kNaN, kNaN})), (std::vector<std::size_t>{0}));
  SweepResult none = sweep_of({2}, 1, {kNaN, kNaN});
  none.state.assign(2, RunState::failed);
  EXPECT_TRUE(chosen(none).empty());
}

}  // namespace
}  // namespace remote_touch::sweep_cells_test
