#include "analysis/sweeps/sweep_tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>

#include "analysis/storage/digest.h"
#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_means.h"
#include "tests/analysis/sweeps/example_tally.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::sweep_tally_test {
namespace {

// Tallies of parts of a sweep, and what they are when added to each other.

std::vector<RunRange> ranges_of(const std::set<std::uint64_t>& runs) {
  std::vector<RunRange> ranges;
  for (const std::uint64_t run : runs)
    if (!ranges.empty() && ranges.back().end == run)
      ++ranges.back().end;
    else
      ranges.push_back({run, run + 1});
  return ranges;
}

RunRanges runs_in(const std::set<std::uint64_t>& runs) {
  RunRanges ranges;
  for (const RunRange& range : ranges_of(runs)) ranges.add(range);
  return ranges;
}

TEST(RunRanges, AgreeWithSetsOfRuns) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::uint64_t> order = numbers_below(40);
    std::shuffle(order.begin(), order.end(), random);
    std::set<std::uint64_t> one, other, both;
    RunRanges ranges;
    for (std::size_t i = 0; i < 12; ++i) {
      one.insert(order[i]), ranges.add({order[i], order[i] + 1});
      ASSERT_EQ(ranges.ranges(), ranges_of(one));
    }
    for (std::size_t i = 12; i < 25; ++i) other.insert(order[i]);
    both = one, both.insert(other.begin(), other.end());
    RunRanges sum = runs_in(one);
    sum.add(runs_in(other));
    ASSERT_EQ(sum.ranges(), ranges_of(both));
    ASSERT_EQ(sum.count(), both.size());
    const RunRange range{random() % 20, 20 + random() % 20};
    std::set<std::uint64_t> missing;
    std::uint64_t inside = 0;
    for (std::uint64_t run = range.first; run < range.end; ++run)
      both.contains(run) ? void(++inside) : void(missing.insert(run));
    ASSERT_EQ(sum.missing_in(range).ranges(), ranges_of(missing));
    ASSERT_EQ(sum.count_in(range), inside);
    ASSERT_EQ(sum.first_common(runs_in(missing)), RunRange());
    if (inside == 0) continue;
    const std::uint64_t common = *both.lower_bound(range.first);
    RunRanges asked;
    asked.add(range);
    ASSERT_EQ(sum.first_common(asked).first, common);
    ASSERT_EQ(asked.first_common(sum), sum.first_common(asked));
  }
}

TEST(SweepTally, DoesNotDependOnOrderOrParts) {
  const SweepTally whole = example_tally(20);
  EXPECT_TRUE(whole.is_whole());
  EXPECT_EQ(whole.cells, numbers_below(6));
  EXPECT_EQ(whole.contradiction(), "");
  std::mt19937_64 random(2);
  std::vector<std::uint64_t> numbers = numbers_below(whole.run_count());
  for (int round = 0; round < 20; ++round) {
    std::shuffle(numbers.begin(), numbers.end(), random);
    SweepTally merged = example_plan(20);
    for (std::size_t at = 0; at < numbers.size();) {
      const std::size_t count = std::min<std::size_t>(1 + random() % 30, numbers.size() - at);
      const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(at);
      SweepTally part = example_plan(20);
      add_example_runs(part, {first, first + static_cast<std::ptrdiff_t>(count)});
      ASSERT_EQ(part.contradiction(), "");
      ASSERT_EQ(part.missing().count(), whole.run_count() - count);
      merged.add(std::move(part));
      ASSERT_EQ(merged.contradiction(), "");
      at += count;
    }
    ASSERT_TRUE(same_tally(merged, whole));
  }
}

TEST(SweepTally, KeepsCellsWithRunsOnly) {
  SweepTally part = example_plan(10);
  add_example_runs(part, {41, 5, 40});
  EXPECT_EQ(part.cells, (std::vector<std::uint64_t>{0, 4}));
  EXPECT_EQ(part.held.ranges(), (std::vector<RunRange>{{5, 6}, {40, 42}}));
  EXPECT_EQ(part.tallies[1].runs(), 2);
  EXPECT_FALSE(part.is_whole());
}

TEST(SweepTally, NamesDoubledRuns) {
  SweepTally one = example_plan(10), other = example_plan(10);
  add_example_runs(one, {1, 2, 3, 12, 13, 14, 15});
  add_example_runs(other, {13, 14, 15, 16});
  const SweepTally before = one;
  EXPECT_EQ(one.obstacle(other), "runs 13 to 15 are in both");
  EXPECT_HAS(refusal([&] { one.add(other); }), "tallies: runs 13 to 15 are in both");
  EXPECT_TRUE(same_tally(one, before));
  SweepTally third = example_plan(10);
  add_example_runs(third, {3});
  EXPECT_EQ(one.obstacle(third), "run 3 is in both");
  EXPECT_THROW(add_example_runs(third, {3}), std::invalid_argument);
  EXPECT_THROW(add_example_runs(third, {60}), std::invalid_argument);
  EXPECT_EQ(third.contradiction(), "");
}

TEST(SweepTally, RefusesPartsOfAnotherSweep) {
  const SweepTally plan = example_plan(10);
  const auto obstacle = [&](auto&& change) {
    SweepTally other = plan;
    change(other);
    return plan.obstacle(other);
  };
  EXPECT_EQ(obstacle([](SweepTally&) {}), "");
  EXPECT_HAS(obstacle([](SweepTally& t) { std::get<std::vector<double>>(t.axes[1].values)[1] = 0.2; }),
             "their axes sigma_m differ");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.axes[0].value_names[0] = "free"; }), "their axes rule differ");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.axes.pop_back(); }), "their axes are rule, sigma_m and rule");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.measures[0].units = "mN"; }), "their measures jump differ");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.measures.pop_back(); }), "their measures are");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.replicates = 11; }), "10 and 11 replicates");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.note_kinds[0] = "x"; }), "kinds of notes");
  EXPECT_HAS(obstacle([](SweepTally& t) { t.keeps_events = false; }), "only one of them keeps the runs");
}

TEST(SweepTally, NoticesAContradiction) {
  const auto expect_wrong = [](auto&& change) {
    SweepTally tally = example_tally(20);
    change(tally);
    EXPECT_NE(tally.contradiction(), "");
  };
  expect_wrong([](SweepTally& tally) { tally.cells.pop_back(); });
  expect_wrong([](SweepTally& tally) { tally.cells[1] = tally.cells[0]; });
  expect_wrong([](SweepTally& tally) { tally.cells.back() = 6; });
  expect_wrong([](SweepTally& tally) { tally.tallies[0].add_failed(3, "once more"); });
  expect_wrong([](SweepTally& tally) { tally.tallies[0].measures.pop_back(); });
  expect_wrong([](SweepTally& tally) { tally.held = {}; });
  expect_wrong([](SweepTally& tally) { tally.cells.pop_back(), tally.tallies.pop_back(); });
  expect_wrong([](SweepTally& tally) { tally.tallies[0].first_failed = 20; });
  expect_wrong([](SweepTally& tally) { tally.tallies[0].events[0].back() = 20; });
  expect_wrong([](SweepTally& tally) { tally.tallies[1].notes[0].first = 1; });
}

// Means of a tally, on runs made by hand.

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
  const Table table = sweep_means(tally, "jump", {0, 1}, independent_streams(6));
  EXPECT_EQ(first_of<double>(table, "value"), 3);
  EXPECT_EQ(first_of<std::int32_t>(table, "runs"), 3);
  EXPECT_EQ(first_of<std::int32_t>(table, "unknown"), 1);
  EXPECT_EQ(first_of<std::int32_t>(table, "noted_runs"), 2);
  EXPECT_NE(first_of<std::string>(table, "note").find("of 3 of 4 runs that have a value"), std::string::npos);
}

}  // namespace
}  // namespace remote_touch::sweep_tally_test

// The files of tallies: what is written is read back, equal tallies are equal bytes, and damage is noticed.
namespace remote_touch::tally_file_test {
namespace {

struct TallyFile : testing::Test {
  const TestFolder folder{"tally_file_test"};
};

const TextAttributes kAttributes = {{"command", "remote-touch sweep x"}, {"config", "{}"}, {"shard", "1/2"}};

StoredTally stored(const std::filesystem::path& file) {
  return read_tally(Hdf5Reader(file));
}

void expect_read_back(const TestFolder& folder, const SweepTally& tally) {
  const std::string sum = write_tally(folder / "x.h5", tally, kAttributes);
  const StoredTally read = stored(folder / "x.h5");
  EXPECT_TRUE(same_tally(read.tally, tally));
  for (std::size_t i = 0; i < tally.axes.size(); ++i) {
    EXPECT_TRUE(same_bits(read.tally.axes[i], tally.axes[i]));
    EXPECT_EQ(read.tally.axes[i].units, tally.axes[i].units);
    EXPECT_EQ(read.tally.axes[i].long_name, tally.axes[i].long_name);
    EXPECT_EQ(read.tally.axes[i].value_names, tally.axes[i].value_names);
  }
  EXPECT_EQ(read.tally.obstacle(tally), tally.held.count() == 0 ? "" : tally.obstacle(tally));
  EXPECT_EQ(read.attributes, kAttributes);
  EXPECT_EQ(sum, digest(tally));
  write_tally(folder / "again.h5", read.tally, read.attributes);
  EXPECT_EQ(bytes_of(folder / "again.h5"), bytes_of(folder / "x.h5"));
}

TEST_F(TallyFile, ReadsBackAWholeSweep) {
  for (const int replicates : {1, 3, 200})
    for (const bool keeps_events : {false, true})
      expect_read_back(folder, example_tally(replicates, keeps_events));
}

TEST_F(TallyFile, ReadsBackParts) {
  for (const std::vector<std::uint64_t>& runs :
       {std::vector<std::uint64_t>{7}, {0}, {3, 4, 5, 40, 41, 119}, {0, 20, 40, 60, 80, 100}}) {
    SweepTally part = example_plan(20);
    add_example_runs(part, runs);
    expect_read_back(folder, part);
  }
}

TEST_F(TallyFile, ReadsBackWithoutNotesAndWithOneAxis) {
  SweepTally tally = example_plan(4);
  tally.note_kinds.clear();
  tally.axes.erase(tally.axes.begin());
  add_example_runs(tally, numbers_below(12));
  expect_read_back(folder, tally);
}

// Buckets far from the median, sums beyond the largest double, and squares that are too large.
TEST_F(TallyFile, ReadsBackHostileValues) {
  SweepTally tally = example_plan(600);
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const TallyLayout layout = tally.layout();
  for (std::uint64_t run = 0; run < tally.run_count(); ++run) {
    const double wide = std::exp(300 * normal(random)) * (run % 2 == 0 ? 1 : -1);
    const double values[] = {run < 600 ? wide : run % 100, run % 3 == 0 ? 1 : 1e-300,
                             run < 3 ? 1e308 : 5e-324};
    tally.add_done(layout, run, values, 0);
  }
  ASSERT_TRUE(std::isinf(tally.tallies[0].measures[2].sum.value()));
  expect_read_back(folder, tally);
  const auto names = Hdf5Reader(folder / "x.h5").datasets();
  EXPECT_TRUE(std::find(names.begin(), names.end(), "/tally/jump/far_buckets/cell") != names.end());
}

TEST_F(TallyFile, HasEqualBytesForAnyParts) {
  const SweepTally whole = example_tally(30);
  write_tally(folder / "whole.h5", whole, kAttributes);
  SweepTally merged = example_plan(30);
  for (const std::uint64_t shard : {2, 0, 1}) {
    SweepTally part = example_plan(30);
    std::vector<std::uint64_t> runs;
    for (std::uint64_t run = whole.run_count(); run-- > 0;)
      if (run / 7 % 3 == shard) runs.push_back(run);
    add_example_runs(part, runs);
    write_tally(folder / "part.h5", part, kAttributes);
    merged.add(stored(folder / "part.h5").tally);
  }
  write_tally(folder / "merged.h5", merged, kAttributes);
  EXPECT_EQ(bytes_of(folder / "merged.h5"), bytes_of(folder / "whole.h5"));
}

TEST_F(TallyFile, IsReadByOthersByName) {
  const SweepTally tally = example_tally(50);
  write_tally(folder / "x.h5", tally, kAttributes);
  const Hdf5Content content = read_hdf5(folder / "x.h5");
  const auto number = [&](const std::string& name, std::size_t i) {
    return std::get<std::vector<double>>(find(content, "/tally/" + name)->values)[i];
  };
  const auto count = [&](const std::string& name, std::size_t i) {
    return std::get<std::vector<std::int32_t>>(find(content, "/tally/" + name)->values)[i];
  };
  for (std::size_t i = 0; i < 6; ++i) {
    const CellTally& cell = tally.tallies[i];
    EXPECT_EQ(count("runs", i), 50);
    EXPECT_EQ(count("failed", i), cell.failed);
    EXPECT_EQ(count("time/unknown", i), cell.measures[2].unknown);
    EXPECT_EQ(count("jump/infinite", i), cell.measures[0].infinite);
    EXPECT_EQ(number("popped_through/mean", i), cell.measures[1].mean());
    const double deviation = cell.measures[2].standard_deviation();
    EXPECT_NEAR(number("time/standard_deviation", i), deviation, deviation / (1 << 16));
    EXPECT_EQ(number("time/least", i), cell.measures[2].least);
    EXPECT_EQ(number("time/sum", i), cell.measures[2].sum.value());
  }
  EXPECT_EQ(find(content, "/tally/time/mean")->units, "s");
  EXPECT_EQ(find(content, "/tally/note_kind")->value_names, tally.note_kinds);
  EXPECT_EQ(attribute(content, "measures"), "jump,popped_through,time");
  const auto& runs =
      std::get<std::vector<std::uint64_t>>(find(content, "/tally/popped_through/events/run")->values);
  for (const std::uint64_t run : runs) EXPECT_EQ(example_run(run).values.at(1), 1);
  EXPECT_EQ(runs.size(), static_cast<std::size_t>(std::lround([&] {
              double sum = 0;
              for (const CellTally& cell : tally.tallies) sum += cell.measures[1].sum.value();
              return sum;
            }())));
}

TEST_F(TallyFile, RefusesDamage) {
  write_tally(folder / "x.h5", example_tally(50), kAttributes);
  const std::string bytes = bytes_of(folder / "x.h5");
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    std::string damaged = bytes;
    damaged[random() % bytes.size()] ^= static_cast<char>(1 << random() % 8);
    const auto file = folder.write("y.h5", damaged);
    EXPECT_HAS(refusal([&] { stored(file); }), "y.h5: ");
  }
  const auto cut = folder.write("y.h5", bytes.substr(0, bytes.size() / 2));
  EXPECT_HAS(refusal([&] { stored(cut); }), "y.h5: ");
}

// A file with a valid seal that this program would not write.
TEST_F(TallyFile, RefusesContradictions) {
  const auto message = [&](auto&& change) {
    SweepTally tally = example_tally(50);
    change(tally);
    write_tally(folder / "x.h5", tally, kAttributes);
    return refusal([&] { stored(folder / "x.h5"); });
  };
  EXPECT_HAS(message([](SweepTally& t) { ++t.tallies[2].done; }),
             "x.h5: damaged (cell 2: a measure has another number of runs)");
  EXPECT_HAS(message([](SweepTally& t) { t.held = {}, t.held.add({0, 299}); }), "cell 5 has another number");
  EXPECT_HAS(message([](SweepTally& t) { t.tallies[1].measures[0].least = 0; }), "outside the sketch");
  EXPECT_HAS(message([](SweepTally& t) { t.tallies[1].events[0].back() = 3; }), "damaged (");
  EXPECT_HAS(message([](SweepTally& t) { t.replicates = 49; }), "damaged (");
}

// A mean that is not the sum over the count, in a file with a valid seal.
TEST_F(TallyFile, RefusesAnotherMean) {
  const SweepTally tally = example_tally(50);
  write_tally(folder / "x.h5", tally, kAttributes);
  std::string bytes = bytes_of(folder / "x.h5");
  const std::size_t at = bytes.find(raw(tally.tallies[2].measures[2].mean()));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  const auto file = folder.write("y.h5", bytes);
  EXPECT_HAS(refusal([&] { stored(file); }), "SHA-256 does not match");
  write_seal(file);
  EXPECT_HAS(refusal([&] { stored(file); }), "y.h5: damaged (its digest does not match)");
}

TEST_F(TallyFile, RefusesOtherKindsOfFiles) {
  write_trace(folder / "x.h5", awkward_trace(3), kProvenance, {});
  EXPECT_HAS(refusal([&] { stored(folder / "x.h5"); }), "expected remote-touch-tally/3");
}

TEST_F(TallyFile, RefusesNamesThatAreTaken) {
  SweepTally tally = example_tally(2);
  tally.axes[0].name = "failed";
  EXPECT_FALSE(is_free_in_tallies("failed"));
  EXPECT_HAS(refusal([&] { write_tally(folder / "x.h5", tally, {}); }), "is named failed");
  tally.axes[0].name = "jump";
  EXPECT_TRUE(is_free_in_tallies("jump"));
  EXPECT_HAS(refusal([&] { write_tally(folder / "x.h5", tally, {}); }), "is named jump");
}

// 2500 cells of 3 log-normal measures with sigma = 0.3: 4000 replicates need less than 1 MB.
TEST_F(TallyFile, IsSmall) {
  SweepTally tally;
  std::vector<double> axis(50);
  for (std::size_t i = 0; i < axis.size(); ++i) axis[i] = static_cast<double>(i);
  tally.axes = {{"a", "1", "", axis}, {"b", "1", "", axis}};
  tally.replicates = 4000;
  for (const char* name : {"x", "y", "z"})
    tally.measures.push_back({name, "N", "a measure", std::vector<double>()});
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::vector<double> drawn(1 << 20);  // each cell has a random piece of it, times its median
  for (double& value : drawn) value = std::exp(0.3 * normal(random));
  for (std::uint64_t cell = 0; cell < tally.cell_count(); ++cell) {
    tally.cells.push_back(cell);
    CellTally& in_cell = tally.tallies.emplace_back(tally.layout());
    const double median = 0.5 + 3 * axis[cell / 50] / 50 + axis[cell % 50] / 50;
    in_cell.done = tally.replicates;
    for (MeasureTally& measure : in_cell.measures) {
      const std::size_t first = random() % (drawn.size() - 4000);
      for (std::size_t i = 0; i < 4000; ++i) measure.add(median * drawn[first + i]);
    }
  }
  tally.held.add({0, tally.run_count()});
  write_tally(folder / "x.h5", tally, kAttributes);
  RecordProperty("bytes", std::to_string(std::filesystem::file_size(folder / "x.h5")));
  EXPECT_LE(std::filesystem::file_size(folder / "x.h5"), 1'000'000u);
  EXPECT_TRUE(same_tally(stored(folder / "x.h5").tally, tally));
}

}  // namespace
}  // namespace remote_touch::tally_file_test
