// The part of a sweep that a process runs.
#include "runners/sweep/shard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "analysis/trace/trace.h"
#include "runners/sweep/sweep.h"
#include "tests/support/test_files.h"

namespace remote_touch::shard_test {
namespace {

// 12 cells of 2 replicates.
Sweep twelve(const std::vector<std::string>& overrides = {}) {
  return Sweep::from_json(R"({"experiment": "fig4.12", "replicates": 2,
    "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.01, "count": 3},
             {"parameter": "renderer.steps_per_tick", "values": [1, 2, 3, 30]}]})",
                          "twelve.json", overrides);
}

// Every cell of the first round has one shard, all its replicates in it, and shards differ by one cell at
// most.
TEST(Shards, ShareTheCells) {
  for (const Sweep& sweep : {twelve(), twelve({"refine.budget=99", "refine.levels=1"})})
    for (const int count : {1, 2, 3, 7, 20}) {
      const SweepResult whole = sweep.plan();
      std::vector<int> owners(whole.run_count(), 0);
      std::size_t min_count = whole.run_count(), max = 0;
      for (int index = 1; index <= count; ++index) {
        const SweepResult part = sweep.plan({index, count});
        for (std::size_t run = 0; run < part.run_count(); ++run) {
          owners[run] += part.state[run] == RunState::pending;
          // All replicates of a cell belong together. Runs that no shard does are not sampled in any.
          const bool owned = part.state[part.run(part.cell_of(run), 0)] == RunState::pending;
          const RunState expected = whole.state[run] != RunState::pending ? RunState::not_sampled
                                    : owned                               ? RunState::pending
                                                                          : RunState::elsewhere;
          EXPECT_EQ(part.state[run], expected);
        }
        min_count = std::min(min_count, part.runs_in(RunState::pending).size());
        max = std::max(max, part.runs_in(RunState::pending).size());
      }
      for (std::size_t run = 0; run < owners.size(); ++run)
        EXPECT_EQ(owners[run], whole.state[run] == RunState::pending ? 1 : 0);
      EXPECT_LE(max - min_count, 2u);  // replicates of one cell
    }
}

TEST(Shards, AreWrittenAsIndexOfCount) {
  EXPECT_EQ(parse_shard("2/7").index, 2);
  EXPECT_EQ(parse_shard("2/7").count, 7);
  EXPECT_EQ(parse_shard("1/1").text(), "1/1");
  for (const char* text : {"", "/", "3", "1/", "/3", "0/3", "4/3", "-1/3", "1/-3", "1/0", "a/b", "1/3/5",
                           " 1/3", "1/3 ", "+1/3", "1.0/3", "1/1000001", "99999999999/99999999999"}) {
    const std::string why = refusal([&] { parse_shard(text); });
    EXPECT_HAS(why, std::string("--shard ") + text + ": expected i/N");
  }
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
             *step = "SLURM_ARRAY_TASK_STEP", *rank = "OMPI_COMM_WORLD_RANK", *size = "OMPI_COMM_WORLD_SIZE";
  EXPECT_EQ(from_environment({}), "none");
  EXPECT_EQ(from_environment({{id, "2"}, {count, "3"}, {min, "1"}, {step, "1"}}), "2/3");
  EXPECT_EQ(from_environment({{id, "0"}, {count, "3"}}), "1/3");  // --array=0-2
  EXPECT_EQ(from_environment({{id, "14"}, {count, "3"}, {min, "10"}, {step, "2"}}),
            "3/3");  // --array=10-14:2
  EXPECT_EQ(from_environment({{rank, "0"}, {size, "4"}}), "1/4");
  EXPECT_EQ(from_environment({{rank, "3"}, {size, "4"}}), "4/4");
  EXPECT_EQ(from_environment({{id, "1"}, {count, "2"}, {min, "1"}, {rank, "3"}, {size, "4"}}), "1/2");
  EXPECT_EQ(from_environment({{rank, "3"}}), "none");
  EXPECT_EQ(from_environment({{id, ""}, {count, ""}, {rank, ""}, {size, "4"}}), "none");  // empty is not set
  EXPECT_HAS(from_environment({{id, "two"}, {count, "3"}}), "SLURM_ARRAY_TASK_ID = two: expected integers");
  EXPECT_HAS(from_environment({{id, "-1"}, {count, "3"}}), "SLURM_ARRAY_TASK_ID = -1: expected");
  EXPECT_HAS(from_environment({{id, "7"}, {count, "3"}, {min, "1"}}),
             "SLURM_ARRAY_TASK_ID = 7: expected i/N");
  EXPECT_HAS(from_environment({{rank, "4"}, {size, "4"}}), "OMPI_COMM_WORLD_RANK = 4: expected i/N");
  EXPECT_HAS(from_environment({{rank, "1"}, {size, "1.5"}}), "OMPI_COMM_WORLD_SIZE = 1.5: expected integers");
}

}  // namespace
}  // namespace remote_touch::shard_test
