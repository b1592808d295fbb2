// The spread that the numbers of a baseline may have, measured over programs that write the results that a
// test gives them, and the part of the old numbers that is kept.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
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

struct KeptBits {
  Column old, now;
  Tolerances tolerances;
  Column want;
};

// A vector is one row. NaN, infinity and their replacements are not kept, nor are names and hashes, whatever
// the tolerance is. A column of another shape, unit or kind is all new.
TEST(KeepOldBits, OfRowsWithinTheTolerance) {
  const Column four = numbers({1, 2, 3, 4}), now = numbers({1.25, 2, 2.5, 5});
  const Column vectors = numbers({0, 0, 0, 3, 4, 0}, 3), turned = numbers({0.3, 0.4, 0, 3, 4, 0.4}, 3);
  const Column odd = numbers({1, kNaN, kNaN, 1, kInfinity, kInfinity, kInfinity});
  const Column six = numbers({1.5, 2.5, 3.5, 4.5, 5.5, 6.5});
  Column other_unit = numbers({1, 2, 3, 4, 5, 6});
  other_unit.units = "mN";
  const Tolerances wide = {{"*", {9}}};
  const KeptBits cases[] = {
      {four, now, {}, now},
      {four, now, {{"force", {0.25}}}, numbers({1, 2, 2.5, 5})},
      {four, now, {{"force", {0.75}}}, numbers({1, 2, 3, 5})},
      {four, now, {{"force", {1}}}, four},
      {four, now, {{"state", {1}}}, now},
      {four, now, {{"*", {1}}}, four},
      {vectors, turned, {{"force", {0.45}}}, numbers({0.3, 0.4, 0, 3, 4, 0}, 3)},
      {vectors, turned, {{"force", {0.5}}}, vectors},
      {numbers({kNaN, 1, kNaN, kInfinity, kInfinity, -kInfinity, 1}), odd, {{"force", {1e99}}}, odd},
      {numbers({0.0, -0.0}), numbers({-0.0, 0.0}), {}, numbers({0.0, -0.0})},
      {names({0, 1, 1}), names({0, 0, 1}), {}, names({0, 0, 1})},
      {names({0, 1, 1}), names({0, 0, 1}), wide, names({0, 0, 1})},
      {hashes({1, 2}), hashes({1, 3}), {}, hashes({1, 3})},
      {hashes({1, 2}), hashes({1, 3}), wide, hashes({1, 3})},
      {counts({10, 20, 30}), counts({11, 22, 30}), {{"steps", {1}}}, counts({10, 22, 30})},
      {numbers({1, 2, 3}), six, wide, six},
      {numbers({1, 2, 3, 4, 5, 6, 7}), six, wide, six},
      {numbers({1, 2, 3, 4, 5, 6}, 3), six, wide, six},
      {other_unit, six, wide, six},
      {counts({1, 2, 3, 4, 5, 6}), six, wide, six}};
  for (std::size_t i = 0; i < std::size(cases); ++i) {
    const std::vector<Column> kept = keep_old_bits({cases[i].old}, {cases[i].now}, cases[i].tolerances);
    ASSERT_EQ(kept.size(), 1u) << i;
    EXPECT_EQ(kept.front().name, cases[i].now.name) << i;
    EXPECT_TRUE(same_bits(kept.front(), cases[i].want)) << i;
  }
}

// A new or a missing column does not move the others.
TEST(KeepOldBits, ColumnsAreFoundByName) {
  const Tolerances wide = {{"*", {9}}};
  Column depth = numbers({5}), speed = numbers({7});
  depth.name = "depth", speed.name = "speed";
  const std::vector<Column> now = keep_old_bits({numbers({1}), depth}, {numbers({1.5}), speed, depth}, wide);
  ASSERT_EQ(now.size(), 3u);
  EXPECT_TRUE(same_bits(now[0], numbers({1})) && same_bits(now[1], speed) && same_bits(now[2], depth));
  EXPECT_EQ(keep_old_bits({numbers({1}), counts({3})}, {numbers({1.5})}, wide).size(), 1u);
  EXPECT_TRUE(keep_old_bits({numbers({1})}, {}, wide).empty());
  EXPECT_TRUE(same_bits(keep_old_bits({}, {numbers({1.5})}, wide).front(), numbers({1.5})));
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
                         const Baseline& baseline = {"x", "run", "fig4.11"}) const {
    return measure_spread(folder_.path(), baseline, programs, scratch(), nullptr);
  }
  std::string refused(const std::vector<std::string>& programs) const {
    return refusal([&] { measure(programs); });
  }
  fs::path scratch() const { return folder_ / "scratch"; }

  const TestFolder folder_{"baseline_spread_test"};
};

// Every program runs at every level and with each number of threads.
TEST_F(MeasureSpread, ReportsTheLargestDeviationOfEachColumn) {
  const auto programs = two_programs();
  trace("gcc/x86-64-8.h5", build("GNU 12"), [](Trace& made) { made.force_N[7].x() += 0x1p-30; });
  trace("clang/x86-64-2.h5", build("Clang 14"), [](Trace& made) {
    made.force_N[5].y() -= 0x1p-20, made.force_N[6].x() += 0x1p-25, made.proxy_steps[3] += 2;
  });
  trace("clang/x86-64-8.h5", build("Clang 14"), [](Trace& made) { made.force_N[5].y() += 0x1p-22; });
  const MeasuredSpread measured = measure(programs, {"x", "run", "my.json", {"seed=2", "title=two words"}});
  EXPECT_EQ(measured.spread, (Tolerances{{"force", {0x1p-20}}, {"proxy_steps", {2}}}));
  EXPECT_EQ(bytes_of(measured.reference), bytes_of(folder_ / "gcc/plain.h5"));
  EXPECT_EQ(measured.compilers, (std::set<std::string>{"GNU 12", "Clang 14"}));
  for (const char* name : {"gcc/calls", "clang/calls"}) {
    const std::string calls = bytes_of(folder_ / name);
    EXPECT_EQ(std::count(calls.begin(), calls.end(), '\n'), 3 * static_cast<int>(supported_kernels().size()));
    for (const char* threads : {"1", "2", "8"})
      EXPECT_HAS(calls, std::string("x86-64-") + threads + ": run " + (folder_ / "my.json").string() +
                            " --set seed=2 --set title=two words --quiet -o " + scratch().string());
    EXPECT_FALSE(contains(calls, "--threads"));
  }
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

// A result of the program before must not count as its own.
TEST_F(MeasureSpread, AProgramOfNoResultIsRefused) {
  auto programs = two_programs();
  programs.insert(programs.begin() + 1, "");
  const std::pair<const char*, const char*> cases[] = {
      {"exit 0", "wrote no result ("},
      {"kill -9 $$", "failed with signal 9: expected"},
      {"echo text >\"$2\"; exit 0", "not a readable HDF5 file"}};
  for (const auto& [script, why] : cases) {
    programs[1] = program("other", script);
    EXPECT_TRUE(refused(programs).starts_with(programs[1] + ": ")) << refused(programs);
    EXPECT_HAS(refused(programs), why);
  }
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

// --- the folder of runs whose results are thrown away ---

// Sets TMPDIR as long as it lives.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const fs::path& folder) { ::setenv("TMPDIR", folder.c_str(), 1); }
  ~TemporaryFolder() { before_.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", before_.c_str(), 1); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

 private:
  const std::string before_ = std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "";
};

// Folders of programs that were killed are removed; those that others made are left alone.
TEST(ScratchFolders, AreRemovedAndSoAreThoseThatNoProgramHolds) {
  const TestFolder place("scratch_folder_test");
  const TemporaryFolder here(place.path());
  place.write("remote-touch-bless-Killed/reference.h5", "half");
  place.write("remote-touch-other/file", "of another program");
  place.write("remote-touch-bless-file", "no folder");
  fs::create_directory_symlink(place / "remote-touch-other", place / "remote-touch-bless-link");
  std::vector<std::string> left = {"remote-touch-bless-file", "remote-touch-bless-link",
                                   "remote-touch-other"};
  {
    const ScratchFolder one, other;
    EXPECT_EQ(one.path().parent_path(), place.path());
    EXPECT_NE(one.path(), other.path());
    std::ofstream(one.path() / "result.h5") << "a result";
    EXPECT_EQ(files_in(place.path()).size(), left.size() + 2);
  }
  EXPECT_EQ(files_in(place.path()), left);
  EXPECT_EQ(files_in(place / "remote-touch-other"), std::vector<std::string>{"file"});
}

}  // namespace
}  // namespace remote_touch::baseline_spread_test
