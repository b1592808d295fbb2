#include "analysis/storage/trace_comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "analysis/storage/result_file.h"
#include "tests/analysis/storage/changed_traces.h"
#include "tests/support/test_files.h"

namespace remote_touch::trace_comparison_test {
namespace {

// Comparison of two traces: what differs, and from which tick on.

using namespace changed_traces;

// --- what differs, and from which tick on ---

TEST(CompareTraces, TheSameRunIsTheSame) {
  const TraceComparison same = compare(lift(), lift());
  EXPECT_TRUE(same.is_same());
  EXPECT_FALSE(same.divergence);
  EXPECT_TRUE(same.added.empty());
  ASSERT_EQ(same.columns.size() + 1, lift().size());  // all but the running hash
  for (std::size_t i = 0; i < same.columns.size(); ++i) {
    EXPECT_EQ(same.columns[i].name, lift()[i].name);
    EXPECT_EQ(same.columns[i].rows, length());
  }
  // Traces with the same numbers are the same, even if their experiments differ.
  EXPECT_TRUE(compare(lift(), lift(), {}, {"renderer.r1_m 1 against 2"}).is_same());
}

// Each column in turn is changed from a random tick to the end.
TEST(CompareTraces, FindsTheFirstDivergentTickOfEveryColumn) {
  std::mt19937 random(1);
  for (const Column& column : lift()) {
    if (column.name == "tick_hash") continue;
    const std::size_t tick = random() % length();
    const Divergence found = divergence(after([&](Columns& candidate) {
      std::visit(
          [&](auto& values) {
            if constexpr (std::is_arithmetic_v<typename std::decay_t<decltype(values)>::value_type>)
              for (std::size_t i = tick * static_cast<std::size_t>(column.width); i < values.size(); ++i)
                values[i] += 1;
          },
          find(candidate, column.name).values);
    }));
    EXPECT_EQ(found.tick, tick) << column.name;
    EXPECT_EQ(found.first_difference, tick) << column.name;
    EXPECT_EQ(found.quantity, column.name);
    EXPECT_DOUBLE_EQ(found.time_s, 0.001 * static_cast<double>(tick));
    EXPECT_NEAR(found.deviation, column.width == 3 ? std::sqrt(3.0) : 1, 1e-12) << column.name;
  }
}

// Neither the order nor the size of the changes matters.
TEST(CompareTraces, AmongColumnsTheTraceOrderDecidesAndTimeBeforeIt) {
  const Divergence together = divergence(after([](Columns& c) {
    numbers(c, "force")[3 * 700 + 1] += 5;
    proxy_x(c, 700) += 1e-9;
  }));
  EXPECT_EQ(together.quantity, "proxy_position");
  EXPECT_NEAR(together.deviation, 1e-9, 1e-15);
  const Divergence earlier = divergence(after([](Columns& c) {
    numbers(c, "force")[3 * 699 + 1] += 5;
    proxy_x(c, 700) += 1;
  }));
  EXPECT_EQ(earlier.tick, 699u);
  EXPECT_EQ(earlier.quantity, "force");
  EXPECT_DOUBLE_EQ(earlier.deviation, 5);
}

TEST(CompareTraces, FindsTheFirstTickAndTheLast) {
  const Divergence first = divergence(after([](Columns& c) { proxy_x(c, 0) += 1; }));
  EXPECT_EQ(first.tick, 0u);
  EXPECT_EQ(first.time_s, 0);
  EXPECT_EQ(first.first_row, 0u);
  for (const auto* rows : {&first.baseline, &first.candidate})
    for (const Column& column : *rows) EXPECT_EQ(column.length(), 1u) << column.name;

  const std::size_t end = length() - 1;
  const Divergence last = divergence(after([&](Columns& c) { proxy_x(c, end) += 1; }));
  EXPECT_EQ(last.tick, end);
  EXPECT_EQ(last.first_row, end - 1);
  EXPECT_EQ(last.baseline.front().length(), 2u);
}

TEST(CompareTraces, TheRunningHashIsNotJudged) {
  EXPECT_TRUE(after([](Columns& c) { hashes(c, "tick_hash")[3] ^= 1; }).is_same());
  const TraceComparison without = after([](Columns& c) { c.pop_back(); });
  EXPECT_TRUE(without.is_same());
  const Columns no_hash(lift().begin(), lift().end() - 1);
  EXPECT_TRUE(compare(no_hash, lift()).added.empty());
}

// --- tolerances ---

// The runs begin to differ within the tolerance, and exceed it later. Both ticks are reported, and the
// situation is that at the first difference.
TEST(CompareTraces, RunsPartBeforeTheyLeaveTheTolerance) {
  const std::size_t quiet = quiet_tick(), later = tick_where(true, false, quiet + 100);
  const Change change = [&](Columns& c) {
    numbers(c, "force")[3 * quiet] += 1e-12;
    proxy_x(c, later) += 1e-3;
  };
  const TraceComparison comparison = after(change, {{"*", {1e-9, 0}}});
  const Divergence found = divergence(comparison);
  EXPECT_EQ(found.tick, later);
  EXPECT_EQ(found.quantity, "proxy_position");
  EXPECT_NEAR(found.deviation, 1e-3, 1e-12);
  EXPECT_EQ(found.first_difference, quiet);
  EXPECT_EQ(found.cause, Cause::drift);
  EXPECT_EQ(found.first_row, quiet - 1);
  EXPECT_EQ(find(found.candidate, "force").length(), 2u);
  for (const ColumnComparison& column : comparison.columns) {
    const bool force = column.name == "force", proxy = column.name == "proxy_position";
    EXPECT_EQ(column.is_same(), !proxy) << column.name;
    EXPECT_EQ(column.first_difference.has_value(), force || proxy) << column.name;
  }
  // The same two runs diverge at the first difference if there is no tolerance.
  const Divergence exact = divergence(after(change));
  EXPECT_EQ(exact.tick, quiet);
  EXPECT_EQ(exact.quantity, "force");
  // They are the same within a tolerance that is wide enough, but the difference is reported.
  const TraceComparison wide = after(change, {{"*", {0.1, 0}}});
  EXPECT_TRUE(wide.is_same());
  EXPECT_FALSE(wide.divergence);
  EXPECT_NEAR(wide.columns[2].max, 1e-3, 1e-12);
}

TEST(CompareTraces, ATolerancesNameIsAColumnOrAllOthers) {
  const Change change = [](Columns& c) {
    numbers(c, "force")[0] += 1e-3;
    proxy_x(c, 5) += 1e-3;
  };
  EXPECT_EQ(divergence(after(change, {{"force", {1, 0}}})).quantity, "proxy_position");
  EXPECT_EQ(divergence(after(change, {{"*", {1, 0}}, {"force", {}}})).quantity, "force");
  EXPECT_TRUE(after(change, {{"force", {1, 0}}, {"proxy_position", {1, 0}}}).is_same());
}

TEST(CompareTraces, ANumberAgainstNoneIsADivergenceWhateverTheTolerance) {
  for (const double none : {kNaN, kInfinity, -kInfinity}) {
    const TraceComparison comparison =
        after([&](Columns& c) { proxy_x(c, 40) = none; }, {{"*", {kInfinity, kInfinity}}});
    const Divergence found = divergence(comparison);
    EXPECT_EQ(found.tick, 40u);
    EXPECT_TRUE(std::isnan(found.deviation));
    EXPECT_EQ(comparison.columns[2].not_numbers, 1u);
  }
  Columns both = lift();
  proxy_x(both, 40) = kNaN;
  EXPECT_TRUE(compare(both, both).is_same());
  EXPECT_FALSE(compare(both, lift()).is_same());
}

// --- shapes ---

TEST(CompareTraces, AMissingColumnIsAProblemAndAnAddedOneIsNot) {
  const Columns less(lift().begin() + 1, lift().end());  // no time
  const TraceComparison missing = compare(lift(), less);
  EXPECT_FALSE(missing.is_same());
  EXPECT_FALSE(missing.divergence);
  EXPECT_EQ(missing.columns.front().problem, "missing in the candidate");
  EXPECT_EQ(missing.columns.front().rows, 0u);
  const TraceComparison added = compare(less, lift());
  EXPECT_TRUE(added.is_same());
  EXPECT_EQ(added.added, Texts{"time"});
  // The column is of another experiment, not of a later program.
  const TraceComparison other = compare(less, lift(), {}, {"seed 1 against 2"});
  EXPECT_TRUE(other.added.empty());
  EXPECT_EQ(other.columns.back().name, "time");
  EXPECT_EQ(other.columns.back().problem, "missing in the baseline");
  for (std::size_t i = 0; i + 1 < lift().size(); ++i) {  // all but the running hash
    Columns without = lift();
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_FALSE(compare(lift(), without).is_same()) << lift()[i].name;
    EXPECT_FALSE(compare(without, lift(), {}, {"seed 1 against 2"}).is_same()) << lift()[i].name;
  }
  // A divergence is found in the other columns.
  Columns changed = less;
  proxy_x(changed, 300) += 1;
  EXPECT_EQ(divergence(compare(lift(), changed)).tick, 300u);
  const Divergence untimed = divergence(compare(less, changed));
  EXPECT_EQ(untimed.tick, 300u);
  EXPECT_TRUE(std::isnan(untimed.time_s));
  Columns of_texts = lift();
  of_texts.front().values = std::vector<std::string>(length(), "now");
  EXPECT_EQ(divergence(compare(of_texts, changed)).tick, 300u);
}

Columns shortened(const Columns& columns, std::size_t rows) {
  Columns some;
  const ColumnsInMemory all(columns);
  for (const Column& column : columns) some.push_back(all.rows(column.name, 0, rows));
  return some;
}

TEST(CompareTraces, OneRunIsLonger) {
  const Columns half = shortened(lift(), 400);
  for (const auto& [baseline, candidate] : {std::pair(lift(), half), std::pair(half, lift())}) {
    const TraceComparison comparison = compare(baseline, candidate, {{"*", {1, 1}}});
    EXPECT_FALSE(comparison.is_same());
    EXPECT_FALSE(comparison.divergence);  // the ticks that both have are equal
    for (const ColumnComparison& column : comparison.columns) {
      EXPECT_EQ(column.rows, 400u) << column.name;
      EXPECT_EQ(column.outside, 0u) << column.name;
      EXPECT_HAS(column.problem, "against");
    }
  }
  Columns changed = half;
  proxy_x(changed, 399) += 1;
  EXPECT_EQ(divergence(compare(lift(), changed)).tick, 399u);
  EXPECT_EQ(divergence(compare(changed, lift())).tick, 399u);
}

TEST(CompareTraces, NoRowsAreNotTheSame) {
  const Columns none = shortened(lift(), 0);
  for (const auto& [baseline, candidate] :
       {std::pair(none, none), std::pair(none, lift()), std::pair(lift(), none)}) {
    const TraceComparison comparison = compare(baseline, candidate);
    EXPECT_FALSE(comparison.is_same());
    EXPECT_FALSE(comparison.divergence);
  }
  EXPECT_FALSE(compare(Columns{}, Columns{}).is_same());
  EXPECT_FALSE(compare(Columns{}, lift()).is_same());
}

// --- files ---

// Files, read in pieces, give the same comparison as columns in memory; 5000 ticks are stored in chunks.
TEST(CompareTraces, FilesGiveTheSameResultAsMemory) {
  const TestFolder folder("trace_comparison_test");
  const Columns baseline = simulate(Experiment::load("fig4.14", {"duration_s=5"})).columns();
  ASSERT_EQ(baseline.front().length(), 5000u);
  Columns candidate = baseline;
  proxy_x(candidate, 4096) += 1e-12;
  numbers(candidate, "force")[3 * 4500] += 1;
  write_trace(folder / "a.h5", baseline, {}, {}), write_trace(folder / "b.h5", candidate, {}, {});
  const StoredTrace a(folder / "a.h5"), b(folder / "b.h5");
  EXPECT_TRUE(compare_traces(a, a, {}, {}).is_same());
  const Tolerances tolerances = {{"*", {1e-9, 0}}};
  const TraceComparison stored = compare_traces(a, b, tolerances, {}),
                        held = compare(baseline, candidate, tolerances);
  const Divergence from_files = divergence(stored), from_memory = divergence(held);
  EXPECT_EQ(from_files.tick, 4500u);
  EXPECT_EQ(from_files.first_difference, 4096u);
  EXPECT_EQ(from_files.quantity, "force");
  EXPECT_EQ(from_files.deviation, from_memory.deviation);
  EXPECT_EQ(from_files.explanation, from_memory.explanation);
  EXPECT_EQ(from_files.frame, from_memory.frame);
  ASSERT_EQ(from_files.baseline.size(), from_memory.baseline.size());
  for (std::size_t i = 0; i < from_files.baseline.size(); ++i) {
    EXPECT_EQ(from_files.baseline[i].values, from_memory.baseline[i].values);
    EXPECT_EQ(from_files.candidate[i].values, from_memory.candidate[i].values);
  }
  ASSERT_EQ(stored.columns.size(), held.columns.size());
  for (std::size_t i = 0; i < stored.columns.size(); ++i)
    EXPECT_EQ(stored.columns[i].max, held.columns[i].max);
}

// The figure of the deviation between two traces over time.

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
}

TEST(DeviationFigure, UpTo2000RowsAreDrawnOneByOne) {
  const std::vector<Column> a = zeros(2000, {"x"});
  std::vector<Column> b = a;
  value(b, 1, 1999) = 1;
  const Figure figure = figure_of(a, b);
  ASSERT_EQ(figure.tables.size(), 2u);
  EXPECT_EQ(numbers(figure.tables[0], "deviation").size(), 2000u);
  EXPECT_EQ(numbers(figure.tables[1], "time"), Numbers{1999});
  EXPECT_EQ(numbers(figure.tables[1], "deviation"), Numbers{0});
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
}  // namespace remote_touch::trace_comparison_test
