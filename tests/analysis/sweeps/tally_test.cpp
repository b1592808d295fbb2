// Tallies of the runs of a sweep: of cells, of parts, of parts that are added to each other; and their files:
// what is written is read back, equal tallies are equal bytes, and damage is noticed.
#include "analysis/sweeps/sweep_tally.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <random>
#include <set>

#include "analysis/storage/digest.h"
#include "analysis/storage/result_file.h"
#include "tests/analysis/sweeps/example_tally.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::tally_test {
namespace {

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

// Quantiles of a sketch against those of the sorted values.

QuantileSketch sketch_of(const std::vector<double>& values) {
  QuantileSketch sketch;
  for (const double value : values) sketch.add(value);
  return sketch;
}

// x_k, k = max(1, ceil(p n)).
double sorted_quantile(std::vector<double> values, double p) {
  std::sort(values.begin(), values.end());
  const double rank = std::max(1.0, std::ceil(p * static_cast<double>(values.size())));
  return values[static_cast<std::size_t>(rank) - 1];
}

void expect_near_quantiles(const std::vector<double>& values) {
  const QuantileSketch sketch = sketch_of(values);
  for (const double p : {0.0, 0.001, 0.01, 0.05, 0.25, 0.5, 0.75, 0.9, 0.99, 0.999, 1.0}) {
    const double exact = sorted_quantile(values, p);
    ASSERT_LE(std::abs(sketch.quantile(p) - exact), std::abs(exact) / 64) << "p " << p << ", exact " << exact;
  }
}

TEST(QuantileSketch, HasTheQuantilesOfTheSortedValues) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (const std::size_t count : {1u, 2u, 3u, 10u, 101u, 4000u}) {
    std::vector<double> log_normal(count), symmetric(count), wide(count), events(count), close(count);
    for (std::size_t i = 0; i < count; ++i) {
      log_normal[i] = std::exp(0.3 * normal(random));
      symmetric[i] = normal(random);
      wide[i] = std::exp(200 * normal(random)) * (random() % 2 == 0 ? 1 : -1);
      events[i] = random() % 4 == 0 ? 1 : 0;
      close[i] = 1e8 + 1e-3 * normal(random);
    }
    for (const auto* values : {&log_normal, &symmetric, &wide, &events, &close})
      expect_near_quantiles(*values);
  }
}

// The error of 1/64 occurs at the lower end of the first bucket of a power of two; no bound below it would
// hold.
TEST(QuantileSketch, HasTheStatedErrorAtTheEndsOfEveryBucket) {
  double largest = 0;
  for (std::int32_t bucket = QuantileSketch::bucket_of(0x1p-1022); bucket <= QuantileSketch::bucket_of(1e308);
       ++bucket) {
    const double middle = QuantileSketch::middle_of(bucket);
    ASSERT_EQ(QuantileSketch::bucket_of(middle), bucket);
    ASSERT_EQ(QuantileSketch::bucket_of(-middle), -bucket);
    // The least and the greatest double of the bucket.
    const auto low = std::bit_cast<double>(static_cast<std::uint64_t>(bucket - 1) << 47);
    const double high = std::nextafter(std::bit_cast<double>(static_cast<std::uint64_t>(bucket) << 47), 0);
    ASSERT_EQ(QuantileSketch::bucket_of(low), bucket);
    ASSERT_EQ(QuantileSketch::bucket_of(high), bucket);
    ASSERT_EQ(QuantileSketch::bucket_of(std::nextafter(low, 0)), bucket - 1);
    largest = std::max({largest, (middle - low) / low, (high - middle) / high});
  }
  EXPECT_EQ(largest, 1.0 / 64);
}

TEST(QuantileSketch, IsExactForZeroAndNearSubnormals) {
  EXPECT_EQ(QuantileSketch::bucket_of(0.0), 0);
  EXPECT_EQ(QuantileSketch::bucket_of(-0.0), 0);
  EXPECT_EQ(QuantileSketch::middle_of(0), 0);
  const double least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(QuantileSketch::bucket_of(least), 1);
  EXPECT_EQ(QuantileSketch::bucket_of(-least), -1);
  for (const double value : {least, 1e-310, 0x1.fffffffffffffp-1023})
    EXPECT_LE(std::abs(QuantileSketch::middle_of(QuantileSketch::bucket_of(value)) - value), 0x1p-1028);
  EXPECT_TRUE(std::isfinite(
      QuantileSketch::middle_of(QuantileSketch::bucket_of(std::numeric_limits<double>::max()))));
}

TEST(QuantileSketch, ReadsItsPairsAndRefusesOthers) {
  const QuantileSketch sketch = sketch_of({-3, 0, 0, 1, 1.01, 1e300});
  EXPECT_EQ(QuantileSketch::from_pairs(sketch.pairs()), sketch);
  EXPECT_EQ(QuantileSketch::from_pairs({}), QuantileSketch());
  EXPECT_TRUE(std::isnan(QuantileSketch().quantile(0.5)));
  using Pairs = std::vector<std::pair<std::int32_t, std::int64_t>>;
  constexpr std::int64_t kMany = std::numeric_limits<std::int64_t>::max();
  const Pairs wrong[] = {{{1, 0}},     {{1, -1}},     {{2, 1}, {1, 1}},    {{1, 1}, {1, 1}},
                         {{65505, 1}}, {{-65505, 1}}, {{1, kMany}, {2, 1}}};
  for (const Pairs& pairs : wrong) EXPECT_FALSE(QuantileSketch::from_pairs(pairs).has_value());
}

TEST(CellTally, CountsItsRuns) {
  const TallyLayout layout{3, 3, {1}};
  CellTally tally(layout);
  const double nan = std::nan("");
  tally.add_done(layout, 12, std::vector<double>{1.5, 1, nan}, 0b101);
  tally.add_done(layout, 10, std::vector<double>{2.5, 1, 3}, 0b001);
  tally.add_done(layout, 11, std::vector<double>{3.5, nan, 4}, 0);
  tally.add_failed(19, "late"), tally.add_failed(15, "early"), tally.add_failed(17, "between");
  EXPECT_EQ(tally.done, 3);
  EXPECT_EQ(tally.failed, 3);
  EXPECT_EQ(tally.runs(), 6);
  EXPECT_EQ(tally.first_failed, 15u);
  EXPECT_EQ(tally.first_error, "early");
  EXPECT_EQ(tally.measures[0].mean(), 2.5);
  EXPECT_EQ(tally.measures[1].unknown, 1);
  EXPECT_EQ(tally.measures[2].values, 2);
  EXPECT_EQ(tally.notes[0], (NoteTally{2, 10}));
  EXPECT_EQ(tally.notes[1], NoteTally());
  EXPECT_EQ(tally.notes[2], (NoteTally{1, 12}));
  EXPECT_EQ(tally.events[0], (std::vector<std::uint64_t>{10, 12}));
  EXPECT_EQ(tally.contradiction(), "");
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
  using Change = void (*)(SweepTally&);
  static constexpr auto jump = [](SweepTally& tally) -> MeasureTally& {
    return tally.tallies[0].measures[0];
  };
  const std::pair<const char*, Change> contradictions[] = {
      {"cells without a tally", [](SweepTally& tally) { tally.cells.pop_back(); }},
      {"the cells are not increasing", [](SweepTally& tally) { tally.cells[1] = tally.cells[0]; }},
      {"the cells are not increasing", [](SweepTally& tally) { tally.cells.back() = 6; }},
      {"has other measures", [](SweepTally& tally) { tally.tallies[0].measures.pop_back(); }},
      {"has another number of runs", [](SweepTally& tally) { tally.held = {}; }},
      {"has another number of runs", [](SweepTally& tally) { tally.tallies[0].add_failed(3, "again"); }},
      {"runs of cells without", [](SweepTally& tally) { tally.cells.pop_back(), tally.tallies.pop_back(); }},
      {"names a run of another", [](SweepTally& tally) { tally.tallies[0].first_failed = 20; }},
      {"names a run of another", [](SweepTally& tally) { tally.tallies[0].events[0].back() = 20; }},
      {"names a run of another", [](SweepTally& tally) { tally.tallies[1].notes[0].first = 1; }},
      {"a count is negative", [](SweepTally& tally) { tally.tallies[0].failed = -1; }},
      {"no run failed", [](SweepTally& tally) { tally.tallies[0].failed = 0; }},
      {"a measure has another number of runs", [](SweepTally& tally) { ++tally.tallies[0].done; }},
      {"a measure has another number of runs", [](SweepTally& tally) { ++jump(tally).values; }},
      {"a note has a wrong number", [](SweepTally& tally) { tally.tallies[0].notes[0].runs = 1000; }},
      {"the runs of an event",
       [](SweepTally& tally) {
         std::swap(tally.tallies[0].events[0].front(), tally.tallies[0].events[0].back());
       }},
      {"the runs of an event",
       [](SweepTally& tally) { tally.tallies[0].events[0].push_back(tally.tallies[0].events[0].back()); }},
      {"a count is negative", [](SweepTally& tally) { ++jump(tally).values, jump(tally).unknown -= 1; }},
      {"the sketch has another number",
       [](SweepTally& tally) { --jump(tally).values, ++jump(tally).unknown; }},
      {"no range", [](SweepTally& tally) { jump(tally).least = 2 * jump(tally).greatest; }},
      {"no range", [](SweepTally& tally) { jump(tally).least = std::nan(""); }},
      {"no range", [](SweepTally& tally) { jump(tally).greatest = INFINITY; }},
      {"outside the sketch", [](SweepTally& tally) { jump(tally).least /= 2; }},
      {"outside the sketch", [](SweepTally& tally) { jump(tally).greatest *= 2; }},
      {"a sum without values", [](SweepTally& tally) {
         jump(tally).unknown += jump(tally).values, jump(tally).values = 0, jump(tally).sketch = {};
       }}};
  for (const auto& [what, change] : contradictions) {
    SweepTally tally = example_tally(20);
    change(tally);
    EXPECT_HAS(tally.contradiction(), what);
  }
}

// --- files ---

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
  SweepTally bare = example_plan(4);  // a tally without notes, with one axis
  bare.note_kinds.clear(), bare.axes.erase(bare.axes.begin());
  add_example_runs(bare, numbers_below(12));
  expect_read_back(folder, bare);
}

TEST_F(TallyFile, ReadsBackParts) {
  for (const std::vector<std::uint64_t>& runs :
       {std::vector<std::uint64_t>{7}, {0}, {3, 4, 5, 40, 41, 119}, {0, 20, 40, 60, 80, 100}}) {
    SweepTally part = example_plan(20);
    add_example_runs(part, runs);
    expect_read_back(folder, part);
  }
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
  std::vector<std::uint64_t> runs;
  for (std::uint64_t run = 0; run < tally.run_count(); ++run)
    if (const ExampleRun made = example_run(run); made.error.empty() && made.values[1] == 1)
      runs.push_back(run);
  EXPECT_EQ(find(content, "/tally/popped_through/events/run")->values, Values(runs));
}

// The seal is valid, but this program would not write the file.
TEST_F(TallyFile, RefusesContradictionsAndOtherKindsOfFiles) {
  const auto message = [&](auto&& change) {
    SweepTally tally = example_tally(50);
    change(tally);
    write_tally(folder / "x.h5", tally, kAttributes);
    return refusal([&] { stored(folder / "x.h5"); });
  };
  EXPECT_HAS(message([](SweepTally& t) { ++t.tallies[2].done; }),
             "x.h5: damaged (cell 2: a measure has another number of runs)");
  EXPECT_HAS(message([](SweepTally& t) { t.replicates = 49; }), "damaged (");
  write_trace(folder / "x.h5", awkward_trace(3), kProvenance, {});
  EXPECT_HAS(refusal([&] { stored(folder / "x.h5"); }), "expected remote-touch-tally/3");
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
}  // namespace remote_touch::tally_test
