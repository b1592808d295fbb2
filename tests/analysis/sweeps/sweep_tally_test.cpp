#include "analysis/sweeps/sweep_tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

#include "analysis/sweeps/sweep_means.h"
#include "tests/analysis/sweeps/example_tally.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_tally_test {
namespace {

// Tallies of parts of a sweep, and what they are when added to each other.

std::vector<RunRange> ranges_of(const std::set<std::uint64_t>& runs) {
  std::vector<RunRange> ranges;
  for (const std::uint64_t run : runs)
    if (!ranges.empty() && ranges.back().end == run)
      ++ranges.back().end;
    else
      ranges.push_back({run, run + 1});
  return ranges;
}

RunRanges runs_in(const std::set<std::uint64_t>& runs) {
  RunRanges ranges;
  for (const RunRange& range : ranges_of(runs)) ranges.add(range);
  return ranges;
}

TEST(RunRanges, AgreeWithSetsOfRuns) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::uint64_t> order = numbers_below(40);
    std::shuffle(order.begin(), order.end(), random);
    std::set<std::uint64_t> one, other, both;
    RunRanges ranges;
    for (std::size_t i = 0; i < 12; ++i) {
      one.insert(order[i]), ranges.add({order[i], order[i] + 1});
      ASSERT_EQ(ranges.ranges(), ranges_of(one));
    }
    for (std::size_t i = 12; i < 25; ++i) other.insert(order[i]);
    both = one, both.insert(other.begin(), other.end());
    RunRanges sum = runs_in(one);
    sum.add(runs_in(other));
    ASSERT_EQ(sum.ranges(), ranges_of(both));
    ASSERT_EQ(sum.count(), both.size());
    const RunRange range{random() % 20, 20 + random() % 20};
    std::set<std::uint64_t> missing;
    std::uint64_t inside = 0;
    for (std::uint64_t run = range.first; run < range.end; ++run)
      both.contains(run) ? void(++inside) : void(missing.insert(run));
    ASSERT_EQ(sum.missing_in(range).ranges(), ranges_of(missing));
    ASSERT_EQ(sum.count_in(range), inside);
    ASSERT_EQ(sum.first_common(runs_in(missing)), RunRange());
    if (inside == 0) continue;
    const std::uint64_t common = *both.lower_bound(range.first);
    RunRanges asked;
    asked.add(range);
    ASSERT_EQ(sum.first_common(asked).first, common);
    ASSERT_EQ(asked.first_common(sum), sum.first_common(asked));
  }
}

TEST(SweepTally, DoesNotDependOnOrderOrParts) {
  const SweepTally whole = example_tally(20);
  EXPECT_TRUE(whole.is_whole());
  EXPECT_EQ(whole.cells, numbers_below(6));
  EXPECT_EQ(whole.contradiction(), "");
  std::mt19937_64 random(2);
  std::vector<std::uint64_t> numbers = numbers_below(whole.run_count());
  for (int round = 0; round < 20; ++round) {
    std::shuffle(numbers.begin(), numbers.end(), random);
    SweepTally merged = example_plan(20);
    for (std::size_t at = 0; at < numbers.size();) {
      const std::size_t count = std::min<std::size_t>(1 + random() % 30, numbers.size() - at);
      const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(at);
      SweepTally part = example_plan(20);
      add_example_runs(part, {first, first + static_cast<std::ptrdiff_t>(count)});
      ASSERT_EQ(part.contradiction(), "");
      ASSERT_EQ(part.missing().count(), whole.run_count() - count);
      merged.add(std::move(part));
      ASSERT_EQ(merged.contradiction(), "");
      at += count;
    }
    ASSERT_TRUE(same_tally(merged, whole));
  }
}

TEST(SweepTally, KeepsCellsWithRunsOnly) {
  SweepTally part = example_plan(10);
  add_example_runs(part, {41, 5, 40});
  EXPECT_EQ(part.cells, (std::vector<std::uint64_t>{0, 4}));
  EXPECT_EQ(part.held.ranges(), (std::vector<RunRange>{{5, 6}, {40, 42}}));
  EXPECT_EQ(part.tallies[1].runs(), 2);
  EXPECT_FALSE(part.is_whole());
}

TEST(SweepTally, NamesDoubledRuns) {
  SweepTally one = example_plan(10), other = example_plan(10);
  add_example_runs(one, {1, 2, 3, 12, 13, 14, 15});
  add_example_runs(other, {13, 14, 15, 16});
  const SweepTally before = one;
  EXPECT_EQ(one.obstacle(other), "runs 13 to 15 are in both");
  EXPECT_HAS(refusal([&] { one.add(other); }), "tallies: runs 13 to 15 are in both");
  EXPECT_TRUE(same_tally(one, before));
  SweepTally third = example_plan(10);
  add_example_runs(third, {3});
  EXPECT_EQ(one.obstacle(third), "run 3 is in both");
  EXPECT_THROW(add_example_runs(third, {3}), std::invalid_argument);
  EXPECT_THROW(add_example_runs(third, {60}), std::invalid_argument);
  EXPECT_EQ(third.contradiction(), "");
}

TEST(SweepTally, RefusesPartsOfAnotherSweep) {
  const SweepTally plan = example_plan(10);
  const auto obstacle = [&](auto&& change) {
    SweepTally other = plan;
    change(other);
    return plan.obstacle(other);
  };
  EXPECT_EQ(obstacle([](SweepTally&) {}), "");
  EXPECT_HAS(obstacle([](SweepTally& t) { std::get<std::vector<double>>(t.axes[1].values)[1] = 0.2; }),
             "their axes sigma_m differ");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.axes[0].value_names[0] = "free"; }), "their axes rule differ");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.axes.pop_back(); }), "their axes are rule, sigma_m and rule");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.measures[0].units = "mN"; }), "their measures jump differ");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.measures.pop_back(); }), "their measures are");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.replicates = 11; }), "10 and 11 replicates");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.note_kinds[0] = "x"; }), "kinds of notes");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.keeps_events = false; }), "only one of them keeps the runs");
}

TEST(SweepTally, NoticesAContradiction) {
  const auto expect_wrong = [](auto&& change) {
    SweepTally tally = example_tally(20);
    change(tally);
    EXPECT_NE(tally.contradiction(), "");
  };
  expect_wrong([](SweepTally& tally) { tally.cells.pop_back(); });
  expect_wrong([](SweepTally& tally) { tally.cells[1] = tally.cells[0]; });
  expect_wrong([](SweepTally& tally) { tally.cells.back() = 6; });
  expect_wrong([](SweepTally& tally) { tally.tallies[0].add_failed(3, "once more"); });
  expect_wrong([](SweepTally& tally) { tally.tallies[0].measures.pop_back(); });
  expect_wrong([](SweepTally& tally) { tally.held = {}; });
  expect_wrong([](SweepTally& tally) { tally.cells.pop_back(), tally.tallies.pop_back(); });
  expect_wrong([](SweepTally& tally) { tally.tallies[0].first_failed = 20; });
  expect_wrong([](SweepTally& tally) { tally.tallies[0].events[0].back() = 20; });
  expect_wrong([](SweepTally& tally) { tally.tallies[1].notes[0].first = 1; });
}

// Means of a tally, on runs made by hand.

template <class T>
T first_of(const Table& table, const std::string& name) {
  for (const Column& column : table.columns)
    if (column.name == name) return std::get<std::vector<T>>(column.values).front();
  return {};
}

// Four runs of the first cell: two kinds of notes in the first run, and a value that is infinite in the
// third.
TEST(TallyMeans, CountNotesAndRunsWithoutAValue) {
  SweepTally tally = example_plan(4);
  const TallyLayout layout = tally.layout();
  const auto add = [&](std::uint64_t run, double jump, std::uint64_t notes) {
    tally.add_done(layout, run, std::vector<double>{jump, 0, 0}, notes);
  };
  add(0, 1, 0b011), add(1, 2, 0b001), add(2, INFINITY, 0), add(3, 6, 0b100);
  EXPECT_EQ(noted_runs(tally, 0), 2);
  EXPECT_EQ(noted_runs(tally, 1), 0);
  const Table table = sweep_means(tally, "jump", {0, 1}, independent_streams(6));
  EXPECT_EQ(first_of<double>(table, "value"), 3);
  EXPECT_EQ(first_of<std::int32_t>(table, "runs"), 3);
  EXPECT_EQ(first_of<std::int32_t>(table, "unknown"), 1);
  EXPECT_EQ(first_of<std::int32_t>(table, "noted_runs"), 2);
  EXPECT_NE(first_of<std::string>(table, "note").find("of 3 of 4 runs that have a value"), std::string::npos);
}

}  // namespace
}  // namespace remote_touch::sweep_tally_test
