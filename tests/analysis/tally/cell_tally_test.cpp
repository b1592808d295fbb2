// The tally of a cell.
#include "analysis/tally/cell_tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/analysis/tally/example_tally.h"
#include "tests/support/test_files.h"

namespace remote_touch::cell_tally_test {
namespace {

const TallyLayout kLayout{3, 3, {1}};

CellTally tally_of(const std::vector<std::uint64_t>& numbers) {
  CellTally tally(kLayout);
  for (const std::uint64_t number : numbers)
    if (const ExampleRun run = example_run(number); run.error.empty())
      tally.add_done(kLayout, number, run.values, run.notes);
    else
      tally.add_failed(number, run.error);
  return tally;
}

TEST(CellTally, CountsItsRuns) {
  CellTally tally(kLayout);
  const double nan = std::nan("");
  tally.add_done(kLayout, 12, std::vector<double>{1.5, 1, nan}, 0b101);
  tally.add_done(kLayout, 10, std::vector<double>{2.5, 1, 3}, 0b001);
  tally.add_done(kLayout, 11, std::vector<double>{3.5, nan, 4}, 0);
  tally.add_failed(19, "late"), tally.add_failed(15, "early"), tally.add_failed(17, "between");
  EXPECT_EQ(tally.done, 3);
  EXPECT_EQ(tally.failed, 3);
  EXPECT_EQ(tally.runs(), 6);
  EXPECT_EQ(tally.first_failed, 15u);
  EXPECT_EQ(tally.first_error, "early");
  EXPECT_EQ(tally.measures[0].mean(), 2.5);
  EXPECT_EQ(tally.measures[1].unknown, 1);
  EXPECT_EQ(tally.measures[2].values, 2);
  EXPECT_EQ(tally.notes[0], (NoteTally{2, 10}));
  EXPECT_EQ(tally.notes[1], NoteTally());
  EXPECT_EQ(tally.notes[2], (NoteTally{1, 12}));
  EXPECT_EQ(tally.events[0], (std::vector<std::uint64_t>{10, 12}));
  EXPECT_EQ(tally.contradiction(), "");
}

TEST(CellTally, ListsNoRunsWithoutEvents) {
  const TallyLayout layout{1, 0, {}};
  CellTally tally(layout);
  tally.add_done(layout, 0, std::vector<double>{1}, 0);
  EXPECT_TRUE(tally.events.empty());
  EXPECT_TRUE(tally.notes.empty());
}

TEST(CellTally, IsTheSameForAnyOrderAndParts) {
  std::mt19937_64 random(1);
  std::vector<std::uint64_t> numbers = numbers_below(200);
  const CellTally whole = tally_of(numbers);
  for (int round = 0; round < 30; ++round) {
    std::shuffle(numbers.begin(), numbers.end(), random);
    std::vector<CellTally> parts;
    for (std::size_t at = 0; at < numbers.size();) {
      const std::size_t count = std::min<std::size_t>(random() % 30, numbers.size() - at);
      const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(at);
      parts.push_back(tally_of({first, first + static_cast<std::ptrdiff_t>(count)}));
      at += count;
    }
    // Merged in pairs, as parts of parts.
    while (parts.size() > 1) {
      const std::size_t at = random() % (parts.size() - 1);
      parts[at].add(parts[at + 1]);
      parts.erase(parts.begin() + static_cast<std::ptrdiff_t>(at) + 1);
    }
    ASSERT_TRUE(parts[0] == whole);
  }
}

TEST(CellTally, NoticesAContradiction) {
  const auto expect_wrong = [](auto&& change) {
    CellTally tally = tally_of(numbers_below(40));
    ASSERT_EQ(tally.contradiction(), "");
    change(tally);
    EXPECT_NE(tally.contradiction(), "");
  };
  expect_wrong([](CellTally& tally) { ++tally.done; });
  expect_wrong([](CellTally& tally) { tally.failed = -1; });
  expect_wrong([](CellTally& tally) { tally.failed = 0; });
  expect_wrong([](CellTally& tally) { ++tally.measures[1].values; });
  expect_wrong([](CellTally& tally) { ++tally.measures[1].values, --tally.measures[1].unknown; });
  expect_wrong([](CellTally& tally) { tally.notes[0].runs = 1000; });
  expect_wrong([](CellTally& tally) { std::swap(tally.events[0].front(), tally.events[0].back()); });
  expect_wrong([](CellTally& tally) { tally.events[0].push_back(tally.events[0].back()); });
}

}  // namespace
}  // namespace remote_touch::cell_tally_test
