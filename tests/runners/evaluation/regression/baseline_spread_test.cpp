// The spread that the numbers of a baseline may have, measured over programs that write the results that a
// test gives them, and the part of the old numbers that is kept.
#include <gtest/gtest.h>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "core/kernels/kernels.h"
#include "runners/evaluation/regression/baselines.h"
#include "runners/experiment/simulation/simulation.h"
#include "runners/sweep/sweep_run.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::baseline_spread_test {
namespace {

namespace fs = std::filesystem;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// --- old bits ---

Column numbers(std::vector<double> values, int width = 1) {
  return {"force", "N", "", std::move(values), width, {}};
}
Column names(std::vector<std::int32_t> values) {
  return {"state", "1", "", std::move(values), 1, {"free", "contact"}};
}
Column hashes(std::vector<std::uint64_t> values) {
  return {"frame_hash", "1", "", std::move(values), 1, {}};
}
Column counts(std::vector<std::int32_t> values) {
  return {"steps", "1", "", std::move(values), 1, {}};
}

Column kept(const Column& old, const Column& now, const Tolerances& tolerances) {
  const std::vector<Column> result = keep_old_bits({old}, {now}, tolerances);
  EXPECT_EQ(result.size(), 1u);
  EXPECT_EQ(result.front().name, now.name);
  return result.front();
}
void expect_bits(const Column& column, const Column& want) {
  EXPECT_TRUE(same_bits(column, want))
      << testing::PrintToString(std::get<std::vector<double>>(column.values));
}

TEST(KeepOldBits, KeepsOldBitsRowByRow) {
  const Column old = numbers({1, 2, 3, 4}), now = numbers({1.25, 2, 2.5, 5});
  expect_bits(kept(old, now, {}), now);
  expect_bits(kept(old, now, {{"force", {0.25}}}), numbers({1, 2, 2.5, 5}));
  expect_bits(kept(old, now, {{"force", {0.75}}}), numbers({1, 2, 3, 5}));
  expect_bits(kept(old, now, {{"force", {1}}}), old);
  expect_bits(kept(old, now, {{"state", {1}}}), now);
  expect_bits(kept(old, now, {{"*", {1}}}), old);
}

TEST(KeepOldBits, AVectorIsOneRow) {
  const Column old = numbers({0, 0, 0, 3, 4, 0}, 3), now = numbers({0.3, 0.4, 0, 3, 4, 0.4}, 3);
  expect_bits(kept(old, now, {{"force", {0.45}}}), numbers({0.3, 0.4, 0, 3, 4, 0}, 3));
  expect_bits(kept(old, now, {{"force", {0.5}}}), old);
}

TEST(KeepOldBits, DoesNotKeepNanInfinityOrTheirReplacements) {
  expect_bits(kept(numbers({kNaN, 1, kNaN, kInfinity, kInfinity, -kInfinity, 1}),
                   numbers({1, kNaN, kNaN, 1, kInfinity, kInfinity, kInfinity}), {{"force", {1e99}}}),
              numbers({1, kNaN, kNaN, 1, kInfinity, kInfinity, kInfinity}));
  expect_bits(kept(numbers({0.0, -0.0}), numbers({-0.0, 0.0}), {}), numbers({0.0, -0.0}));
}

// Names and hashes are compared exactly, whatever the tolerance is.
TEST(KeepOldBits, IgnoresTheToleranceForNamesAndHashes) {
  for (const Tolerances& tolerances : {Tolerances{}, Tolerances{{"*", {9}}}}) {
    EXPECT_EQ(kept(names({0, 1, 1}), names({0, 0, 1}), tolerances).values, names({0, 0, 1}).values);
    EXPECT_EQ(kept(hashes({1, 2}), hashes({1, 3}), tolerances).values, hashes({1, 3}).values);
  }
  EXPECT_EQ(kept(counts({10, 20, 30}), counts({11, 22, 30}), {{"steps", {1}}}).values,
            counts({10, 22, 30}).values);
}

TEST(KeepOldBits, OtherColumnsAreAllNew) {
  const Tolerances wide = {{"*", {9}}};
  const Column now = numbers({1.5, 2.5, 3.5, 4.5, 5.5, 6.5});
  expect_bits(kept(numbers({1, 2, 3}), now, wide), now);
  expect_bits(kept(numbers({1, 2, 3, 4, 5, 6, 7}), now, wide), now);
  expect_bits(kept(numbers({1, 2, 3, 4, 5, 6}, 3), now, wide), now);
  Column other = numbers({1, 2, 3, 4, 5, 6});
  other.units = "mN";
  expect_bits(kept(other, now, wide), now);
  expect_bits(kept(counts({1, 2, 3, 4, 5, 6}), now, wide), now);

  // An additional or a missing column leaves the others as they are.
  const std::vector<Column> more = keep_old_bits({numbers({1})}, {numbers({1.5}), counts({3})}, wide);
  ASSERT_EQ(more.size(), 2u);
  expect_bits(more[0], numbers({1}));
  EXPECT_EQ(more[1].values, counts({3}).values);
  EXPECT_EQ(keep_old_bits({numbers({1}), counts({3})}, {numbers({1.5})}, wide).size(), 1u);
  EXPECT_TRUE(keep_old_bits({numbers({1})}, {}, wide).empty());
  expect_bits(keep_old_bits({}, {numbers({1.5})}, wide).front(), numbers({1.5}));
}

// A new column in between does not move the others.
TEST(KeepOldBits, ColumnsAreFoundByName) {
  Column depth = numbers({5}), speed = numbers({7});
  depth.name = "depth", speed.name = "speed";
  const std::vector<Column> now =
      keep_old_bits({numbers({1}), depth}, {numbers({1.5}), speed, depth}, {{"*", {9}}});
  ASSERT_EQ(now.size(), 3u);
  expect_bits(now[0], numbers({1}));
  expect_bits(now[1], numbers({7}));
  expect_bits(now[2], numbers({5}));
}

// --- spread ---

// Each program copies a prepared file of its own folder: LEVEL-THREADS.h5 if there is one, else plain.h5. It
// writes its arguments to the file `calls`.
class MeasureSpread : public testing::Test {
 protected:
  MeasureSpread() {
    for (const char* name : {"scratch", "gcc", "clang"}) fs::create_directory(folder_ / name);
  }

  std::string program(const std::string& name, const std::string& script = {}) {
    const fs::path file = folder_.write(name + "/program", R"sh(#!/bin/sh
here=${0%/*}
echo "$REMOTE_TOUCH_ISA-$OMP_NUM_THREADS: $*" >>"$here/calls"
while [ "$1" != -o ]; do shift; done
)sh" + script + R"sh(
made=$here/$REMOTE_TOUCH_ISA-$OMP_NUM_THREADS.h5
[ -e "$made" ] || made=$here/plain.h5
cp "$made" "$2"
)sh");
    fs::permissions(file, fs::perms::owner_all);
    return file.string();
  }
  static TextAttributes build(const std::string& compiler) {
    return {{"config", "{}"},
            {"version", "1"},
            {"git_commit", "abc"},
            {"source_digest", "01"},
            {"compiler", compiler}};
  }
  void trace(
      const std::string& name, const TextAttributes& attributes,
      const std::function<void(Trace&)>& change = [](Trace&) {}) const {
    Trace made;
    for (int i = 0; i < 20; ++i) {
      RenderOutput out;
      out.force_N = Vec3(1, 2, 0.5 * i), out.state = ContactState::contact;
      made.append(0.001 * i, {Vec3(0, 0.01, 0)}, out, {0.01, 0.01, 77});
    }
    change(made);
    write_trace(folder_ / name, made, attributes, {});
  }
  // Two compilers whose results are all equal.
  std::vector<std::string> two_programs() {
    trace("gcc/plain.h5", build("GNU 12")), trace("clang/plain.h5", build("Clang 14"));
    return {program("gcc"), program("clang")};
  }
  MeasuredSpread measure(const std::vector<std::string>& programs,
                         const Baseline& baseline = {"x", "run", "fig4.11"},
                         const std::atomic<bool>* stop = nullptr) const {
    return measure_spread(folder_.path(), baseline, programs, scratch(), stop);
  }
  std::string refused(const std::vector<std::string>& programs) const {
    return refusal([&] { measure(programs); });
  }
  fs::path scratch() const { return folder_ / "scratch"; }

  const TestFolder folder_{"baseline_spread_test"};
};

int lines(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

TEST_F(MeasureSpread, RunsEveryProgramAtEveryLevelAndNumberOfThreads) {
  const auto programs = two_programs();
  const MeasuredSpread measured = measure(programs, {"x", "run", "my.json", {"seed=2", "title=two words"}});
  EXPECT_TRUE(measured.spread.empty());
  EXPECT_EQ(measured.compilers, (std::set<std::string>{"GNU 12", "Clang 14"}));
  EXPECT_EQ(bytes_of(measured.reference), bytes_of(folder_ / "gcc/plain.h5"));
  for (const char* what : {"GNU 12", "Clang 14", "x86-64", "1 threads", "2 threads", "8 threads"})
    EXPECT_EQ(std::count(measured.over.begin(), measured.over.end(), what), 1) << what;
  for (const char* name : {"gcc/calls", "clang/calls"}) {
    const std::string calls = bytes_of(folder_ / name);
    EXPECT_EQ(lines(calls), 3 * static_cast<int>(supported_kernels().size())) << calls;
    for (const char* threads : {"1", "2", "8"})
      EXPECT_HAS(calls, std::string("x86-64-") + threads + ": run " + (folder_ / "my.json").string() +
                            " --set seed=2 --set title=two words --quiet -o " + scratch().string());
    EXPECT_FALSE(contains(calls, "--threads"));
  }
}

TEST_F(MeasureSpread, ReportsTheLargestDeviationOfEachColumn) {
  const auto programs = two_programs();
  trace("gcc/x86-64-8.h5", build("GNU 12"), [](Trace& made) { made.force_N[7].x() += 0x1p-30; });
  trace("clang/x86-64-2.h5", build("Clang 14"), [](Trace& made) {
    made.force_N[5].y() -= 0x1p-20, made.force_N[6].x() += 0x1p-25, made.proxy_steps[3] += 2;
  });
  trace("clang/x86-64-8.h5", build("Clang 14"), [](Trace& made) { made.force_N[5].y() += 0x1p-22; });
  const MeasuredSpread measured = measure(programs);
  EXPECT_EQ(measured.spread, (Tolerances{{"force", {0x1p-20}}, {"proxy_steps", {2}}}));
  EXPECT_EQ(bytes_of(measured.reference), bytes_of(folder_ / "gcc/plain.h5"));
}

TEST_F(MeasureSpread, ADifferenceThatNoToleranceCoversIsRefused) {
  const auto programs = two_programs();
  const std::vector<std::pair<std::string, std::function<void(Trace&)>>> changes = {
      {"state: ", [](Trace& made) { made.state[11] = 0; }},
      {"status: ", [](Trace& made) { made.status[11] = 1; }},
      {"frame_hash: ", [](Trace& made) { made.frame_hash[11] ^= 1; }},
      {"force: ", [](Trace& made) { made.force_N[11].x() = kNaN; }},
      {"nearest_distance: ", [](Trace& made) { made.nearest_distance_m[11] = -kInfinity; }}};
  for (const auto& [name, change] : changes) {
    trace("clang/x86-64-8.h5", build("Clang 14"), change);
    const std::string message = refused(programs);
    EXPECT_EQ(message.find(name), 0u) << message;
    EXPECT_HAS(message, "Clang 14, x86-64, 8 threads");
    EXPECT_HAS(message, "in row 11, ");
  }
  trace("clang/x86-64-8.h5", build("Clang 14"), [](Trace& made) {
    made.append(1, {}, {}, {});  // one row more
  });
  EXPECT_HAS(refused(programs), "20 rows of 1 against 21 rows of 1");
}

TEST_F(MeasureSpread, AnotherSourceIsRefused) {
  const auto programs = two_programs();
  for (const char* name : {"version", "git_commit", "source_digest", "config"}) {
    TextAttributes attributes = build("Clang 14");
    for (auto& [key, value] : attributes)
      if (key == name) value = "another";
    trace("clang/plain.h5", attributes);
    EXPECT_EQ(refused(programs), programs[1] + ": is of another " + name +
                                     ", another: expected a build of the same source as this program");
  }
}

TEST_F(MeasureSpread, RefusesFilesThatAreNoPrograms) {
  auto programs = two_programs();
  const auto refused_second = [&](const std::string& second, const std::string& why) {
    programs[1] = second;
    EXPECT_EQ(refused(programs).find(second + ": " + why), 0u) << refused(programs);
  };
  refused_second(folder_ / "nowhere",
                 "cannot be started (No such file or directory): expected a build of remote-touch");
  refused_second(folder_.path(), "cannot be started");
  refused_second(folder_.write("plain.txt", "a text"), "cannot be started");
  refused_second(program("failing", "echo first >&2; echo why not >&2; exit 7"),
                 "failed with exit code 7 (why not): expected a build that runs");
  refused_second(program("silent", "exit 2"), "failed with exit code 2: expected");
  refused_second(program("killed", "kill -9 $$"), "failed with signal 9: expected");
  refused_second(program("idle", "exit 0"), "wrote no result (");
  // A result of the program before must not count as its own.
  programs.insert(programs.begin() + 1, program("gcc"));
  EXPECT_HAS(refused(programs), programs[2] + ": wrote no result");
  // The file that it wrote is no result.
  refused_second(program("text", "echo text >\"$2\"; exit 0"), "wrote no result (");
  EXPECT_HAS(refused(programs), "not a readable HDF5 file");
}

// A process that ignores SIGCHLD, as a parent may make it, does not learn how its programs end.
TEST_F(MeasureSpread, AProgramOfUnknownEndIsRefused) {
  const auto before = std::signal(SIGCHLD, SIG_IGN);
  const std::string message =
      refusal([&] { run_program("/bin/false", {}, {}, folder_ / "errors", nullptr); });
  std::signal(SIGCHLD, before);
  EXPECT_HAS(message, "/bin/false: has an unknown end (No child processes): expected");
}

TEST_F(MeasureSpread, MeasuresSweepsToo) {
  const Sweep sweep = Sweep::from_json(R"({"experiment": "fig4.12",
    "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
    "axes": [{"parameter": "scenario.noise_sigma_m", "values": [0, 0.003]}],
    "measures": ["popped_through", "max_penetration"]})",
                                       "test");
  SweepResult result = run_sweep(sweep, {});
  const std::vector<std::string> programs = {program("gcc"), program("clang")};
  write_sweep(folder_ / "gcc/plain.h5", result, build("GNU 12"));
  write_sweep(folder_ / "clang/plain.h5", result, build("Clang 14"));
  std::get<std::vector<double>>(result.measures[1].values)[1] += 0x1p-20;
  write_sweep(folder_ / "clang/x86-64-8.h5", result, build("Clang 14"));
  const MeasuredSpread measured = measure(programs, {"x", "sweep", "fig4.13"});
  EXPECT_EQ(measured.spread, (Tolerances{{"max_penetration", {0x1p-20}}}));
  EXPECT_HAS(bytes_of(folder_ / "gcc/calls"), "x86-64-8: sweep fig4.13 --quiet -o ");
  EXPECT_HAS(bytes_of(folder_ / "gcc/calls"), " --threads 8\n");

  const std::vector<Column> judged = judged_columns(measured.reference, "sweep");
  ASSERT_EQ(judged.size(), 2u);
  EXPECT_EQ(judged[1].name, "max_penetration");
}

TEST_F(MeasureSpread, TheRunningHashIsNotJudged) {
  trace("a.h5", build("GNU 12"));
  const std::vector<Column> judged = judged_columns(folder_ / "a.h5", "run");
  EXPECT_EQ(judged.size(), 18u);
  for (const Column& column : judged) EXPECT_NE(column.name, kRunningHash);
}

// The program would work for longer than ctest waits for a test.
TEST_F(MeasureSpread, AnInterruptionEndsTheProgramAtWork) {
  const std::atomic<bool> stop = true;
  EXPECT_THROW(measure({program("slow", "exec sleep 36000")}, {"x", "run", "fig4.11"}, &stop), Interrupted);
}

// --- what is refused before any program runs ---

TEST(Bless, RefusesContradictoryRequests) {
  const TestFolder folder("baseline_spread_test");
  folder.write("mine.json", "{}");
  Blessing sound;
  sound.folder = folder.path(), sound.name = "x", sound.reason = "a reason", sound.run = "fig4.11";
  sound.one_compiler = true;
  const auto refused = [&](const std::function<void(Blessing&)>& change) {
    Blessing blessing = sound;
    change(blessing);
    return refusal([&] { bless(blessing); });
  };
  for (const char* reason : {"", " ", "\n\t "})
    EXPECT_HAS(refused([&](auto& b) { b.reason = reason; }), "--reason: missing: expected a sentence");
  EXPECT_HAS(refused([](auto& b) { b.one_compiler = false; }), "--other-build: missing: expected");
  EXPECT_HAS(refused([](auto& b) { b.reason = "\xff"; }), "--reason: expected UTF-8");
  EXPECT_HAS(refused([](auto& b) { b.run = "\xff"; }), "--run: expected UTF-8");
  EXPECT_HAS(refused([](auto& b) { b.sweep = "fig4.13"; }), "--run, --sweep: both are given");
  for (const char* name : {"", "../x", "a/b", "a b", "gr\xc3\xbcn", "*"})
    EXPECT_HAS(refused([&](auto& b) { b.name = name; }), "expected letters, digits, . - and _");
  EXPECT_HAS(refused([](auto& b) { b.run = ""; }), "baseline x: does not exist: expected --run");
  EXPECT_HAS(refused([](auto& b) { b.run = "moon"; }), "moon: cannot be read");
  EXPECT_HAS(refused([](auto& b) { b.run = "moon.json"; }),
             (folder / "moon.json").string() + ": cannot be read");
  EXPECT_HAS(refused([](auto& b) { b.run = "mine.json"; }), "scenario: missing");
  EXPECT_HAS(refused([](auto& b) { b.run = "", b.sweep = "fig4.11"; }),
             "fig4.11: cannot be read (No such file or directory): expected a sweep's");
  EXPECT_HAS(refused([](auto& b) { b.overrides = {"seeed=1"}; }), "seeed: unknown");
  EXPECT_HAS(refused([](auto& b) { b.overrides = {"seed"}; }), "--set seed: expected key=value");
  EXPECT_HAS(refused([](auto& b) { b.folder /= "mine.json"; }), "mine.json/manifest.json: cannot be written");
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"mine.json"});

  folder.write("manifest.json", text_of(Manifest{false, {{"x", "run", "fig4.11"}}}));
  EXPECT_HAS(refused([](auto& b) { b.run = "", b.overrides = {"seed=1"}; }),
             "--set: is given without --run or --sweep");
  folder.write("manifest.json", "damaged");
  EXPECT_HAS(refused([](auto&) {}), "manifest.json: ");
  EXPECT_EQ(bytes_of(folder / "manifest.json"), "damaged");
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"manifest.json", "mine.json"}));
}

// The folder of runs whose results are thrown away.

namespace fs = std::filesystem;

class ScratchFolderTest : public testing::Test {
 protected:
  ScratchFolderTest() { ::setenv("TMPDIR", place_.path().c_str(), 1); }
  ~ScratchFolderTest() override {
    if (before_)
      ::setenv("TMPDIR", before_->c_str(), 1);
    else
      ::unsetenv("TMPDIR");
  }

 private:
  static std::optional<std::string> now() {
    const char* const folder = std::getenv("TMPDIR");
    return folder ? std::make_optional<std::string>(folder) : std::nullopt;
  }
  const std::optional<std::string> before_ = now();

 protected:
  const TestFolder place_{"scratch_folder_test"};
};

TEST_F(ScratchFolderTest, IsRemovedAfterwardsWithItsFiles) {
  {
    const ScratchFolder one, other;
    EXPECT_NE(one.path(), other.path());
    for (const ScratchFolder* each : {&one, &other}) {
      EXPECT_EQ(each->path().parent_path(), place_.path());
      std::ofstream(each->path() / "result.h5") << "a result";
    }
    EXPECT_EQ(files_in(one.path()), std::vector<std::string>{"result.h5"});
  }
  EXPECT_TRUE(files_in(place_.path()).empty());
}

// Folders of programs that were killed are removed; those that others made are left alone.
TEST_F(ScratchFolderTest, RemovesFoldersThatNoProgramHolds) {
  place_.write("remote-touch-bless-Killed/reference.h5", "half");
  place_.write("remote-touch-other/file", "of another program");
  place_.write("remote-touch-bless-file", "no folder");
  fs::create_directory_symlink(place_ / "remote-touch-other", place_ / "remote-touch-bless-link");
  const ScratchFolder scratch;
  std::vector<std::string> left = {"remote-touch-bless-file", "remote-touch-bless-link", "remote-touch-other",
                                   scratch.path().filename().string()};
  std::sort(left.begin(), left.end());
  EXPECT_EQ(files_in(place_.path()), left);
  EXPECT_EQ(files_in(place_ / "remote-touch-other"), std::vector<std::string>{"file"});
}

TEST_F(ScratchFolderTest, NeedsAWritableFolder) {
  ::setenv("TMPDIR", (place_ / "nowhere").c_str(), 1);
  EXPECT_HAS(refusal([] { ScratchFolder(); }), "TMPDIR: ");
}

}  // namespace
}  // namespace remote_touch::baseline_spread_test
