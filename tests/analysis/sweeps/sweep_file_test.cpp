// The files of sweeps: what is written is read back, finished or not, and damage is noticed. The spool of
// runs: many parts, larger than its windows, come back in the order of their numbers.
#include "analysis/sweeps/sweep_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/columns.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_file_test {
namespace {

struct SweepFile : testing::Test {
  const TestFolder folder{"sweep_file_test"};
};
using SweepFileInProgress = SweepFile;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// 2 x 3 cells of 2 replicates, with runs that are done, failed and pending, and numbers that a careless
// writer would change.
SweepResult awkward(int replicates = 2, bool refined = true) {
  SweepResult result;
  result.axes = {{"rule", "1", "renderer.rule", std::vector<std::int32_t>{0, 1}, 1, {"fixed", "variable"}},
                 {"sigma_m", "m", "scenario.sigma_m", std::vector<double>{0, 0.1, 1.0 / 3}}};
  result.replicates = replicates;
  result.measures = {{"first", "1", "a measure", {}}, {"second", "N", "another", {}}};
  result.note_kinds = {"other", "no contact", "frames unused"};
  result.start(refined);
  const double values[] = {0.1, -0.0, 5e-324, 1.0 / 3, -1e308, kNan};
  for (std::size_t run = 0; run < result.run_count(); ++run) {
    result.state[run] = run % 6 == 5 ? RunState::failed : run % 4 == 3 ? RunState::pending : RunState::done;
    if (refined) result.round[run] = static_cast<std::int32_t>(run % 3);
    if (result.state[run] == RunState::failed) result.error[run] = "no Bögen, tick " + std::to_string(run);
    if (result.state[run] != RunState::done) continue;
    std::get<std::vector<double>>(result.measures[0].values)[run] = values[run % 6];
    std::get<std::vector<double>>(result.measures[1].values)[run] = static_cast<double>(run);
    result.notes[run] = run % 8;
  }
  return result;
}

// Returns the result as earlier versions stored it.
SweepResult without_notes(SweepResult result) {
  result.note_kinds.clear(), result.notes.clear();
  return result;
}

void expect_same(const SweepResult& a, const SweepResult& b) {
  EXPECT_EQ(a.state, b.state);
  EXPECT_EQ(a.round, b.round);
  EXPECT_EQ(a.error, b.error);
  EXPECT_EQ(a.note_kinds, b.note_kinds);
  EXPECT_EQ(a.notes, b.notes);
  EXPECT_EQ(a.replicates, b.replicates);
  const auto expect_equal = [](const std::vector<Column>& x, const std::vector<Column>& y) {
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_TRUE(same_bits(x[i], y[i])) << x[i].name;
      EXPECT_EQ(x[i].name, y[i].name);
      EXPECT_EQ(x[i].units, y[i].units);
      EXPECT_EQ(x[i].long_name, y[i].long_name);
      EXPECT_EQ(x[i].value_names, y[i].value_names);
    }
  };
  expect_equal(a.axes, b.axes), expect_equal(a.measures, b.measures);
}

const TextAttributes kAttributes = {{"command", "remote-touch sweep x"}, {"config", "{}"}, {"shard", "1/2"}};

TEST_F(SweepFile, ReadsBackWhatWasWritten) {
  for (const int replicates : {1, 2, 1000})  // 1000: the arrays are chunked and compressed
    for (const bool refined : {false, true}) {
      const SweepResult result = awkward(replicates, refined);
      const std::string sum = write_sweep(folder / "x.h5", result, kAttributes);
      const StoredSweep stored = read_sweep(folder / "x.h5");
      expect_same(stored.result, result);
      EXPECT_EQ(stored.attributes, kAttributes);
      EXPECT_FALSE(stored.in_progress);
      EXPECT_EQ(attribute(read_hdf5(folder / "x.h5"), "digest"), sum);
      // The file has the same bytes if it is read and written again.
      write_sweep(folder / "again.h5", stored.result, stored.attributes);
      EXPECT_EQ(bytes_of(folder / "again.h5"), bytes_of(folder / "x.h5"));
    }
}

// Up to 64 kinds are kept. Results of earlier versions have none.
TEST_F(SweepFile, NotesAreKeptAndNotPartOfTheDigest) {
  const std::string sum = write_sweep(folder / "x.h5", awkward(), kAttributes);
  SweepResult many = awkward();
  while (many.note_kinds.size() < 64)
    many.note_kinds.push_back("kind " + std::to_string(many.note_kinds.size()));
  many.notes[0] = ~std::uint64_t{0}, many.notes[1] = std::uint64_t{1} << 63;
  EXPECT_EQ(write_sweep(folder / "x.h5", many, kAttributes), sum);
  expect_same(read_sweep(folder / "x.h5").result, many);
  EXPECT_EQ(note_counts(many).back().first, 0u);
  SweepResult none = without_notes(awkward());
  EXPECT_EQ(write_sweep(folder / "x.h5", none, kAttributes), sum);
  EXPECT_EQ(attribute(Hdf5Reader(folder / "x.h5").attributes(), "note_kinds"), "");
  expect_same(read_sweep(folder / "x.h5").result, none);
  write_sweep_in_progress(folder / "y.h5", none, kAttributes);
  none.error.assign(none.run_count(), "");
  expect_same(read_sweep(folder / "y.h5").result, none);
}

// Runs 5 and 11 of the 12 have failed, and 3 and 7 are pending; the others have the bits of run % 8.
TEST(SweepResult, CountsTheFinishedRunsWithEachKindOfNote) {
  const std::vector<NoteCount> counts = note_counts(awkward());
  ASSERT_EQ(counts.size(), 3u);
  EXPECT_EQ(counts[0].kind, "other");
  EXPECT_EQ(counts[0].runs, 2u) << "runs 1 and 9";
  EXPECT_EQ(counts[0].first, 1u);
  EXPECT_EQ(counts[1].kind, "no contact");
  EXPECT_EQ(counts[1].runs, 3u) << "runs 2, 6 and 10";
  EXPECT_EQ(counts[1].first, 2u);
  EXPECT_EQ(counts[2].runs, 2u) << "runs 4 and 6";
  SweepResult one = awkward();
  one.notes.assign(one.run_count(), 0);
  EXPECT_TRUE(note_counts(one).empty());
  one.notes[3] = 1;
  EXPECT_TRUE(note_counts(one).empty()) << "run 3 is not done";
  EXPECT_TRUE(note_counts(without_notes(awkward())).empty());
}

TEST_F(SweepFile, TheDigestIsOfEveryValue) {
  const std::string sum = write_sweep(folder / "x.h5", awkward(), kAttributes);
  const auto expect_another = [&](auto&& change) {
    SweepResult other = awkward();
    change(other);
    EXPECT_NE(write_sweep(folder / "y.h5", other, kAttributes), sum);
  };
  expect_another(
      [](SweepResult& r) { std::get<std::vector<double>>(r.axes[1].values)[1] = std::nextafter(0.1, 1); });
  expect_another([](SweepResult& r) { std::get<std::vector<double>>(r.measures[1].values)[4] = -4; });
  expect_another([](SweepResult& r) { r.state[3] = RunState::not_sampled; });
  expect_another([](SweepResult& r) { r.round[3] = 9; });
  expect_another([](SweepResult& r) { r.error[5] += "."; });
  EXPECT_EQ(write_sweep(folder / "y.h5", awkward(), {{"command", "another"}}), sum);
}

TEST_F(SweepFileInProgress, ItsFinishedRunsAreRead) {
  SweepResult result = awkward();
  write_sweep_in_progress(folder / "x.h5", result, kAttributes);
  EXPECT_EQ(std::filesystem::file_size(folder / "x.h5"), size_in_progress(result, kAttributes));
  StoredSweep stored = read_sweep(folder / "x.h5");
  EXPECT_TRUE(stored.in_progress);
  EXPECT_EQ(stored.attributes, kAttributes);
  result.error.assign(result.run_count(), "");  // reported when the run is repeated
  expect_same(stored.result, result);

  // One more run is recorded while the file is open.
  SweepInProgress storage(folder / "x.h5", result, kAttributes, true);
  result.state[3] = RunState::done;
  for (Column& measure : result.measures) std::get<std::vector<double>>(measure.values)[3] = -0.25;
  result.notes[3] = 5;
  storage.record(result, 3);
  storage.flush();
  expect_same(read_sweep(folder / "x.h5").result, result);
}

// Each byte of one run's values is changed in turn. The run is then pending, and no other run changes.
TEST_F(SweepFileInProgress, ARunWrittenInPartIsPending) {
  SweepResult result = awkward();
  result.error.assign(result.run_count(), "");
  write_sweep_in_progress(folder / "x.h5", result, kAttributes);
  const std::string whole = bytes_of(folder / "x.h5");
  SweepResult expected = result;
  expected.state[8] = RunState::pending;
  for (Column& measure : expected.measures) std::get<std::vector<double>>(measure.values)[8] = kNan;
  expected.notes[8] = 0;
  std::string swapped = whole;
  const std::pair<const char*, std::size_t> parts[] = {
      {"first", 8}, {"second", 8}, {"state", 4}, {"notes", 8}, {"checksum", 4}};
  for (const auto& [name, size] : parts) {
    const auto array =
        static_cast<std::size_t>(Hdf5Reader(folder / "x.h5").offset(std::string("/sweep/") + name));
    const std::size_t begin = array + 8 * size;
    swapped.replace(array + 2 * size, size, whole, begin, size);  // run 8 over run 2
    for (std::size_t byte = 0; byte < size; ++byte) {
      if (std::string(name) == "state" && byte > 0) continue;  // no valid state: the file is refused below
      std::string torn = whole;
      torn[begin + byte] ^= 1;
      expect_same(read_sweep(folder.write("torn.h5", torn)).result, expected);
    }
  }
  std::string mad = whole;
  mad[static_cast<std::size_t>(Hdf5Reader(folder / "x.h5").offset("/sweep/state")) + 33] ^= 1;
  EXPECT_HAS(refusal([&] { read_sweep(folder.write("mad.h5", mad)); }), "damaged (a state is unknown)");
  // The values of another run do not pass.
  EXPECT_EQ(read_sweep(folder.write("swapped.h5", swapped)).result.state[2], RunState::pending);
}

// A run that no round requested stays not sampled, whatever its bytes are.
TEST_F(SweepFileInProgress, DamageRequestsNoRuns) {
  SweepResult result = awkward();
  result.state[4] = RunState::not_sampled, result.round[4] = -1;
  for (Column& measure : result.measures) std::get<std::vector<double>>(measure.values)[4] = kNan;
  write_sweep_in_progress(folder / "x.h5", result, kAttributes);
  std::string torn = bytes_of(folder / "x.h5");
  torn[static_cast<std::size_t>(Hdf5Reader(folder / "x.h5").offset("/sweep/first")) + 32] ^= 1;
  EXPECT_EQ(read_sweep(folder.write("torn.h5", torn)).result.state[4], RunState::not_sampled);
}

TEST_F(SweepFileInProgress, NoticesThatItsFileWasMoved) {
  const auto file = folder / "x.h5";
  const SweepResult result = awkward();
  write_sweep_in_progress(file, result, kAttributes);
  SweepInProgress second(file, result, kAttributes, true);
  std::filesystem::rename(file, folder / "elsewhere.h5");
  EXPECT_HAS(refusal([&] { second.flush(); }), "was replaced or removed");
}

// The reader sends one query after the other about a file in progress to a child process. A sweep that ends,
// or begins another round, may replace the file between two queries.
constexpr int kQuestions =
    10;  // attributes, two axes, replicates, two measures, state, notes, round, checksum

RunInChild replacing(const std::filesystem::path& file, int at, int& asked) {
  return [&asked, file, at](const ChildLimits& limits, ChildReader reader, const std::string& question) {
    if (asked++ == at) write_sweep(file, awkward(), kAttributes);
    return in_own_child(limits, reader, question);
  };
}

// One reader calls the file neither damaged nor reads on, and the next one reads it again, unless it is
// replaced as if by a program that never stops.
TEST_F(SweepFileInProgress, IsReadAgainWhenItIsReplacedDuringReading) {
  const auto file = folder / "x.h5";
  const std::string replaced = ": was replaced by another program while it was read";
  for (int at = 0; at < kQuestions; ++at) {
    write_sweep_in_progress(file, awkward(), kAttributes);
    int asked = 0;
    EXPECT_EQ(refusal([&] { read_sweep(Hdf5Reader(file, replacing(file, at, asked))); }),
              file.string() + replaced + ": expected a file that no program writes");
    EXPECT_EQ(asked, at + 1);  // and it is noticed at once
    write_sweep_in_progress(file, awkward(), kAttributes);
    const StoredSweep stored = read_sweep(file, replacing(file, at, asked = 0));
    EXPECT_FALSE(stored.in_progress) << at;
    expect_same(stored.result, awkward());
  }
  const RunInChild always = [&](const ChildLimits& limits, ChildReader reader, const std::string& question) {
    write_sweep_in_progress(file, awkward(), kAttributes);
    return in_own_child(limits, reader, question);
  };
  write_sweep_in_progress(file, awkward(), kAttributes);
  EXPECT_HAS(refusal([&] { read_sweep(file, always); }), replaced);
}

TEST_F(SweepFile, DamageIsRefused) {
  const auto why = [&](const std::string& bytes) {
    const auto file = folder.write("damaged.h5", bytes);
    const std::string message = refusal([&] { read_sweep(file); });
    EXPECT_HAS(message, "damaged.h5: ");
    return message;
  };
  // The test damages a value of a finished file, and an axis and a round of a file in progress.
  write_sweep(folder / "x.h5", awkward(), kAttributes);
  const std::string third = raw(1.0 / 3), changed = raw(std::nextafter(1.0 / 3, 1));
  std::string whole = bytes_of(folder / "x.h5");
  whole.replace(whole.rfind(third), 8, changed);
  EXPECT_HAS(why(whole), "damaged or modified");

  write_sweep_in_progress(folder / "y.h5", awkward(), kAttributes);
  const std::string sound = bytes_of(folder / "y.h5");
  std::string bytes = sound;
  bytes.replace(bytes.find(third), 8, changed);
  EXPECT_HAS(why(bytes), "damaged (its plan has changed)");
  bytes = sound;
  std::string rounds, other;
  for (std::int32_t run = 0; run < 12; ++run) rounds += raw(run % 3), other += raw(run % 3 + 1);
  bytes.replace(bytes.find(rounds), rounds.size(), other);
  EXPECT_HAS(why(bytes), "damaged (its plan has changed)");

  why(sound.substr(0, sound.size() / 2)), why(sound.substr(0, 100)), why(""), why("text");
  write_trace(folder / "trace.h5", awkward_trace(20), kProvenance, {});
  EXPECT_HAS(why(bytes_of(folder / "trace.h5")), "expected remote-touch-sweep/3");
  for (const std::uint64_t unnamed : {std::uint64_t{8}, std::uint64_t{1} << 63}) {
    SweepResult result = awkward();
    result.notes[2] = unnamed;
    write_sweep(folder / "x.h5", result, kAttributes);
    EXPECT_HAS(why(bytes_of(folder / "x.h5")), "damaged (a note is unknown)");
  }
}

// A program changes a value and seals the file again.
TEST_F(SweepFile, ASealedFileWithOtherValuesThanItsDigestIsRefused) {
  const auto file = folder / "x.h5";
  write_sweep(file, awkward(), kAttributes);
  const std::string seal = sha256_of_file(file, kSealBlockSize), value = raw(1.0 / 3);
  std::string bytes = bytes_of(file);
  bytes.replace(bytes.rfind(value), value.size(), raw(0.25));
  folder.write("x.h5", bytes);
  bytes.replace(bytes.find(seal), seal.size(), sha256_of_file(file, kSealBlockSize));
  folder.write("x.h5", bytes);
  EXPECT_EQ(seal_state_of(file), SealState::valid);
  EXPECT_HAS(refusal([&] { read_sweep(file); }), "x.h5: damaged (its digest does not match)");
}

// Returns the reason why a sweep with these axes and columns is refused.
std::string refusal_of(const TestFolder& folder, const std::string& axes, const std::vector<Column>& columns,
                       Hdf5Writer::Finished finished) {
  Hdf5Writer hdf5(finished);
  hdf5.attributes("/", {{"schema", "remote-touch-sweep/3"}, {"axes", axes}, {"measures", "m"}});
  hdf5.group("/sweep");
  hdf5.columns("/sweep", columns, "");
  hdf5.save(folder / "x.h5");
  return refusal([&] { read_sweep(folder / "x.h5"); });
}

// 64 axes of two values have 2^64 runs, which are 0 in 64-bit arithmetic.
TEST_F(SweepFile, AxesThatAreNoneAreRefused) {
  const auto axis = [](const std::string& name, const Values& values, std::vector<std::string> names = {}) {
    return Column{name, "1", "", values, 1, std::move(names)};
  };
  const std::vector<double> none, two{1, 2};
  const auto named = [&](std::int32_t value) {
    return axis("a", std::vector<std::int32_t>{0, value}, {"fixed", "variable"});
  };
  using enum Hdf5Writer::Finished;
  const struct {
    const char* problem;
    std::string axes;
    std::vector<Column> columns;
    Hdf5Writer::Finished finished = yes;
  } rows[] = {{"its axes have too many values",
               joined(std::vector<std::string>(64, "a"), ","),
               {axis("a", two), axis("m", none)}},
              {"it has no runs", "a", {axis("a", none), axis("m", none)}},
              {"/sweep/a has a value without a name", "a", {named(-1)}},
              {"/sweep/a has a value without a name", "a", {named(2)}},
              {"/sweep/b is missing", "a,b", {axis("a", two), axis("checksum", two)}},
              {"/sweep/b is missing", "a,b", {axis("a", two), axis("checksum", two)}, no}};
  for (const auto& row : rows)
    EXPECT_HAS(refusal_of(folder, row.axes, row.columns, row.finished),
               "x.h5: damaged (" + std::string(row.problem) + ")");
}

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

TEST(RunSpool, WithoutAPartOrWithOneTwiceOrWithoutAFolderIsRefused) {
  const TestFolder folder("run_spool_test");
  RunSpool missing(outline(), false, folder / "out.h5");
  missing.add("a", held(0), part_values(0)), missing.add("b", held(1), part_values(1));
  EXPECT_HAS(refusal([&] { missing.complete(true); }), "no part holds run 2");
  RunSpool doubled(outline(), false, folder / "out.h5");
  doubled.add("a", held(0), part_values(0)), doubled.add("b", held(0), part_values(0));
  EXPECT_HAS(refusal([&] { doubled.complete(false); }), "b: holds run 0, as another part does");
  EXPECT_HAS(refusal([&] { RunSpool(outline(), false, folder / "absent" / "out.h5"); }),
             "out.h5: cannot be written");
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

}  // namespace
}  // namespace remote_touch::sweep_file_test
