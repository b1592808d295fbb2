// Tests of the files that the command `merge` may overwrite.
#include <gtest/gtest.h>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "analysis/sweeps/sweep_file.h"
#include "core/kernels/kernels.h"
#include "runners/interfaces/cli/program.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_test {
namespace {

// A run takes a millisecond.
constexpr const char* kQuick = R"({"title": "quick", "experiment": "fig4.12",
  "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
  "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 2}],
  "replicates": 2, "measures": ["max_penetration"]})";

class Merge : public testing::Test {
 protected:
  Merge() {
    line_.quiet = true;
    line_.kernels = &kernels_for(best_isa());
    const std::string sweep = folder_.write("quick.json", kQuick).string();
    for (const char* shard : {"1/2", "2/2"})
      shards_.push_back(
          sweep_to(sweep, {}, file("part" + std::to_string(shards_.size() + 1) + ".h5"), shard));
    longer_ = sweep_to(sweep, {"replicates=3"}, file("longer.h5"), "1/1");
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string sweep_to(const std::string& sweep, const std::vector<std::string>& overrides,
                       const std::string& output, const std::string& shard) const {
    SweepRequest request;
    request.sweep = sweep, request.overrides = overrides, request.output = output, request.shard = shard;
    testing::internal::CaptureStdout();
    EXPECT_EQ(command_sweep(line_, request), kDone);
    testing::internal::GetCapturedStdout();
    return output;
  }
  std::string merged_to(const std::string& output) const { return merged({shards_, output}); }
  // Returns the refusal. printed: what the command printed.
  std::string merged(const MergeCommand& command, std::string* printed = nullptr) const {
    testing::internal::CaptureStdout();
    const std::string why = refusal([&] { EXPECT_EQ(command_merge(line_, command), kDone); });
    const std::string text = testing::internal::GetCapturedStdout();
    if (printed) *printed = text;
    return why;
  }

  const TestFolder folder_{"merge_test"};
  CommandLine line_;
  std::vector<std::string> shards_;
  std::string longer_;
};

constexpr const char* kNone = "no InputError";

TEST_F(Merge, ReplacesAnotherFileOnlyIfForced) {
  const std::string output = folder_.write("notes.txt", "precious notes").string();
  EXPECT_HAS(merged_to(output), "notes.txt: exists already and is not a result of this program");
  EXPECT_EQ(bytes_of(output), "precious notes");
  line_.force = true;
  EXPECT_EQ(merged_to(output), kNone);
  EXPECT_EQ(read_sweep(output).result.runs_in(RunState::done).size(), 4u);
}

TEST_F(Merge, ReplacesAnEmptyFileAndItsOwnResult) {
  const std::string output = folder_.write("empty.h5", "").string();
  for (int time = 0; time < 2; ++time) EXPECT_EQ(merged_to(output), kNone);
  EXPECT_EQ(read_sweep(output).result.runs_in(RunState::done).size(), 4u);
}

// Not even with --force.
TEST_F(Merge, KeepsAPlugInAShardAndASweepWithMoreRuns) {
  line_.force = true;
  line_.plugins = {folder_.write("mine.so", "a library").string()};
  EXPECT_HAS(merged_to(line_.plugins.front()), "is the input file");
  EXPECT_EQ(bytes_of(line_.plugins.front()), "a library");
  EXPECT_HAS(merged_to(shards_.front()), "is one of the shards");
  EXPECT_HAS(merged_to(longer_), "holds runs that the shards do not");
  EXPECT_EQ(read_sweep(longer_).result.runs_in(RunState::done).size(), 6u);
}

// A file with runs that nothing else holds is kept, of whatever kind it and the merged shards are.
TEST_F(Merge, KeepsRunsThatTheShardsLack) {
  line_.force = true;
  const std::string sweep = (folder_ / "quick.json").string();
  std::vector<std::string> parts, outputs{folder_.write("live.h5", std::string(kJournalOpening)).string()};
  for (const std::string keep : {"runs", "tally"}) {
    parts.push_back(sweep_to(sweep, {"keep=" + keep}, file("part-" + keep + ".h5"), "1/2"));
    const std::string other = sweep_to(sweep, {"keep=" + keep}, file("other-" + keep + ".h5"), "2/2");
    outputs.push_back(other);
    outputs.push_back(sweep_to(sweep, {"keep=" + keep}, file("whole-" + keep + ".h5"), "1/1"));
    outputs.push_back(file("merged-" + keep + ".h5"));
    ASSERT_EQ(merged({{parts.back(), other}, outputs.back()}), kNone);
  }
  for (const std::string& part : parts) {
    for (const std::string& output : outputs) {
      const std::string before = bytes_of(output);
      EXPECT_THROW(command_merge(line_, {{part}, output, true}), KeptFile) << part << ", " << output;
      EXPECT_TRUE(bytes_of(output) == before) << part << ", " << output;
    }
    const std::string damaged = folder_.write("damaged.h5", bytes_of(part) + "x").string();
    EXPECT_EQ(merged({{part}, damaged, true}), kNone);  // --force is for such a file
    EXPECT_TRUE(bytes_of(damaged) == bytes_of(part));
  }
}

// Two cells in three shards.
TEST_F(Merge, OfAnEmptyShardStatesTheSweep) {
  const std::string empty = sweep_to((folder_ / "quick.json").string(), {}, file("empty.h5"), "3/3");
  std::string printed;
  EXPECT_EQ(merged({{empty}, file("all.h5"), true}, &printed), kNone);
  EXPECT_HAS(printed, "all.h5: 2 cells, 0 runs done, 0 failed, 4 in other shards");
}

}  // namespace
}  // namespace remote_touch::sweep_test
