// Rules by which adaptive refinement adds runs, tested one by one on results made by hand. Wilson's interval
// of a few runs excludes 0.5 from 0 of 4, or 4 of 4, on.
#include "analysis/sweeps/sweep_means.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <vector>

namespace remote_touch::refinement_test {
namespace {

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

// Sets the first runs of the cell, one for each letter: '+' has the event, '-' has not, of '?' it is not
// known, and 'x' failed.
void sample(SweepResult& result, std::size_t cell, const std::string& runs) {
  for (std::size_t i = 0; i < runs.size(); ++i)
    set(result, result.run(cell, static_cast<int>(i)), runs[i] == 'x' ? RunState::failed : RunState::done,
        runs[i] == '-'   ? 0
        : runs[i] == '?' ? std::numeric_limits<double>::quiet_NaN()
                         : 1);
}

RefinementRule rule(std::vector<std::size_t> strides, int first_replicates = 1, std::uint64_t budget = 1000) {
  RefinementRule rule;
  rule.strides = std::move(strides), rule.first_replicates = first_replicates, rule.budget = budget;
  return rule;
}

using Runs = std::vector<std::size_t>;
using Samples = std::map<std::size_t, std::string>;  // runs, by cell

std::string of_200(std::size_t events) {
  return std::string(events, '+') + std::string(200 - events, '-');
}

TEST(NextRound, AsksForTheNextRunsOfTheseCells) {
  const Samples corners = {{0, "----"}, {2, "----"}, {6, "----"}, {8, "++++"}};
  const Samples unsure = {{0, "+-"}, {4, "++--"}};  // 6 runs; cell 2 has none
  const Samples failed = {{0, "x-"}, {2, "++++"}};
  const struct {
    const char* why;
    std::vector<int> lengths;
    int replicates;
    Samples samples;
    RefinementRule rule;
    std::vector<std::size_t> cells;  // one for each requested run
  } rows[] = {
      {"half way between cells that disagree",
       {5},
       8,
       {{0, "----"}, {4, "++++"}},
       rule({4}, 4),
       {2, 2, 2, 2}},
      {"and again", {5}, 8, {{0, "----"}, {2, "----"}, {4, "++++"}}, rule({4}, 4), {3, 3, 3, 3}},
      {"there is no cell in between at the finest spacing",
       {5},
       8,
       {{0, "----"}, {2, "----"}, {3, "++++"}, {4, "++++"}},
       rule({4}, 4),
       {}},
      // The event is unlikely with 1 of 4, as with 0 of 4, but 1 of 4 is uncertain.
      {"an uncertain cell again, and half way", {5}, 6, {{0, "----"}, {4, "+---"}}, rule({4}), {2, 4}},
      // 80 of 200 runs are certainly less than half, and 120 certainly more: their intervals are +-0.07 wide.
      {"both below one half", {3}, 200, {{0, of_200(80)}, {2, of_200(0)}}, rule({2}), {}},
      {"both above one half", {3}, 200, {{0, of_200(120)}, {2, of_200(200)}}, rule({2}), {}},
      {"on both sides of one half", {3}, 200, {{0, of_200(80)}, {2, of_200(120)}}, rule({2}), {1}},
      {"the other way round", {3}, 200, {{0, of_200(120)}, {2, of_200(80)}}, rule({2}), {1}},
      {"replicates of an uncertain cell", {1}, 6, {{0, "+-"}}, rule({1}, 3), {0, 0, 0}},
      {"up to the maximum", {1}, 6, {{0, "++---"}}, rule({1}, 3), {0}},
      {"no more", {1}, 6, {{0, "+++---"}}, rule({1}, 3), {}},
      {"cell 3 is no node of spacing 4 or 2", {9}, 4, {{3, "----"}, {7, "++++"}}, rule({4}), {}},
      {"4 is between 0 and 8 at spacing 4", {9}, 4, {{0, "----"}, {8, "++++"}}, rule({4}), {}},
      {"neighbours at spacing 8", {9}, 4, {{0, "----"}, {8, "++++"}}, rule({8}), {4}},
      {"a cell without runs disagrees with none", {9}, 4, {{4, "----"}}, rule({4}), {}},
      {"diagonals are no neighbours", {3, 3}, 4, corners, rule({2, 2}), {5, 7}},
      {"an axis of names has no cells in between", {3, 3}, 4, corners, rule({2, 1}), {5}},
      {"nor have two of them", {3, 3}, 4, corners, rule({1, 1}), {}},
      {"the budget is spent", {5}, 9, unsure, rule({4}, 2, 5), {}},
      {"just spent", {5}, 9, unsure, rule({4}, 2, 6), {}},
      {"the fewest runs first", {5}, 9, unsure, rule({4}, 2, 7), {2}},
      {"two for it", {5}, 9, unsure, rule({4}, 2, 8), {2, 2}},
      {"then another", {5}, 9, unsure, rule({4}, 2, 9), {0, 2, 2}},
      {"all of them", {5}, 9, unsure, rule({4}, 2, 12), {0, 0, 2, 2, 4, 4}},
      {"no more than that", {5}, 9, unsure, rule({4}, 2, 100), {0, 0, 2, 2, 4, 4}},
      // A failed run is not requested again by another round. It counts for the budget, but not for the
      // probability.
      {"a failed run says nothing", {3}, 4, {{0, "x"}, {2, "++++"}}, rule({2}), {}},
      {"a failed run is not repeated", {3}, 4, failed, rule({2}), {0, 1}},
      {"a failed run counts", {3}, 4, failed, rule({2}, 1, 7), {1}},
      {"it spends the budget", {3}, 4, failed, rule({2}, 1, 6), {}},
      {"certainly without the event", {3}, 6, {{0, "----"}, {2, "----"}}, rule({2}), {}},
      {"unknown outcomes are not certain", {3}, 6, {{0, "---?"}, {2, "----"}}, rule({2}), {0, 1}}};
  for (const auto& row : rows) {
    SweepResult result = empty_grid(row.lengths, row.replicates);
    for (const auto& [cell, runs] : row.samples) sample(result, cell, runs);
    std::map<std::size_t, int> next;
    for (const auto& [cell, runs] : row.samples) next[cell] = static_cast<int>(runs.size());
    Runs expected;
    for (const std::size_t cell : row.cells) expected.push_back(result.run(cell, next[cell]++));
    EXPECT_EQ(next_round(result, row.rule), expected) << row.why;
  }
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
    sample(result, cell, above_line(cell, mirrored) != turned ? "++++" : "----");
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

}  // namespace
}  // namespace remote_touch::refinement_test
