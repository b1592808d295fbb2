// The spool of runs: many parts, larger than its windows, come back in the order of their numbers.
#include "analysis/sweeps/sweep_file.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/test_files.h"

namespace remote_touch::run_spool_test {
namespace {

constexpr std::size_t kCells = 1'100'000;  // several windows
constexpr std::size_t kParts = 3;

SweepResult outline() {
  SweepResult result;
  result.axes = {{"x", "1", "an axis", std::vector<double>(kCells / 11)},
                 {"y", "1", "another", std::vector<double>(11)}};
  result.measures = {{"force", "N", "a measure", {}}};
  result.note_kinds = {"other"};
  return result;
}

// The values of part p: its runs are p, p + kParts, ..., and each value is a function of the run.
RunSpool::PartValues part_values(std::size_t p) {
  return [p](const std::string& array, std::size_t first, std::size_t count) -> Values {
    std::vector<std::uint64_t> runs(count);
    for (std::size_t i = 0; i < count; ++i) runs[i] = p + (first + i) * kParts;
    if (array == "run") return runs;
    if (array == "force") {
      std::vector<double> values;
      for (const std::uint64_t run : runs) values.push_back(0.5 * static_cast<double>(run));
      return values;
    }
    if (array == "error") {
      std::vector<std::string> texts;
      for (const std::uint64_t run : runs)
        texts.push_back(run % 100'000 == 0 ? "run " + std::to_string(run) : "");
      return texts;
    }
    if (array == "notes") {
      for (std::uint64_t& run : runs) run %= 2;
      return runs;
    }
    std::vector<std::int32_t> numbers;  // the states
    for (const std::uint64_t run : runs) numbers.push_back(run % 100'000 == 0 ? 3 : 2);
    return numbers;
  };
}

std::size_t held(std::size_t p) {
  return (kCells - p + kParts - 1) / kParts;
}

TEST(RunSpool, ReturnsTheRunsOfAllPartsInOrder) {
  const TestFolder folder("run_spool_test");
  RunSpool spool(outline(), false, folder / "out.h5");
  for (const std::size_t p : {2, 0, 1}) spool.add("part", held(p), part_values(p));
  spool.complete(true);
  ASSERT_EQ(spool.outline().held_count(), kCells);
  EXPECT_EQ(spool.longest_error(), 11u) << "run 1000000";
  // Blocks over a boundary of two windows, and in any order.
  for (const std::size_t first : {1'048'570u, 0u, 1'099'990u}) {
    const auto forces = std::get<std::vector<double>>(spool.values("force", first, 10));
    const auto states = std::get<std::vector<std::int32_t>>(spool.values("state", first, 10));
    const auto notes = std::get<std::vector<std::uint64_t>>(spool.values("notes", first, 10));
    const auto errors = std::get<std::vector<std::string>>(spool.values("error", first, 10));
    for (std::size_t i = 0; i < 10; ++i) {
      const std::size_t run = first + i;
      EXPECT_EQ(forces[i], 0.5 * static_cast<double>(run));
      EXPECT_EQ(states[i], run % 100'000 == 0 ? 3 : 2);
      EXPECT_EQ(notes[i], run % 2);
      EXPECT_EQ(errors[i], run % 100'000 == 0 ? "run " + std::to_string(run) : "");
    }
  }
}

TEST(RunSpool, OfSomePartsHoldsTheirRunsOnly) {
  const TestFolder folder("run_spool_test");
  RunSpool spool(outline(), false, folder / "out.h5");
  spool.add("c", held(2), part_values(2)), spool.add("a", held(0), part_values(0));
  spool.complete(false);
  ASSERT_EQ(spool.outline().held_count(), held(0) + held(2));
  EXPECT_EQ((*spool.outline().part)[0], 0u);
  EXPECT_EQ((*spool.outline().part)[1], 2u);
  EXPECT_EQ((*spool.outline().part)[2], 3u);
  const auto forces =
      std::get<std::vector<double>>(spool.values("force", spool.outline().held_count() - 3, 3));
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(forces[i],
              0.5 * static_cast<double>((*spool.outline().part)[spool.outline().held_count() - 3 + i]));
  EXPECT_EQ(std::get<std::vector<std::string>>(spool.values("error", 0, 2)),
            (std::vector<std::string>{"run 0", ""}));
}

TEST(RunSpool, WithoutAPartOrWithOneTwiceIsRefused) {
  const TestFolder folder("run_spool_test");
  RunSpool missing(outline(), false, folder / "out.h5");
  missing.add("a", held(0), part_values(0)), missing.add("b", held(1), part_values(1));
  EXPECT_HAS(refusal([&] { missing.complete(true); }), "no part holds run 2");
  RunSpool doubled(outline(), false, folder / "out.h5");
  doubled.add("a", held(0), part_values(0)), doubled.add("b", held(0), part_values(0));
  EXPECT_HAS(refusal([&] { doubled.complete(false); }), "b: holds run 0, as another part does");
}

// Runs that no part holds are not sampled, if the sweep has refinement.
TEST(RunSpool, WithRefinementMayLackRuns) {
  const TestFolder folder("run_spool_test");
  RunSpool spool(outline(), true, folder / "out.h5");
  spool.add("a", held(0), part_values(0));
  spool.complete(true);
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(spool.values("state", 3, 3)),
            (std::vector<std::int32_t>{2, 0, 0}));
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(spool.values("round", 4, 2)),
            (std::vector<std::int32_t>{-1, -1}));
  EXPECT_TRUE(std::isnan(std::get<std::vector<double>>(spool.values("force", 4, 1)).front()));
}

TEST(RunSpool, RefusesAFolderThatIsNotThere) {
  const TestFolder folder("run_spool_test");
  EXPECT_HAS(refusal([&] { RunSpool(outline(), false, folder / "absent" / "out.h5"); }),
             "out.h5: cannot be written");
}

}  // namespace
}  // namespace remote_touch::run_spool_test
