// Comparison of two columns, and of two running hashes: what counts as the same, and what never does; and the
// figure of the deviation over time.
#include "analysis/storage/trace_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "analysis/storage/hdf5_file.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::compared_columns_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Column numbers(std::vector<double> values, int width = 1, std::string units = "m") {
  return {"x", std::move(units), "", std::move(values), width, {}};
}

// The relative part is that of the baseline. Without a tolerance only equal numbers pass.
TEST(Within, AddsTheAbsoluteAndTheRelativePart) {
  EXPECT_TRUE(within({}, 0.1, 0.1) && within({}, 0.0, -0.0));
  EXPECT_FALSE(within({}, 1e-20, 2e-20) || within({}, 0.1, std::nextafter(0.1, 1)));
  const Tolerance both = {0.5, 0.25};
  EXPECT_TRUE(within(both, 2, 3));
  EXPECT_FALSE(within(both, 2, 3.0001));
  EXPECT_TRUE(within(both, -2, -3));
  EXPECT_FALSE(within(both, 2, 0.9));  // relative to the candidate 0.9, the limit would be smaller
  EXPECT_TRUE(within({0, 1}, 4, 0));
  EXPECT_FALSE(within({0, 1}, 0, 4));
}

TEST(Within, NanAndInfinityEqualOnlyThemselvesAtAnyTolerance) {
  const double other_nan = -std::numeric_limits<double>::signaling_NaN();
  for (const Tolerance& tolerance : {Tolerance{}, Tolerance{1, 1}, Tolerance{kInfinity, kInfinity}}) {
    EXPECT_TRUE(within(tolerance, kNaN, kNaN));
    EXPECT_TRUE(within(tolerance, kNaN, other_nan));
    EXPECT_TRUE(within(tolerance, -kInfinity, -kInfinity));
    for (const double number : {0.0, 1.0, -1e308, kInfinity}) {
      EXPECT_FALSE(within(tolerance, kNaN, number)) << number;
      EXPECT_FALSE(within(tolerance, number, kNaN)) << number;
      EXPECT_FALSE(within(tolerance, number, -kInfinity)) << number;
      EXPECT_FALSE(within(tolerance, -kInfinity, number)) << number;
    }
  }
}

TEST(CompareColumns, CountsAndMeasuresWhatIsOutside) {
  const auto c = compare_columns(numbers({1, 2, 3, 4}), numbers({1, 2.5, 3, 4.1}), {0.2, 0});
  EXPECT_FALSE(c.is_same());
  EXPECT_EQ(c.rows, 4u);
  EXPECT_EQ(c.outside, 1u);
  EXPECT_EQ(c.first_difference, 1u);
  EXPECT_EQ(c.first_outside, 1u);
  EXPECT_DOUBLE_EQ(c.max, 0.5);
  EXPECT_DOUBLE_EQ(c.rms, std::sqrt((0.25 + 0.01) / 4));
  EXPECT_TRUE(compare_columns(numbers({1, 2}), numbers({1, 2}), {}).is_same());
}

TEST(CompareColumns, AVectorsDeviationIsALength) {
  const auto c = compare_columns(numbers({0, 0, 0, 3, 0, 4}, 3), numbers({0, 3, 4, 3, 0, 4}, 3), {1, 0});
  EXPECT_EQ(c.rows, 2u);
  EXPECT_EQ(c.outside, 1u);
  EXPECT_DOUBLE_EQ(c.max, 5);
  // The tolerance is relative to the length of the baseline's row, here 5.
  EXPECT_TRUE(compare_columns(numbers({3, 0, 4}, 3), numbers({3, 0, 4.4}, 3), {0, 0.1}).is_same());
  EXPECT_FALSE(compare_columns(numbers({3, 0, 4}, 3), numbers({3, 0, 4.6}, 3), {0, 0.1}).is_same());
}

// The squares of such small numbers are 0.
TEST(CompareColumns, DistinguishesTheSmallestVectors) {
  const auto c = compare_columns(numbers({0, 1e-170, 0}, 3), numbers({0, 2e-170, 0}, 3), {});
  EXPECT_EQ(c.outside, 1u);
  EXPECT_DOUBLE_EQ(c.max, 1e-170);
  EXPECT_EQ(compare_columns(numbers({0, 5e-324, 0}, 3), numbers({0, 0, 0}, 3), {}).outside, 1u);
  // The next row does not matter.
  const auto two =
      compare_columns(numbers({0, 1e-170, 0, 7, 0, 0}, 3), numbers({0, 2e-170, 0, 8, 0, 0}, 3), {});
  EXPECT_EQ(two.outside, 2u);
}

// An infinite or a very large baseline does not make the relative tolerance accept any number.
TEST(CompareColumns, ARelativeToleranceNeedsAFiniteLength) {
  EXPECT_FALSE(
      compare_columns(numbers({kInfinity, 0, 0}, 3), numbers({kInfinity, 5, 0}, 3), {0, 1e-12}).is_same());
  EXPECT_FALSE(compare_columns(numbers({1e200}), numbers({5e200}), {0, 1e-9}).is_same());
  EXPECT_TRUE(
      compare_columns(numbers({1e200, 0, 0}, 3), numbers({1.0001e200, 0, 0}, 3), {0, 1e-3}).is_same());
}

TEST(CompareColumns, NanOrInfinityNeverPassesAgainstANumber) {
  for (const double none : {kNaN, kInfinity}) {
    const auto c = compare_columns(numbers({none, 1}), numbers({0, 1}), {1e9, 1e9});
    EXPECT_EQ(c.outside, 1u);
    EXPECT_EQ(c.not_numbers, 1u);
    EXPECT_EQ(c.max, 0);
    const auto alone = compare_columns(numbers({none}), numbers({0}), {});
    EXPECT_EQ(alone.max, 0);
    EXPECT_EQ(alone.rms, 0);  // no deviation is finite
    EXPECT_FALSE(compare_columns(numbers({0, 1}), numbers({none, 1}), {1e9, 1e9}).is_same());
    EXPECT_TRUE(compare_columns(numbers({none, 1}), numbers({none, 1}), {}).is_same());
  }
  EXPECT_FALSE(compare_columns(numbers({0, kNaN, 0}, 3), numbers({0, 0, 0}, 3), {1, 1}).is_same());
  EXPECT_FALSE(compare_columns(numbers({kInfinity}), numbers({-kInfinity}), {1, 1}).is_same());
}

TEST(CompareColumns, ShapesUnitsAndKindsAreProblems) {
  const Column whole = numbers({1, 2, 3});
  const auto problem = [&](const Column& other) {
    const auto c = compare_columns(whole, other, {1e9, 0});
    EXPECT_FALSE(c.is_same());
    return c.problem;
  };
  EXPECT_EQ(problem(numbers({1, 2})), "3 rows of 1 against 2 rows of 1");
  EXPECT_EQ(problem(numbers({1, 2, 3}, 3)), "3 rows of 1 against 1 rows of 3");
  EXPECT_EQ(problem(numbers({1, 2, 3}, 1, "mm")), "units m against mm");
  EXPECT_EQ(problem({"x", "m", "", std::vector<std::int32_t>{1, 2, 3}}), "different type of values");
  EXPECT_EQ(problem(numbers({})), "3 rows of 1 against 0 rows of 1");
  // The rows that both have are compared nevertheless.
  EXPECT_EQ(compare_columns(whole, numbers({1, 9}), {}).first_outside, 1u);
  // A table of a figure may be empty, for example if it lists events that did not happen.
  EXPECT_TRUE(compare_columns(numbers({}), numbers({}), {}).is_same());
  EXPECT_FALSE(compare_columns(numbers({}, 3), numbers({}), {}).is_same());
}

TEST(CompareColumns, NamesTextsAndFingerprintsAreEqualOrNot) {
  const auto state = [](std::vector<std::int32_t> values,
                        std::vector<std::string> names = {"free", "contact"}) {
    return Column{"state", "1", "", std::move(values), 1, std::move(names)};
  };
  const auto c = compare_columns(state({0, 1}), state({0, 0}), {5, 0});
  EXPECT_EQ(c.outside, 1u);
  EXPECT_EQ(c.max, 0);
  EXPECT_EQ(compare_columns(state({0}), state({0}, {"free", "touching"}), {}).problem,
            "different names of the values");
  const Column hash = {"h", "1", "", std::vector<std::uint64_t>{1, 2}};
  Column other = hash;
  other.values = std::vector<std::uint64_t>{1, 3};
  EXPECT_EQ(compare_columns(hash, other, {5, 0}).first_outside, 1u);
  const Column text = {"t", "1", "", std::vector<std::string>{"a", "b"}};
  EXPECT_TRUE(compare_columns(text, text, {}).is_same());
  const Column counts = {"n", "1", "", std::vector<std::int32_t>{10, 20}};
  Column more = counts;
  more.values = std::vector<std::int32_t>{10, 22};
  EXPECT_EQ(compare_columns(counts, more, {}).max, 2);
  EXPECT_TRUE(compare_columns(counts, more, {2, 0}).is_same());
}

// The running hash without its trace: 8 bytes per tick, or less, show where two runs begin to differ.

struct TickHashFile : testing::Test {
  const TestFolder folder{"tick_hashes_test"};
};

namespace fs = std::filesystem;

constexpr int kTicks = 5000;  // stored in two chunks

// Returns the columns with their running hash computed anew.
std::vector<Column> rehashed(std::vector<Column> columns) {
  columns.pop_back();
  columns.push_back({"tick_hash", "1", "", running_hash(columns)});
  return columns;
}

// A trace of random numbers.
std::vector<Column> walk(int ticks = kTicks) {
  std::mt19937_64 random(3);
  std::vector<Column> columns = Trace{}.columns();
  for (Column& column : columns) {
    const auto count = static_cast<std::size_t>(ticks * column.width);
    if (auto* numbers = std::get_if<std::vector<double>>(&column.values))
      for (std::size_t i = 0; i < count; ++i) numbers->push_back(1e-6 * static_cast<double>(random() >> 40));
    else if (auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values))
      integers->resize(count, 1);
    else
      std::get<std::vector<std::uint64_t>>(column.values).resize(count, 5);
  }
  return rehashed(columns);
}

// Changes one number of a random column at the tick. The values of the ticks after it stay the same.
std::vector<Column> changed_at(std::vector<Column> columns, std::size_t tick, std::mt19937_64& random) {
  Column& column = columns[random() % (columns.size() - 1)];
  const auto width = static_cast<std::size_t>(column.width);
  const std::size_t place = tick * width + random() % width;
  if (auto* numbers = std::get_if<std::vector<double>>(&column.values))
    (*numbers)[place] = std::nextafter((*numbers)[place], 1e9);  // the last bit
  else if (auto* integers = std::get_if<std::vector<std::int32_t>>(&column.values))
    (*integers)[place] += 1;
  else
    std::get<std::vector<std::uint64_t>>(column.values)[place] ^= 1u << 30;
  return rehashed(columns);
}

fs::path stored(const TestFolder& folder, const std::string& name, const std::vector<Column>& columns) {
  write_trace(folder / name, columns, {}, {});
  return folder / name;
}

TickHashes every_nth(const TickHashes& all, int every) {
  TickHashes some;
  for (std::size_t i = 0; i < all.tick.size(); ++i)
    if (all.tick[i] % every == 0 || i + 1 == all.tick.size())
      some.tick.push_back(all.tick[i]), some.hash.push_back(all.hash[i]);
  return some;
}

TEST_F(TickHashFile, EveryNthTickAndTheLast) {
  for (const int ticks : {1, 2, 10, 101, kTicks}) {
    const std::vector<Column> columns = walk(ticks);
    const auto& hash = std::get<std::vector<std::uint64_t>>(columns.back().values);
    const fs::path file = stored(folder, "x.h5", columns);
    for (const int every : {1, 2, 3, 7, 10, 100, ticks - 1, ticks, ticks + 1, 2000000000}) {
      if (every < 1) continue;
      const TickHashes some = hashes_of_trace(StoredTrace(file), every);
      const auto count = static_cast<std::size_t>((ticks - 1) / every + 1 + ((ticks - 1) % every != 0));
      ASSERT_EQ(some.tick.size(), count) << ticks << " ticks, every " << every;
      ASSERT_EQ(some.hash.size(), count);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(some.tick[i], std::min(static_cast<int>(i) * every, ticks - 1));
        EXPECT_EQ(some.hash[i], hash[static_cast<std::size_t>(some.tick[i])]);
      }
    }
  }
}

TEST_F(TickHashFile, ReadsBackWhatWasWritten) {
  for (const int ticks : {0, 1, kTicks}) {
    const fs::path trace = stored(folder, "x.h5", walk(ticks));
    const TickHashes all = hashes_of_trace(StoredTrace(trace), 1);
    EXPECT_EQ(all.tick.size(), static_cast<std::size_t>(ticks));
    write_hashes(folder / "h.h5", all, kProvenance);
    const StoredHashes again = read_hashes(folder / "h.h5");
    EXPECT_EQ(again.hashes.tick, all.tick);
    EXPECT_EQ(again.hashes.hash, all.hash);
    for (const auto& [name, value] : kProvenance) EXPECT_EQ(attribute(again.attributes, name), value);
    write_hashes(folder / "again.h5", again.hashes, kProvenance);
    EXPECT_EQ(bytes_of(folder / "again.h5"), bytes_of(folder / "h.h5"));
  }
  // Hashes do not compress: a file has 8 bytes for each hash, little for the ticks, and what every file
  // needs.
  const TickHashes all = hashes_of_trace(StoredTrace(stored(folder, "x.h5", walk())), 1);
  write_hashes(folder / "h.h5", all, {});
  EXPECT_LT(fs::file_size(folder / "h.h5"), static_cast<std::size_t>(kTicks) * 8 + 20000);
}

// Files with a valid seal whose columns are not a list of ticks and hashes, and files of other kinds.
TEST_F(TickHashFile, OtherFilesAreRefused) {
  using Ticks = std::vector<std::int32_t>;
  using Hashes = std::vector<std::uint64_t>;
  const auto refused = [&](const std::vector<Column>& columns) {
    Hdf5Writer hdf5;
    hdf5.attribute("/", "schema", schema_name("hashes"));
    hdf5.group("/hashes");
    hdf5.columns("/hashes", columns, "");
    hdf5.save(folder / "h.h5");
    return refusal([&] { read_hashes(folder / "h.h5"); });
  };
  const struct {
    const char* problem;
    Values tick, hash;
  } rows[] = {{"no InputError", Ticks{0, 3, 4}, Hashes{1, 2, 3}},
              {"(its ticks and hashes differ in number)", Ticks{0, 1, 2}, Hashes{1}},
              {"(its ticks and hashes differ in number)", Ticks{0}, Hashes{1, 2, 3}},
              {"(its ticks are out of order)", Ticks{0, 2, 2}, Hashes{1, 2, 3}},
              {"(its ticks are out of order)", Ticks{-1, 2, 3}, Hashes{1, 2, 3}},
              {"(/hashes/tick_hash has values of another type or width)", Ticks{0}, Ticks{1}},
              {"(/hashes/tick has values of another type or width)", std::vector<double>{0}, Hashes{1}}};
  for (const auto& row : rows)
    EXPECT_HAS(refused({{"tick", "1", "", row.tick}, {"tick_hash", "1", "", row.hash}}), row.problem);
  EXPECT_HAS(refused({{"tick", "1", "", Ticks{0}}}), "h.h5: damaged (/hashes/tick_hash is missing)");

  const auto refused_trace = [](const fs::path& file) {
    return refusal([&] { hashes_of_trace(StoredTrace(file), 1); });
  };
  std::vector<Column> columns = walk(10);
  write_hashes(folder / "h.h5", hashes_of_trace(StoredTrace(stored(folder, "trace.h5", columns)), 1), {});
  EXPECT_HAS(refusal([&] { read_hashes(folder / "trace.h5"); }),
             "trace.h5: is of schema remote-touch-trace/3");
  EXPECT_HAS(refused_trace(folder / "h.h5"), "is of schema remote-touch-hashes/3");
  columns.back().values = std::vector<double>(10);
  EXPECT_HAS(refused_trace(stored(folder, "x.h5", columns)), "tick_hash has values of another type or width");
  columns.pop_back();
  EXPECT_HAS(refused_trace(stored(folder, "x.h5", columns)), "x.h5: damaged (/trace/tick_hash is missing)");
  Hdf5Writer hdf5;
  hdf5.attribute("/", "schema", "remote-touch-figure/2");
  hdf5.save(folder / "old.h5");
  EXPECT_HAS(
      refusal([&] { StoredFigure{Hdf5Reader(folder / "old.h5")}; }),
      "old.h5: is of schema remote-touch-figure/2: expected remote-touch-figure/3; make the result again");
}

// --- comparison ---

TEST(CompareHashes, APlantedTickIsBetweenTheTwoReportedOnes) {
  std::mt19937_64 random(5);
  const std::vector<Column> columns = walk(500);
  const auto of = [](const std::vector<Column>& trace) {
    TickHashes hashes;
    hashes.hash = std::get<std::vector<std::uint64_t>>(trace.back().values);
    for (std::size_t i = 0; i < hashes.hash.size(); ++i) hashes.tick.push_back(static_cast<int>(i));
    return hashes;
  };
  for (int trial = 0; trial < 200; ++trial) {
    const int tick = trial == 0 ? 0 : trial == 1 ? 499 : static_cast<int>(random() % 500);
    const TickHashes baseline = of(columns), candidate = of(changed_at(columns, tick, random));
    const HashComparison exact = compare_hashes(baseline, candidate);
    EXPECT_FALSE(exact.is_same());
    EXPECT_TRUE(exact.same_length);
    EXPECT_EQ(exact.different, tick);
    EXPECT_EQ(exact.same, tick == 0 ? std::nullopt : std::optional(tick - 1));
    const int ours = 1 + static_cast<int>(random() % 40), theirs = 1 + static_cast<int>(random() % 40);
    const HashComparison coarse = compare_hashes(every_nth(baseline, ours), every_nth(candidate, theirs));
    std::optional<int> before, from;  // the last tick of both before it, and the first not before it
    for (int i = 0; i < 500; ++i) {
      if (i != 499 && (i % ours != 0 || i % theirs != 0)) continue;
      if (i < tick) before = i;
      if (i >= tick && !from) from = i;
    }
    EXPECT_FALSE(coarse.is_same());
    EXPECT_EQ(coarse.same, before) << tick << ", every " << ours << " and " << theirs;
    EXPECT_EQ(coarse.different, from);
    const HashComparison same = compare_hashes(every_nth(baseline, ours), every_nth(baseline, theirs));
    EXPECT_TRUE(same.is_same() && same.same == 499 && !same.different);
  }
}

TEST(CompareHashes, OneRunIsLonger) {
  const TickHashes all = {{0, 1, 2, 3}, {10, 11, 12, 13}}, less = {{0, 1, 2}, {10, 11, 12}};
  for (const auto& [baseline, candidate] : {std::pair(all, less), std::pair(less, all)}) {
    const HashComparison comparison = compare_hashes(baseline, candidate);
    EXPECT_FALSE(comparison.is_same());
    EXPECT_FALSE(comparison.same_length);
    EXPECT_FALSE(comparison.different);
    EXPECT_EQ(comparison.same, 2);
    EXPECT_EQ(comparison.compared, 3u);
  }
  // Hashes without a common tick are not the same.
  const TickHashes even = {{0, 2, 4}, {10, 12, 14}}, odd = {{1, 3}, {11, 13}}, none;
  for (const auto& [baseline, candidate] :
       {std::pair(even, odd), std::pair(odd, even), std::pair(none, odd), std::pair(none, none)}) {
    const HashComparison comparison = compare_hashes(baseline, candidate);
    EXPECT_FALSE(comparison.is_same() || comparison.same || comparison.different);
    EXPECT_EQ(comparison.compared, 0u);
  }
}

// Rows that are the same in a comparison of all columns have the same hashes: 0 equals -0, and NaN equals
// NaN.
TEST(CompareHashes, EqualRowsHaveEqualHashes) {
  std::vector<Column> columns = walk(10);
  auto& numbers = std::get<std::vector<double>>(columns[2].values);
  numbers[4] = 0.0, numbers[5] = std::nan("1");
  columns = rehashed(columns);
  std::vector<Column> other = columns;
  auto& others = std::get<std::vector<double>>(other[2].values);
  others[4] = -0.0, others[5] = -std::nan("2");
  other = rehashed(other);
  EXPECT_FALSE(same_bits(columns[2], other[2]));
  EXPECT_TRUE(compare_traces(ColumnsInMemory(columns), ColumnsInMemory(other), {}, {}).is_same());
  EXPECT_EQ(columns.back().values, other.back().values);
}

// --- the figure of the deviation between two traces over time ---

using Numbers = std::vector<double>;

// Time in seconds and columns of zeros.
std::vector<Column> zeros(std::size_t rows, const std::vector<std::string>& names) {
  Numbers time(rows);
  std::iota(time.begin(), time.end(), 0.0);
  std::vector<Column> columns = {{"time", "s", "", time}};
  for (const std::string& name : names) columns.push_back({name, "m", "", Numbers(rows)});
  return columns;
}
double& value(std::vector<Column>& columns, std::size_t column, std::size_t row) {
  return std::get<Numbers>(columns[column].values)[row];
}

Figure figure_of(const std::vector<Column>& a, const std::vector<Column>& b,
                 const Tolerances& tolerances = {}) {
  const ColumnsInMemory baseline(a), candidate(b);
  return deviation_figure(baseline, candidate, compare_by_name(baseline, candidate, tolerances, {}));
}

// 2001 rows are more than the maximum of 2000 pieces, so each piece has two rows, and the last has one.
TEST(DeviationFigure, EachPieceShowsItsLargestDeviation) {
  const std::vector<Column> a = zeros(2001, {"x"});
  std::vector<Column> b = a;
  value(b, 1, 4) = 0.001, value(b, 1, 5) = -0.01;
  value(b, 1, 7) = std::numeric_limits<double>::quiet_NaN();
  value(b, 1, 1000) = 0.1, value(b, 1, 2000) = 100;
  const Figure figure = figure_of(a, b, {{"x", {0.05, 0}}});
  ASSERT_EQ(figure.tables.size(), 1u);  // the first row outside, 7, has no deviation to show
  const Numbers &when = numbers(figure.tables[0], "time"), &size = numbers(figure.tables[0], "deviation");
  ASSERT_EQ(size.size(), 1001u);
  for (std::size_t i = 0; i < size.size(); ++i) {
    EXPECT_EQ(when[i], 2.0 * static_cast<double>(i));
    if (i == 2 || i == 500 || i == 1000)
      EXPECT_NEAR(size[i], i == 2 ? -2 : i == 500 ? -1 : 2, 1e-12);
    else
      EXPECT_TRUE(std::isnan(size[i])) << i;
  }
  // Up to 2000 rows are drawn one by one, and the first row outside is marked.
  std::vector<Column> few = zeros(2000, {"x"});
  value(few, 1, 1999) = 1;
  const Figure each = figure_of(zeros(2000, {"x"}), few);
  ASSERT_EQ(each.tables.size(), 2u);
  EXPECT_EQ(numbers(each.tables[0], "deviation").size(), 2000u);
  EXPECT_EQ(numbers(each.tables[1], "time"), Numbers{1999});
  EXPECT_EQ(numbers(each.tables[1], "deviation"), Numbers{0});
}

TEST(DeviationFigure, CaptionTellsWhetherColumnsDiffer) {
  const std::vector<Column> a = zeros(5, {"x", "y"});
  std::vector<Column> b = a;
  EXPECT_EQ(figure_of(a, b).caption, "No column differs.");
  value(b, 1, 3) = 0.5;
  EXPECT_EQ(figure_of(a, b, {{"x", {1, 0}}}).caption, "1 column(s) differ, within the tolerances.");
  value(b, 2, 3) = 0.5;
  EXPECT_EQ(figure_of(a, b, {{"x", {1, 0}}}).caption, "2 column(s) differ.");
  const auto without_time = [](std::vector<Column> columns) {
    columns.erase(columns.begin());
    return columns;
  };
  EXPECT_EQ(figure_of(without_time(a), without_time(b)).caption,
            "2 column(s) differ. Nothing is drawn, because the baseline has no column time.");
  EXPECT_EQ(figure_of(without_time(a), without_time(a)).caption, "No column differs.");
}

TEST(DeviationFigure, HasAtMostEightPanelsInTheTracesOrder) {
  const std::vector<std::string> names = {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"};
  const std::vector<Column> a = zeros(5, names);
  std::vector<Column> b = a;
  for (std::size_t column = 2; column < b.size(); ++column) value(b, column, 3) = 1;
  const Figure figure = figure_of(a, b);
  ASSERT_EQ(figure.panels.size(), 8u);  // nine columns differ; "a" does not
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(figure.panels[i].title, names[i + 1]);
    EXPECT_EQ(figure.panels[i].y_label, "log10 of the deviation in m");
  }
  EXPECT_TRUE(figure_of(a, a).panels.empty());
}

}  // namespace
}  // namespace remote_touch::compared_columns_test
