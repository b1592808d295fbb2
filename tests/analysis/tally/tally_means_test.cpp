// Means of a tally, on runs made by hand.
#include "analysis/tally/tally_means.h"

#include <gtest/gtest.h>

#include "tests/analysis/tally/example_tally.h"

namespace remote_touch::tally_means_test {
namespace {

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
  SweepResult outline;
  outline.axes = tally.axes, outline.replicates = tally.replicates;
  const Table table = tally_means(tally, outline, 0, {0, 1}, independent_streams(6));
  EXPECT_EQ(first_of<double>(table, "value"), 3);
  EXPECT_EQ(first_of<std::int32_t>(table, "runs"), 3);
  EXPECT_EQ(first_of<std::int32_t>(table, "unknown"), 1);
  EXPECT_EQ(first_of<std::int32_t>(table, "noted_runs"), 2);
  EXPECT_NE(first_of<std::string>(table, "note").find("of 3 of 4 runs that have a value"), std::string::npos);
}

}  // namespace
}  // namespace remote_touch::tally_means_test
