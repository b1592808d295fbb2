#include "analysis/sweeps/sweep_means.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

namespace remote_touch::refinement_test {
namespace {

// Rules by which adaptive refinement adds runs, tested one by one on results made by hand. Wilson's
// interval of a few runs excludes 0.5 from 0 of 4, or 4 of 4, on.

// Returns a grid without sampled runs, with these numbers of cells along the axes and room for this number of
// replicates.
SweepResult empty_grid(const std::vector<int>& lengths, int replicates) {
  SweepResult result;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    std::vector<double> values(static_cast<std::size_t>(lengths[i]));
    std::iota(values.begin(), values.end(), 0.0);
    result.axes.push_back({"axis" + std::to_string(i), "1", "", values});
  }
  result.replicates = replicates;
  result.measures = {{"other", "1", "", {}}, {"popped_through", "1", "", {}}};
  result.start(true);
  return result;
}

void set(SweepResult& result, std::size_t run, RunState state, double value = 0) {
  result.state[run] = state;
  std::get<std::vector<double>>(result.measures[1].values)[run] = value;
}

// Marks the first `runs` runs of the cell as done; the first `events` of them have the event.
void sample(SweepResult& result, std::size_t cell, int events, int runs) {
  for (int i = 0; i < runs; ++i) set(result, result.run(cell, i), RunState::done, i < events ? 1 : 0);
}

RefinementRule rule(std::vector<std::size_t> strides, int first_replicates = 1, std::uint64_t budget = 1000) {
  RefinementRule rule;
  rule.strides = std::move(strides), rule.first_replicates = first_replicates, rule.budget = budget;
  return rule;
}

using Runs = std::vector<std::size_t>;
Runs all_of(const SweepResult& result, std::initializer_list<std::size_t> cells, int from, int to) {
  Runs runs;
  for (const std::size_t cell : cells)
    for (int i = from; i < to; ++i) runs.push_back(result.run(cell, i));
  return runs;
}

TEST(NextRound, RequestsNothingIfAllCellsAreCertainAndAgree) {
  for (const int events : {0, 4}) {
    SweepResult result = empty_grid({5, 3}, 8);
    for (const std::size_t cell : {0, 2, 12, 14}) sample(result, cell, events, 4);
    EXPECT_EQ(next_round(result, rule({4, 2})), Runs{});
  }
}

// No run is requested at the finest spacing, because there is no cell in between.
TEST(NextRound, AsksHalfWayBetweenCellsThatDisagree) {
  SweepResult result = empty_grid({5}, 8);
  const RefinementRule r = rule({4}, 4);
  sample(result, 0, 0, 4), sample(result, 4, 4, 4);
  EXPECT_EQ(next_round(result, r), all_of(result, {2}, 0, 4));
  sample(result, 2, 0, 4);
  EXPECT_EQ(next_round(result, r), all_of(result, {3}, 0, 4));
  sample(result, 3, 4, 4);
  EXPECT_EQ(next_round(result, r), Runs{});
}

// The event is unlikely with 1 of 4, as with 0 of 4, but 1 of 4 is uncertain.
TEST(NextRound, AsksHalfWayAndAgainWhereACellIsUncertain) {
  SweepResult result = empty_grid({5}, 6);
  sample(result, 0, 0, 4), sample(result, 4, 1, 4);
  const Runs expected = {result.run(2, 0), result.run(4, 4)};
  EXPECT_EQ(next_round(result, rule({4})), expected);
}

// 80 of 200 runs are certainly less than half, and 120 certainly more: their intervals are +-0.07 wide.
TEST(NextRound, CellsDisagreeAboutOneHalf) {
  const auto half_way = [](int events, int others) {
    SweepResult result = empty_grid({3}, 200);
    sample(result, 0, events, 200), sample(result, 2, others, 200);
    const Runs runs = next_round(result, rule({2}));
    EXPECT_TRUE(runs.empty() || runs == Runs{result.run(1, 0)});
    return !runs.empty();
  };
  EXPECT_FALSE(half_way(80, 0));
  EXPECT_FALSE(half_way(120, 200));
  EXPECT_TRUE(half_way(80, 120));
  EXPECT_TRUE(half_way(120, 80));
}

TEST(NextRound, AnUncertainCellGetsReplicatesUpToTheMaximum) {
  SweepResult result = empty_grid({1}, 6);
  sample(result, 0, 1, 2);
  EXPECT_EQ(next_round(result, rule({1}, 3)), all_of(result, {0}, 2, 5));
  sample(result, 0, 2, 5);
  EXPECT_EQ(next_round(result, rule({1}, 3)), all_of(result, {0}, 5, 6));
  sample(result, 0, 3, 6);
  EXPECT_EQ(next_round(result, rule({1}, 3)), Runs{});
}

TEST(NextRound, SpacingsAreThoseOfTheFirstRoundAndItsHalves) {
  // Cell 3 is no node of spacing 4 or 2, and there is no cell between it and its neighbour at spacing 1.
  SweepResult result = empty_grid({9}, 4);
  sample(result, 3, 0, 4), sample(result, 7, 4, 4);
  EXPECT_EQ(next_round(result, rule({4})), Runs{});
  // Cells 0 and 8 are neighbours at spacing 8, but not at spacing 4, because 4 is between them.
  result = empty_grid({9}, 4);
  sample(result, 0, 0, 4), sample(result, 8, 4, 4);
  EXPECT_EQ(next_round(result, rule({4})), Runs{});
  EXPECT_EQ(next_round(result, rule({8})), Runs{result.run(4, 0)});
  // A cell that was not sampled disagrees with no neighbour.
  result = empty_grid({9}, 4);
  sample(result, 4, 0, 4);
  EXPECT_EQ(next_round(result, rule({4})), Runs{});
}

TEST(NextRound, EveryAxisHasItsOwnSpacing) {
  // The corners of 3 x 3 cells are sampled, and the last one differs. The middle is not requested, because
  // diagonals are no neighbours.
  SweepResult result = empty_grid({3, 3}, 4);
  for (const std::size_t cell : {0, 2, 6}) sample(result, cell, 0, 4);
  sample(result, 8, 4, 4);
  const Runs expected = {result.run(5, 0), result.run(7, 0)};
  EXPECT_EQ(next_round(result, rule({2, 2})), expected);
  // An axis of stride 1, such as a list of names, has no cells in between.
  EXPECT_EQ(next_round(result, rule({2, 1})), Runs{result.run(5, 0)});
  EXPECT_EQ(next_round(result, rule({1, 1})), Runs{});
}

TEST(NextRound, KeepsTheBudgetAndServesTheFewestRunsFirst) {
  SweepResult result = empty_grid({5}, 9);
  sample(result, 0, 1, 2), sample(result, 4, 2, 4);  // both uncertain: 6 runs, cell 2 has none
  const auto with = [&](std::uint64_t budget) { return next_round(result, rule({4}, 2, budget)); };
  EXPECT_EQ(with(5), Runs{});
  EXPECT_EQ(with(6), Runs{});
  EXPECT_EQ(with(7), all_of(result, {2}, 0, 1));
  EXPECT_EQ(with(8), all_of(result, {2}, 0, 2));
  const Runs nine = {result.run(0, 2), result.run(2, 0), result.run(2, 1)};
  EXPECT_EQ(with(9), nine);
  EXPECT_EQ(with(12).size(), 6u);
  EXPECT_EQ(with(100).size(), 6u);
}

// A failed run is not requested again by another round. It counts for the budget, but not for the
// probability.
TEST(NextRound, FailedRunsTakeRoomAndBudget) {
  SweepResult result = empty_grid({3}, 4);
  set(result, result.run(0, 0), RunState::failed, 1);
  sample(result, 2, 4, 4);
  EXPECT_EQ(next_round(result, rule({2})), Runs{});
  set(result, result.run(0, 1), RunState::done);
  const Runs expected = {result.run(0, 2), result.run(1, 0)};
  EXPECT_EQ(next_round(result, rule({2})), expected);
  EXPECT_EQ(next_round(result, rule({2}, 1, 7)), Runs{result.run(1, 0)});
  EXPECT_EQ(next_round(result, rule({2}, 1, 6)), Runs{});
}

TEST(NextRound, TheEventIsTheMeasureAboveItsThreshold) {
  SweepResult result = empty_grid({3}, 4);
  for (int i = 0; i < 4; ++i) {
    set(result, result.run(0, i), RunState::done, 0.01);
    set(result, result.run(2, i), RunState::done, 0.02);
  }
  RefinementRule r = rule({2});
  EXPECT_EQ(next_round(result, r), Runs{});  // neither is above 0.5
  r.threshold = 0.01;
  EXPECT_EQ(next_round(result, r), Runs{result.run(1, 0)});
  r.threshold = 0.02;
  EXPECT_EQ(next_round(result, r), Runs{});
  r.threshold = 0.01, r.measure = "other";
  EXPECT_EQ(next_round(result, r), Runs{});  // all NaN, which is never above
}

// A cell whose outcomes are unknown is not certain to be without the event.
TEST(NextRound, UnknownOutcomesAreNotCertain) {
  SweepResult result = empty_grid({3}, 6);
  sample(result, 0, 0, 4), sample(result, 2, 0, 4);
  EXPECT_EQ(next_round(result, rule({2})), Runs{});
  set(result, result.run(0, 3), RunState::done, std::numeric_limits<double>::quiet_NaN());
  const Runs expected = {result.run(0, 4), result.run(1, 0)};
  EXPECT_EQ(next_round(result, rule({2})), expected);
}

// A world whose truth is known: the event happens above a slanted line.
constexpr int kSide = 17;
bool above_line(std::size_t cell, bool mirrored) {
  const int x = static_cast<int>(cell) / kSide, y = static_cast<int>(cell) % kSide;
  return 3 * (mirrored ? kSide - 1 - x : x) + 4 * y > 57;
}
// Runs rounds of four runs a cell until no run is requested. Returns the requested runs of each round.
std::vector<Runs> refine(SweepResult& result, const RefinementRule& r, bool mirrored, bool turned) {
  std::vector<Runs> rounds;
  for (const std::size_t cell : {0, kSide - 1, kSide * (kSide - 1), kSide * kSide - 1})
    sample(result, cell, above_line(cell, mirrored) != turned ? 4 : 0, 4);
  for (Runs runs; !(runs = next_round(result, r)).empty(); rounds.push_back(runs))
    for (const std::size_t run : runs) {
      EXPECT_EQ(result.state[run], RunState::not_sampled);
      set(result, run, RunState::done, above_line(result.cell_of(run), mirrored) != turned ? 1 : 0);
    }
  return rounds;
}

TEST(Refinement, FindsABoundaryWithoutLookingEverywhere) {
  SweepResult result = empty_grid({kSide, kSide}, 4);
  const std::vector<Runs> rounds = refine(result, rule({16, 16}, 4), false, false);
  EXPECT_GE(rounds.size(), 4u);  // 16, 8, 4, 2: one halving each, at least
  for (const Runs& runs : rounds) {
    EXPECT_TRUE(std::is_sorted(runs.begin(), runs.end()));
    EXPECT_EQ(std::adjacent_find(runs.begin(), runs.end()), runs.end());
  }
  // The two cells beside the boundary are both known along the edges, where there are always neighbours.
  const auto known = [&](int x, int y) {
    return event_counts(result, result.measure("popped_through"), static_cast<std::size_t>(x * kSide + y))
               .runs() == 4;
  };
  for (int i = 0; i + 1 < kSide; ++i) {
    const std::size_t low = static_cast<std::size_t>(i), right = low * kSide + kSide - 1;
    const bool crosses_low = above_line(low, false) != above_line(low + 1, false);
    const bool crosses_right = above_line(right, false) != above_line(right + kSide, false);
    EXPECT_TRUE(!crosses_low || (known(0, i) && known(0, i + 1))) << i;
    EXPECT_TRUE(!crosses_right || (known(i, kSide - 1) && known(i + 1, kSide - 1))) << i;
  }
  const std::size_t done = result.runs_in(RunState::done).size();
  EXPECT_LT(done, result.run_count() / 4);
}

TEST(Refinement, IsTheSameWhenTheWorldIsMirroredOrTurned) {
  SweepResult plain = empty_grid({kSide, kSide}, 4), mirrored = plain, turned = plain;
  const RefinementRule r = rule({16, 16}, 4);
  const auto rounds = refine(plain, r, false, false);
  EXPECT_EQ(refine(turned, r, false, true), rounds);
  EXPECT_EQ(refine(mirrored, r, true, false).size(), rounds.size());
  for (std::size_t cell = 0; cell < plain.cell_count(); ++cell) {
    const std::size_t twin = (kSide - 1 - cell / kSide) * kSide + cell % kSide;
    EXPECT_EQ(plain.state[plain.run(cell, 0)], mirrored.state[plain.run(twin, 0)]) << cell;
  }
}

// Every continuation of a result requests the same runs, however often it is continued and whatever else the
// result holds.
TEST(Refinement, DependsOnTheFinishedRunsOnly) {
  SweepResult result = empty_grid({kSide, kSide}, 6);
  const RefinementRule r = rule({16, 16}, 3, 150);
  for (const std::size_t cell : {0, kSide - 1, kSide * (kSide - 1), kSide * kSide - 1})
    sample(result, cell, cell % 3 == 0 ? 1 : 2, 3);
  std::size_t rounds = 0;
  for (Runs runs; !(runs = next_round(result, r)).empty(); ++rounds) {
    SweepResult other = result;
    std::fill(other.round.begin(), other.round.end(), 7);
    std::get<std::vector<double>>(other.measures[0].values).assign(other.run_count(), 1.0);
    EXPECT_EQ(next_round(result, r), runs);
    EXPECT_EQ(next_round(other, r), runs);
    for (const std::size_t run : runs) set(result, run, RunState::done, run % 5 < 2 ? 1 : 0);
  }
  EXPECT_GT(rounds, 2u);
  EXPECT_EQ(result.runs_in(RunState::done).size(), 150u);
}

}  // namespace
}  // namespace remote_touch::refinement_test
