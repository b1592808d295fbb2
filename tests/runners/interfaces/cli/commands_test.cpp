// Parts of commands: what a word is, estimates, outputs, progress, and what merging keeps.
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <map>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/block_journal.h"
#include "analysis/sweeps/sweep_file.h"
#include "core/kernels/kernels.h"
#include "runners/evaluation/figures/figure_recipe.h"
#include "runners/interfaces/cli/figure.h"
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

TEST(OtherKind, NamesTheCommandOrIsEmpty) {
  EXPECT_EQ(other_kind("fig4.13", "figure"), "is a sweep: expected `remote-touch sweep fig4.13 -o FILE`");
  EXPECT_EQ(other_kind("figbounds", "figure"),
            "is a figure: expected `remote-touch figure bounds -o FOLDER`");
  for (const auto& [name, command] : {std::pair("fig4.12", "run"),
                                      {"fig4.13", "sweep"},
                                      {"4.13", "figure"},
                                      {"/dev/null", "run"},
                                      {"nonsense", "run"},
                                      {"", "run"}})
    EXPECT_EQ(other_kind(name, command), "") << name;
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

// A dry run reads the file as the sweep does.
TEST(DryRun, HasNoTimeToEstimateIfNoRunIsLeft) {
  const TestFolder folder("dry_run");
  const CommandLine line = quiet_line();
  for (const std::string keep : {"runs", "tally"}) {
    SweepRequest request;
    request.sweep = folder.write("quick.json", kQuick).string(), request.overrides = {"keep=" + keep};
    request.output = (folder / (keep + ".h5")).string(), request.shard = "1/1", request.dry_run = true;
    EXPECT_HAS(printed(line, request), " that were tried)\n");
    request.dry_run = false;
    printed(line, request);
    request.dry_run = true;
    const std::string done = printed(line, request);
    EXPECT_HAS(done, "0 runs to do, all valid; 4 are done\n  no time to estimate: no run was tried\n");
    EXPECT_EQ(done.find("about"), std::string::npos) << done;
    request.overrides.emplace_back("replicates=3");
    EXPECT_HAS(refusal([&] { command_sweep(line, request); }), keep + ".h5: is of another configuration");
  }
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

TEST_F(Outputs, ALinkToAFileIsThatFile) {
  fs::create_directory(folder_ / "sub");
  fs::create_directory_symlink(folder_ / "sub", folder_ / "other");
  fs::create_symlink("sub/report", folder_ / "link");  // to a file that does not exist yet
  folder_.write("x", "x");
  fs::create_hard_link(folder_ / "x", folder_ / "y");
  EXPECT_EQ(refusal_of(file("x"), file("y")),
            "--junit " + file("y") + ": is also the file of --json: expected another file");
  EXPECT_HAS(refusal_of(file("sub/x"), file("other/x")), "is also the file of --json");
  EXPECT_HAS(refusal_of(file("sub/report"), file("link")), "is also the file of --json");
  EXPECT_EQ(refusal_of(file("x"), file("z")), kNone);
  EXPECT_EQ(refusal_of(file("x"), file("sub/x")), kNone);
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

// The remaining time is unknown before anything is done, which differs from 0 s.
TEST(ProgressText, StatesTheKnownProgress) {
  EXPECT_EQ(progress_text(0.25, 10), " 25 %, 2.5 %/s, 30 s left");
  EXPECT_EQ(progress_text(1, 10), "100 %, 10.0 %/s, 0 s left");
  EXPECT_EQ(progress_text(30, 100, 10, "runs", 10), "30 of 100 runs, 2/s, 35 s left");
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

// The output and the exit code of the command `figure` for figures that are made side by side.

Figure nothing(FigureContext&) {
  return {};
}

// They have the names of real figures, because claims.json has an order of figures.
const FigureEntry kFirst{"4.11", "the first", nothing, 1}, kSecond{"4.12", "the second", nothing, 2};
const std::vector<FigureRun> kRuns = {{&kFirst}, {&kSecond}};

Claim claim(const std::string& figure, bool holds) {
  return claim_at_most(figure, "a claim of " + figure, "-", holds ? 1 : 3, 2, "m");
}

using Claims = std::map<std::string, std::vector<Claim>>;

struct Told {
  std::string out, err;
  int code = -1;
};

// Makes the figures as command_figure() does.
Told told(const std::filesystem::path& folder, const Claims& claims) {
  const CommandLine line = quiet_line();
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Told result;
  {
    FigureFolder made(line, folder, kRuns);
    Progress shown("figures", line.quiet);
    make_figures(
        line, kRuns,
        [&](const FigureEntry& entry, FigureContext&) {
          Figure figure{entry.name, entry.summary, "caption"};
          figure.claims = claims.at(entry.name);
          return figure;
        },
        [&](std::size_t run, const FigureContext& context, Figure figure) {
          made.finish(run, context, std::move(figure));
        },
        [&](const FigureProgress& progress) { made.report(progress, shown); });
    result.code = made.exit_code();
  }
  result.out = testing::internal::GetCapturedStdout();
  result.err = testing::internal::GetCapturedStderr();
  return result;
}

TEST(FigureFolder, EveryLineOfEveryFigureIsPrintedInTheirOrder) {
  const TestFolder folder("figure_folder_test");
  const Told all = told(folder.path(), {{"4.11", {claim("4.11", true)}}, {"4.12", {claim("4.12", true)}}});
  EXPECT_EQ(all.out, "figure 4.11 -> " + (folder / "fig4.11.h5").string() +
                         "\n  pass    a claim of 4.11: 1 m (at most 2)\n" + "figure 4.12 -> " +
                         (folder / "fig4.12.h5").string() + "\n  pass    a claim of 4.12: 1 m (at most 2)\n");
  EXPECT_EQ(all.err, "");
  EXPECT_EQ(all.code, kDone);
}

TEST(FigureFolder, AFileThatIsNoResultIsNotOverwritten) {
  const TestFolder folder("figure_folder_test");
  const std::filesystem::path file = folder.write("fig4.12.h5", "of someone else");
  const CommandLine line;
  EXPECT_EQ(refusal([&] { FigureFolder(line, folder.path(), kRuns); }),
            file.string() +
                ": exists already and is not a result of this program: expected another file, or --force");
  EXPECT_EQ(bytes_of(file), "of someone else");
}

TEST(FigureFolder, ALongClaimKeepsTheEndOfItsLine) {
  const TestFolder folder("figure_folder_test");
  Claim is_long = claim("4.11", true);
  is_long.claim = std::string(3000, 'x');
  const Told all = told(folder.path(), {{"4.11", {is_long}}, {"4.12", {claim("4.12", true)}}});
  EXPECT_HAS(all.out, std::string(3000, 'x') + ": 1 m (at most 2)\nfigure 4.12 -> ");
}

TEST(FigureFolder, AClaimThatDiffersNamesItsSource) {
  const TestFolder folder("figure_folder_test");
  Figure models{"4.12", "", ""};
  models.source = "the published models";
  remote_touch::Claims(models).differs("width: ratio", 1.5, 1, 2, "1", "1 (equal)");
  const Told all = told(folder.path(), {{"4.11", {claim_differs("4.11", "speed", "16", 29, 28, 30, "m/s")}},
                                        {"4.12", models.claims}});
  EXPECT_HAS(all.out, "speed: 29 m/s (expected here: from 28 to 30, the dissertation: 16)\n");
  EXPECT_HAS(all.out, "width: ratio: 1.5 1 (expected here: from 1 to 2, the published models: 1 (equal))\n");
  const std::string claims = bytes_of(folder / "claims.json");
  EXPECT_HAS(claims, "\"source\": \"the dissertation\"");
  EXPECT_HAS(claims, "\"source\": \"the published models\"");
}

// The exit code reports a failed claim, whatever else is claimed before or after it.
TEST(FigureFolder, AFailedClaimIsTheExitCode) {
  const Claim none = claim_not_run("4.11", "needs a recording", "it is not there");
  const Claim open = [] {
    Claim one = claim("4.11", true);
    one.verdict = Verdict::open;
    return one;
  }();
  const std::vector<Claims> all = {
      {{"4.11", {claim("4.11", false)}}, {"4.12", {claim("4.12", true)}}},
      {{"4.11", {claim("4.11", true)}}, {"4.12", {claim("4.12", false)}}},
      {{"4.11", {claim("4.11", false), claim("4.11", true)}}, {"4.12", {claim("4.12", true)}}},
      {{"4.11", {set_up(claim("4.11", false))}}, {"4.12", {claim("4.12", true)}}},
      {{"4.11", {claim("4.11", true)}},
       {"4.12", {claim_at_most("4.12", "no number", "-", std::numeric_limits<double>::quiet_NaN(), 2, "m")}}},
      {{"4.11", {open}}, {"4.12", {claim_differs("4.12", "outside", "4", 3, 1, 2, "m")}}},
      {{"4.11", {none}}, {"4.12", {claim("4.12", false)}}},
      {{"4.11", {none, claim("4.11", false)}}, {"4.12", {none}}},
  };
  for (std::size_t i = 0; i < all.size(); ++i) {
    const TestFolder folder("figure_folder_test");
    const Told one = told(folder.path(), all[i]);
    EXPECT_EQ(one.code, kCheckFailed) << i;
    EXPECT_HAS(one.out, "  FAIL    ") << i;
    EXPECT_HAS(bytes_of(folder / "claims.json"), "\"verdict\": \"fail\"") << i;
  }
}

TEST(FigureFolder, ExitCodeIsBadInputIfNoFigureWasMade) {
  const TestFolder folder("figure_folder_test");
  const Claim none = claim_not_run("4.11", "needs a recording", "it is not there");
  EXPECT_EQ(told(folder.path(), {{"4.11", {none}}, {"4.12", {none}}}).code, kBadInput);
  EXPECT_EQ(told(folder.path(), {{"4.11", {none}}, {"4.12", {claim("4.12", true)}}}).code, kDone);
}

}  // namespace
}  // namespace remote_touch::commands_test
