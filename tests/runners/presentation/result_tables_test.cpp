// The tables of results, and their rows as CSV.
#include "runners/presentation/export_formats.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>

#include "analysis/storage/result_file.h"
#include "analysis/sweeps/sweep_file.h"
#include "analysis/trace/trace.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::result_tables_test {
namespace {

TEST(ResultTables, ATraceHasOneTableOfItsColumnsAndTheDurations) {
  const TestFolder folder("result_tables");
  const Trace trace = awkward_trace(5);
  write_trace(folder / "a.h5", trace, kProvenance, {1, 2, 3, 4, 5});
  const std::vector<Table> tables = result_tables(Hdf5Reader(folder / "a.h5"));
  ASSERT_EQ(tables.size(), 1u);
  const std::vector<Column> columns = trace.columns();
  ASSERT_EQ(tables[0].columns.size(), columns.size() + 1);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    EXPECT_EQ(tables[0].columns[i].name, columns[i].name);
    EXPECT_TRUE(same_bits(tables[0].columns[i], columns[i])) << columns[i].name;
  }
  EXPECT_EQ(tables[0].columns.back().name, "step_duration");
}

TEST(ResultTables, OneInSoManyTicksIsKeptAndTheLast) {
  const TestFolder folder("result_tables");
  const Trace trace = awkward_trace(6);
  write_trace(folder / "a.h5", trace, kProvenance, {1, 2, 3, 4, 5, 6});
  const Hdf5Reader result(folder / "a.h5");
  NewFiles files;
  const std::vector<Table> tables = result_tables({result, "x.csv", files, {}, nullptr, nullptr, 2});
  ASSERT_EQ(tables.size(), 1u);
  const std::vector<Column>& columns = tables[0].columns;
  EXPECT_EQ(columns.front().name, "tick");
  EXPECT_EQ(std::get<std::vector<std::int32_t>>(columns.front().values),
            (std::vector<std::int32_t>{0, 2, 4, 5}));
  EXPECT_EQ(std::get<std::vector<double>>(columns.back().values), (std::vector<double>{1, 3, 5, 6}));
  const Column whole = trace.columns()[1];  // a vector
  ASSERT_EQ(columns[2].name, whole.name);
  const auto &all = std::get<std::vector<double>>(whole.values),
             &some = std::get<std::vector<double>>(columns[2].values);
  ASSERT_EQ(some.size(), 12u);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(some[10]), std::bit_cast<std::uint64_t>(all[16]));
}

SweepResult two_by_two() {
  SweepResult sweep;
  sweep.axes = {{"rule", "1", "", std::vector<std::int32_t>{0, 1}, 1, {"none", "all"}},
                {"noise_m", "m", "", std::vector<double>{0.5, 0.25}, 1, {}}};
  sweep.replicates = 2;
  sweep.measures = {{"depth", "m", "", std::vector<double>{}, 1, {}}};
  sweep.start(false);
  for (std::size_t run = 0; run < sweep.run_count(); ++run) {
    sweep.state[run] = run == 5 ? RunState::failed : RunState::done;
    std::get<std::vector<double>>(sweep.measures[0].values)[run] =
        run == 5 ? std::numeric_limits<double>::quiet_NaN() : 10.0 * static_cast<double>(run);
  }
  sweep.error[5] = "no \u00e9lan";
  return sweep;
}

// There is a row for each run. The replicates change fastest, then the last axis.
TEST(ResultTables, ASweepHasARowForEachRun) {
  const TestFolder folder("result_tables");
  write_sweep(folder / "a.h5", two_by_two(), kProvenance);
  const std::vector<Table> tables = result_tables(Hdf5Reader(folder / "a.h5"));
  ASSERT_EQ(tables.size(), 1u);
  std::vector<std::string> names;
  for (const Column& column : tables[0].columns) names.push_back(column.name);
  EXPECT_EQ(names, (std::vector<std::string>{"rule", "noise_m", "replicate", "state", "depth", "error"}));
  const auto integers = [&](std::size_t i) {
    return std::get<std::vector<std::int32_t>>(tables[0].columns[i].values);
  };
  EXPECT_EQ(integers(0), (std::vector<std::int32_t>{0, 0, 0, 0, 1, 1, 1, 1}));
  EXPECT_EQ(tables[0].columns[0].value_names, (std::vector<std::string>{"none", "all"}));
  EXPECT_EQ(std::get<std::vector<double>>(tables[0].columns[1].values),
            (std::vector<double>{0.5, 0.5, 0.25, 0.25, 0.5, 0.5, 0.25, 0.25}));
  EXPECT_EQ(integers(2), (std::vector<std::int32_t>{0, 1, 0, 1, 0, 1, 0, 1}));
  EXPECT_EQ(integers(3)[5], static_cast<std::int32_t>(RunState::failed));
  EXPECT_EQ(std::get<std::vector<double>>(tables[0].columns[4].values)[7], 70);
  EXPECT_EQ(std::get<std::vector<std::string>>(tables[0].columns[5].values)[5], "no \u00e9lan");
}

TEST(ResultTables, NameTheKindsOfNotesOfASweep) {
  const TestFolder folder("result_tables");
  SweepResult sweep = two_by_two();
  sweep.note_kinds = {"no contact", "frames unused"};
  sweep.notes = {0, 1, 2, 3, 0, 0, 0, 0};
  write_sweep(folder / "a.h5", sweep, kProvenance);
  const Table table = result_tables(Hdf5Reader(folder / "a.h5"))[0];
  const Column& notes = table.columns[table.columns.size() - 2];
  EXPECT_EQ(notes.name, "notes");
  EXPECT_EQ(std::get<std::vector<std::string>>(notes.values),
            (std::vector<std::string>{"", "no contact", "frames unused", "no contact; frames unused", "", "",
                                      "", ""}));
}

TEST(ResultTables, AFigureHasItsTables) {
  const TestFolder folder("result_tables");
  Figure figure;
  figure.name = "x";
  figure.tables.resize(2);
  figure.tables[0].name = "b", figure.tables[1].name = "a";
  figure.tables[0].add("u", "m", "", {1, 2});
  figure.tables[1].columns.push_back({"word", "1", "", std::vector<std::string>{"one", "", "three"}, 1, {}});
  figure.tables[1].columns.push_back({"vector", "m", "", std::vector<double>(9, 4.0), 3, {}});
  write_figure(folder / "a.h5", figure, kProvenance);
  const std::vector<Table> tables = result_tables(Hdf5Reader(folder / "a.h5"));
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].name, "a");
  ASSERT_EQ(tables[0].columns.size(), 2u);  // dimensions are no columns
  EXPECT_EQ(tables[0].columns[0].width, 3);
  EXPECT_EQ(std::get<std::vector<std::string>>(tables[0].columns[1].values),
            (std::vector<std::string>{"one", "", "three"}));
  EXPECT_EQ(std::get<std::vector<double>>(tables[1].columns[0].values), (std::vector<double>{1, 2}));
}

TEST(ResultTables, OtherFilesAreRefused) {
  const TestFolder folder("result_tables");
  std::vector<Column> columns = awkward_trace(3).columns();
  std::get<std::vector<std::uint64_t>>(columns.back().values).pop_back();
  write_trace(folder / "short.h5", columns, kProvenance, {});
  EXPECT_HAS(refusal([&] { result_tables(Hdf5Reader(folder / "short.h5")); }), "is not as long as time");
}

Column numbers(const char* name, std::vector<double> values, int width = 1) {
  return {name, "m", "", std::move(values), width, {}};
}

TEST(CsvFiles, NamesEveryNumberOfARow) {
  const Table table{"t",
                    "",
                    {numbers("time", {0}), numbers("force", {1, 2, 3}, 3), numbers("pose", {1, 0, 0, 0}, 4),
                     numbers("pair", {5, 6}, 2)}};
  EXPECT_EQ(csv_header(table), "time,force_x,force_y,force_z,pose_w,pose_x,pose_y,pose_z,pair_0,pair_1\n");
  EXPECT_EQ(csv_rows(table, 0, 1), "0,1,2,3,1,0,0,0,5,6\n");
}

TEST(CsvFiles, WritesNumbersNamesHashesAndTexts) {
  const double infinity = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(csv_rows({"t", "", {numbers("a", {nan, -nan, infinity, -infinity, -0.0, 7})}}, 0, 5),
            "nan\nnan\ninf\n-inf\n-0\n");
  const Table table{
      "t",
      "",
      {{"state", "1", "", std::vector<std::int32_t>{1, 0, 7, -1}, 1, {"free", "in, contact"}},
       {"hash", "1", "", std::vector<std::uint64_t>{~0ull, 0, 1, 2}, 1, {}},
       {"error", "1", "", std::vector<std::string>{"", "a,b", "say \"no\"", "two\nlines"}, 1, {}}}};
  EXPECT_EQ(csv_rows(table, 0, 4),
            "\"in, contact\",18446744073709551615,\nfree,0,\"a,b\"\n7,1,\"say \"\"no\"\"\"\n"
            "-1,2,\"two\nlines\"\n");
}

// The C library reads back the same bits.
TEST(CsvFiles, EveryNumberSurvives) {
  std::mt19937_64 random(1);
  std::vector<double> values{0.1, 5e-324, 1.7976931348623157e308, 1.0 / 3};
  while (values.size() < 20000) {
    const double value = std::bit_cast<double>(random());
    if (std::isfinite(value)) values.push_back(value);
  }
  std::istringstream lines(csv_rows({"t", "", {numbers("a", values)}}, 0, values.size()));
  for (const double value : values) {
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    ASSERT_EQ(std::bit_cast<std::uint64_t>(std::strtod(line.c_str(), nullptr)),
              std::bit_cast<std::uint64_t>(value))
        << line;
  }
}

}  // namespace
}  // namespace remote_touch::result_tables_test
