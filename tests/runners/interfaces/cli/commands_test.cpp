#include <gtest/gtest.h>

#include <filesystem>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "analysis/sweeps/sweep_file.h"
#include "core/kernels/kernels.h"
#include "runners/interfaces/cli/outputs.h"
#include "runners/interfaces/cli/program.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::commands_test {
namespace {

namespace fs = std::filesystem;

// A run takes a millisecond.
constexpr const char* kQuick = R"({"title": "quick", "experiment": "fig4.12",
  "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
  "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 2}],
  "replicates": 2, "measures": ["max_penetration"]})";

constexpr const char* kNone = "no InputError";

// The program without messages, as each command gets it.
CommandLine quiet_line() {
  CommandLine line;
  line.quiet = true;
  line.kernels = &kernels_for(best_isa());
  return line;
}

TEST(OtherKind, NamesTheCommand) {
  EXPECT_EQ(other_kind("4.12", "run"), "is a figure: expected `remote-touch figure 4.12 -o FOLDER`");
  EXPECT_EQ(other_kind("fig4.13", "run"), "is a sweep: expected `remote-touch sweep fig4.13 -o FILE`");
  EXPECT_EQ(other_kind("fig4.12", "sweep"), "is an experiment: expected `remote-touch run fig4.12 -o FILE`");
  EXPECT_EQ(other_kind("fig4.13", "figure"), "is a sweep: expected `remote-touch sweep fig4.13 -o FILE`");
  EXPECT_EQ(other_kind("figbounds", "figure"),
            "is a figure: expected `remote-touch figure bounds -o FOLDER`");
}

TEST(OtherKind, IsEmptyForTheCommandsOwnNamesForFilesAndForNoWord) {
  EXPECT_EQ(other_kind("fig4.12", "run"), "");
  EXPECT_EQ(other_kind("fig4.13", "sweep"), "");
  EXPECT_EQ(other_kind("4.13", "figure"), "");
  EXPECT_EQ(other_kind("/dev/null", "run"), "");
  EXPECT_EQ(other_kind("nonsense", "run"), "");
  EXPECT_EQ(other_kind("", "run"), "");
}

// Tests of the text that the command `hashes` prints.

std::string printed(int ticks) {
  const TestFolder folder("hashes");
  const std::string trace = (folder / "trace.h5").string(), hashes = (folder / "hashes.h5").string();
  write_trace(trace, awkward_trace(ticks), kProvenance, {});
  HashesRequest request;
  request.trace = trace, request.output = hashes, request.every = 1;
  testing::internal::CaptureStdout();
  EXPECT_EQ(command_hashes({}, request), kDone);
  return testing::internal::GetCapturedStdout();
}

TEST(Hashes, NameTheirLastTickIfThereIsOne) {
  EXPECT_HAS(printed(3), "hashes.h5: 3 hashes, the last of tick 2\n");
  EXPECT_HAS(printed(0), "hashes.h5: 0 hashes\n");
}

// The estimate of `sweep --dry-run`.

std::string printed(const CommandLine& line, const SweepRequest& request) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(command_sweep(line, request), kDone);
  return testing::internal::GetCapturedStdout();
}

TEST(DryRun, HasNoTimeToEstimateIfNoRunIsLeft) {
  const TestFolder folder("dry_run");
  const CommandLine line = quiet_line();
  SweepRequest request;
  request.sweep = folder.write("quick.json", kQuick).string();
  request.output = (folder / "map.h5").string(), request.shard = "1/1", request.dry_run = true;
  EXPECT_HAS(printed(line, request), " in the 4 that were tried)\n");
  request.dry_run = false;
  printed(line, request);
  request.dry_run = true;
  const std::string done = printed(line, request);
  EXPECT_HAS(done, "0 runs to do, all valid; 4 are done\n  no time to estimate: no run was tried\n");
  EXPECT_EQ(done.find("about"), std::string::npos) << done;
}

TEST(DryRun, RefusesATallyThatTheSweepWouldRefuse) {
  const TestFolder folder("dry_run");
  const CommandLine line = quiet_line();
  SweepRequest request;
  request.sweep = folder.write("quick.json", kQuick).string(), request.dry_run = true;
  request.overrides = {"keep=tally"};
  EXPECT_HAS(printed(line, request), "4 runs to do, all valid\n");
  request.overrides.emplace_back(
      R"(axes=[{"parameter": "seed", "from": 0, "to": 1000, "count": 1001},
               {"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 1000}])");
  EXPECT_HAS(refusal([&] { command_sweep(line, request); }), "has 1001000 cells: expected 1 to 1000000");
}

// Each run is tried once if there are fewer than it would try.
TEST(DryRun, TriesEachOfFewRuns) {
  const TestFolder folder("dry_run");
  const CommandLine line = quiet_line();
  SweepRequest request;
  request.sweep = folder.write("quick.json", kQuick).string(), request.dry_run = true;
  request.overrides = {"duration_s=0.01"};
  EXPECT_HAS(printed(line, request), "note on the runs that were tried: 4 of 4 runs: no contact");
}

// A dry run reads the file as the sweep does.
TEST(DryRun, KnowsWhatATallyHas) {
  const TestFolder folder("dry_run");
  const CommandLine line = quiet_line();
  SweepRequest request;
  request.sweep = folder.write("quick.json", kQuick).string(), request.overrides = {"keep=tally"};
  request.output = (folder / "tally.h5").string();
  printed(line, request);
  request.dry_run = true;
  EXPECT_HAS(printed(line, request), "0 runs to do, all valid; 4 are done\n  no time to estimate");
  request.overrides.emplace_back("replicates=3");
  EXPECT_HAS(refusal([&] { command_sweep(line, request); }), "tally.h5: is of another configuration");
}

// A command writes no file twice, and none that it reads.

class Outputs : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  static std::string refusal_of(const std::string& json, const std::string& junit) {
    return refusal([&] { require_distinct({{"--json", json}, {"--plot", ""}, {"--junit", junit}}); });
  }
  const TestFolder folder_{"outputs_test"};
};

TEST_F(Outputs, OneFileForTwoOptionsIsRefusedHoweverItIsWritten) {
  fs::create_directory(folder_ / "sub");
  fs::create_directory_symlink(folder_ / "sub", folder_ / "other");
  fs::create_symlink("sub/report", folder_ / "link");  // to a file that does not exist yet
  EXPECT_EQ(refusal_of(file("x"), file("x")),
            "--junit " + file("x") + ": is also the file of --json: expected another file");
  const std::string here = fs::relative(folder_.path()).string();
  for (const std::string& same : {file("sub/../x"), file("./x"), here + "/x", file("other/../x")})
    EXPECT_HAS(refusal_of(file("x"), same), "is also the file of --json") << same;
  EXPECT_HAS(refusal_of(file("sub/x"), file("other/x")), "is also the file of --json");
  EXPECT_HAS(refusal_of(file("sub/report"), file("link")), "is also the file of --json");
  EXPECT_EQ(refusal_of(file("x"), file("y")), kNone);
  EXPECT_EQ(refusal_of(file("x"), file("sub/x")), kNone);
}

TEST_F(Outputs, TwoNamesOfOneFileAreRefused) {
  folder_.write("x", "x");
  fs::create_hard_link(folder_ / "x", folder_ / "y");
  EXPECT_HAS(refusal_of(file("x"), file("y")), "is also the file of --json");
}

TEST_F(Outputs, AnEmptyNameAndADeviceMayComeTwice) {
  EXPECT_EQ(refusal_of("", ""), kNone);
  EXPECT_EQ(refusal_of("/dev/null", "/dev/null"), kNone);
}

// An input is no output, not even with --force.
TEST_F(Outputs, AnInputOrAPlugInIsNoOutput) {
  CommandLine line;
  line.force = true;
  line.plugins = {folder_.write("mine.so", "a library").string()};
  const std::string input = folder_.write("in.h5", "a result").string();
  for (const std::string& read : {input, line.plugins.front()})
    EXPECT_HAS(refusal([&] { require_report(line, read, {input}, kJsonReport); }), "is the input file");
}

// A run takes minutes: its output is checked before it and again after it.
TEST_F(Outputs, AFileThatAppearsMeanwhileIsKeptUnlessForced) {
  CommandLine line;
  for (const bool force : {false, true}) {
    line.force = force;
    const std::string output = file(force ? "forced.h5" : "late.h5");
    const FileLock lock = lock_output(line, output, {});
    folder_.write(fs::path(output).filename(), "precious notes");
    const std::string problem = refusal([&] { write_file_atomically(output, "new", 3); });
    EXPECT_EQ(bytes_of(output), force ? "new" : "precious notes");
    EXPECT_HAS(problem, force ? kNone : "late.h5: was written by another program");
  }
  const std::string report = file("report.json");
  require_report(CommandLine{}, report, {}, kJsonReport);
  folder_.write("report.json", "");  // by a shell that redirects to it
  EXPECT_EQ(refusal([&] { write_file_atomically(report, "new", 3); }), kNone);
  EXPECT_EQ(bytes_of(report), "new");
}

TEST(ProgressText, StatesTheKnownProgress) {
  EXPECT_EQ(progress_text(0.25, 10), " 25 %, 2.5 %/s, 30 s left");
  EXPECT_EQ(progress_text(1, 10), "100 %, 10.0 %/s, 0 s left");
  EXPECT_EQ(progress_text(30, 100, 10, "runs", 10), "30 of 100 runs, 2/s, 35 s left");
}

// The remaining time is unknown before anything is done, which differs from 0 s.
TEST(ProgressText, PromisesNothingBeforeAnythingIsDone) {
  EXPECT_EQ(progress_text(0, 10), "  0 %");
  EXPECT_EQ(progress_text(10, 100, 10, "runs", 10), "10 of 100 runs");
  EXPECT_EQ(progress_text(0, 100, 0, "runs", 0), "0 of 100 runs");
}

// Tests of the files that the command `merge` may overwrite.

class Merge : public testing::Test {
 protected:
  Merge() {
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
  CommandLine line_ = quiet_line();
  std::vector<std::string> shards_;
  std::string longer_;
};

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
}  // namespace remote_touch::commands_test
