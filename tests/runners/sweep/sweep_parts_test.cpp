// The part of a sweep that a process runs, its cells that are checked, and those of its first round.
#include "runners/sweep/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch::sweep_parts_test {
namespace {

// 12 cells of 2 replicates.
Sweep twelve(const std::vector<std::string>& overrides = {}) {
  return Sweep::from_json(R"({"experiment": "fig4.12", "replicates": 2,
    "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.01, "count": 3},
             {"parameter": "renderer.steps_per_tick", "values": [1, 2, 3, 30]}]})",
                          "twelve.json", overrides);
}

// Every run of the first round is in one shard, with all replicates of its cell, and shards differ by one
// cell at most. A shard holds no other run.
TEST(Shards, ShareTheCells) {
  for (const Sweep& sweep : {twelve(), twelve({"refine.budget=99", "refine.levels=1"})})
    for (const int count : {2, 3, 7, 20}) {
      const SweepResult whole = sweep.plan();
      std::vector<int> owners(whole.run_count(), 0);
      std::size_t min_count = whole.run_count(), max = 0;
      for (int index = 1; index <= count; ++index) {
        const SweepResult part = sweep.plan({index, count});
        ASSERT_TRUE(part.part);
        EXPECT_EQ(part.run_count(), whole.run_count());
        EXPECT_EQ(part.runs_in(RunState::pending).size(), part.held_count());
        for (std::size_t place = 0; place < part.held_count(); ++place) {
          const std::size_t run = part.run_at(place);
          ++owners[run];
          EXPECT_EQ(part.place_of(run), place);
          for (int replicate = 0; replicate < 2; ++replicate)
            EXPECT_TRUE(part.place_of(part.run(part.cell_of(run), replicate)));
        }
        min_count = std::min(min_count, part.held_count()), max = std::max(max, part.held_count());
      }
      for (std::size_t run = 0; run < owners.size(); ++run)
        EXPECT_EQ(owners[run], whole.state[run] == RunState::pending ? 1 : 0);
      EXPECT_LE(max - min_count, 2u);  // replicates of one cell
    }
}

// All 1e11 runs would need 6 TB; a shard needs what its own runs need.
TEST(Shards, OfALargeSweepHoldTheirOwnRunsOnly) {
  const std::string noise =
      R"(axes=[{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.01, "count": 100000})";
  const std::string steps =
      R"(, {"parameter": "renderer.steps_per_tick", "from": 1, "to": 100, "count": 100}])";
  const Sweep sweep = twelve({noise + steps, "replicates=10000"});
  const SweepResult part = sweep.plan({3, 1000000});
  EXPECT_EQ(part.run_count(), 100000000000u);
  EXPECT_EQ(part.held_count(), 100000u);
  EXPECT_EQ(part.run_at(0), 20000u) << "cell 2";
  EXPECT_EQ(part.run_at(99999), 90000029999u) << "cell 9 * 1000000 + 2";
  const std::string seeds = R"(, {"parameter": "seed", "from": 1, "to": 100000, "count": 100000})";
  EXPECT_HAS(refusal([&] {
               twelve({noise + seeds + steps, "replicates=10000"});
             }),
             "more than 1000000000000000 runs");
  for (const std::vector<std::uint64_t>& wrong : {std::vector<std::uint64_t>{4, 3}, {3, 3}, {23, 24}})
    EXPECT_THROW(twelve().part(wrong), InputError) << "chosen runs are in order, and there";
}

TEST(Shards, AreWrittenAsIndicesOfACount) {
  const auto text_of = [](const std::string& text) { return parse_shards(text, "a.h5").text(); };
  EXPECT_EQ(text_of("2/7"), "2/7");
  EXPECT_EQ(text_of("1-3,7/1000"), "1-3,7/1000");
  EXPECT_EQ(text_of("7,2,1,3/9"), "1-3,7/9");
  EXPECT_EQ(text_of("1-4/4"), "1-4/4");
  for (const char* text : {"", "/", "3", "1-/3", "-2/3", "0-2/3", "2-4/3", "1,,2/3", "1-2", "a-b/3", "1/3/5"})
    EXPECT_HAS(refusal([&] { parse_shards(text, "a.h5"); }),
               std::string("a.h5: shard ") + text + ": expected i/N");
  EXPECT_EQ(parse_shard("2/7").text(), "2/7");
  for (const char* text :
       {"", "/3", "1/0", " 1/3", "1/3 ", "+1/3", "1.0/3", "1/1000001", "99999999999/99999999999"})
    EXPECT_HAS(refusal([&] { parse_shard(text); }), std::string("--shard ") + text + ": expected i/N");
}

std::string from_environment(const std::vector<std::pair<const char*, const char*>>& variables) {
  const auto value_of = [&](const std::string& name) -> const char* {
    for (const auto& [known, value] : variables)
      if (name == known) return value;
    return nullptr;
  };
  std::string shard = "none";
  const std::string why = refusal([&] {
    if (const auto found = shard_from_environment(value_of)) shard = found->text();
  });
  return why == "no InputError" ? shard : why;
}

TEST(Shards, AreThoseOfSlurmOrMpirun) {
  const char *id = "SLURM_ARRAY_TASK_ID", *count = "SLURM_ARRAY_TASK_COUNT", *min = "SLURM_ARRAY_TASK_MIN",
             *rank = "OMPI_COMM_WORLD_RANK", *size = "OMPI_COMM_WORLD_SIZE";
  EXPECT_EQ(from_environment({}), "none");
  EXPECT_EQ(from_environment({{id, "0"}, {count, "3"}}), "1/3");  // --array=0-2
  EXPECT_EQ(from_environment({{rank, "3"}, {size, "4"}}), "4/4");
  EXPECT_EQ(from_environment({{id, "1"}, {count, "2"}, {min, "1"}, {rank, "3"}, {size, "4"}}), "1/2");
  EXPECT_EQ(from_environment({{rank, "3"}}), "none");
  EXPECT_EQ(from_environment({{id, ""}, {count, ""}, {rank, ""}, {size, "4"}}), "none");  // empty is not set
  EXPECT_HAS(from_environment({{rank, "1"}, {size, "1.5"}}), "OMPI_COMM_WORLD_SIZE = 1.5: expected integers");
}

SweepResult grid(const std::vector<std::size_t>& lengths) {
  SweepResult result;
  for (const std::size_t length : lengths)
    result.axes.push_back({"axis", "1", "an axis", std::vector<double>(length)});
  return result;
}

TEST(CheckedCells, AreAllOfASmallGrid) {
  std::vector<std::size_t> all(6 * 7);
  std::iota(all.begin(), all.end(), std::size_t{0});
  EXPECT_EQ(checked_cells(grid({6, 7})), all);
  EXPECT_EQ(checked_cells(grid({100, 200})).size(), 20000u);
}

// The least gap between neighbours of 20000 spread cells of 1e9 is 50000.
TEST(CheckedCells, OfALargeGridAreSpreadAndHaveEachValue) {
  const SweepResult large = grid({10000, 100, 1000});
  const std::vector<std::size_t> cells = checked_cells(large);
  EXPECT_LE(cells.size(), 20000u + 11100u);
  EXPECT_TRUE(std::is_sorted(cells.begin(), cells.end()));
  EXPECT_EQ(cells.front(), 0u);
  EXPECT_EQ(cells.back(), 999999999u);
  std::vector<std::set<std::size_t>> seen(3);
  for (const std::size_t cell : cells)
    for (std::size_t axis = 0; axis < 3; ++axis) seen[axis].insert(large.axis_indices(cell)[axis]);
  EXPECT_EQ(seen[0].size(), 10000u);
  EXPECT_EQ(seen[1].size(), 100u);
  EXPECT_EQ(seen[2].size(), 1000u);
  for (std::size_t i = 1; i < cells.size(); ++i) EXPECT_LE(cells[i] - cells[i - 1], 50000u);
}

std::vector<SweepAxis> axes(const std::vector<std::pair<std::size_t, std::size_t>>& length_and_stride) {
  std::vector<SweepAxis> all;
  for (const auto& [length, stride] : length_and_stride) {
    SweepAxis axis;
    axis.settings.resize(length), axis.stride = stride;
    all.push_back(axis);
  }
  return all;
}

TEST(FirstRound, HasTheCellsWhoseIndicesAreMultiplesOfTheStrides) {
  const SweepResult result = grid({5, 3, 9});
  const std::vector<SweepAxis> refined = axes({{5, 4}, {3, 1}, {9, 2}});
  std::vector<std::size_t> expected, found;
  for (std::size_t cell = 0; cell < result.cell_count(); ++cell) {
    const std::vector<std::size_t> at = result.axis_indices(cell);
    if (at[0] % 4 == 0 && at[2] % 2 == 0) expected.push_back(cell);
  }
  const FirstRound first(result, refined);
  for (std::size_t i = 0; i < first.count(); ++i) found.push_back(first.cell(i));
  EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace remote_touch::sweep_parts_test
