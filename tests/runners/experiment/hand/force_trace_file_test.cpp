#include "runners/experiment/hand/force_trace_file.h"

#include <gtest/gtest.h>

#include "tests/support/test_files.h"

namespace remote_touch::force_trace_file_test {
namespace {

const std::string kColumns = "time_s x_mm y_mm z_mm fx_N fy_N fz_N";

class ForceTraceFile : public testing::Test {
 protected:
  ForceTrace read(const std::string& name, const std::string& text, const std::string& columns = kColumns) {
    return read_force_trace(folder_.write(name, text), columns);
  }
  std::string refused(const std::string& name, const std::string& text,
                      const std::string& columns = kColumns) {
    return refusal([&] { read(name, text, columns); });
  }

 private:
  const TestFolder folder_{"force_trace_file"};
};

void expect_row(const ForceTraceRow& row, double time_s, const Vec3& contact_m, const Vec3& force_N) {
  EXPECT_DOUBLE_EQ(row.time_s, time_s);
  EXPECT_LT((row.contact_m - contact_m).norm(), 1e-15) << row.contact_m.transpose();
  EXPECT_LT((row.force_N - force_N).norm(), 1e-15) << row.force_N.transpose();
}

TEST_F(ForceTraceFile, ReadsColumnsOfBlanksInMillimetres) {
  const ForceTrace trace = read("a.traj",
                                "# probe of a plane\n"
                                "0 10 -20 30 0 0 0\n"
                                "\n"
                                "  0.5\t11 -20.5 3e1 0.25 -1 +2 \r\n"
                                "% the end\n"
                                "0.75 12 -21 30 0 0 1");
  ASSERT_EQ(trace.rows.size(), 3u);
  expect_row(trace.rows[0], 0, {0.01, -0.02, 0.03}, {0, 0, 0});
  expect_row(trace.rows[1], 0.5, {0.011, -0.0205, 0.03}, {0.25, -1, 2});
  expect_row(trace.rows[2], 0.75, {0.012, -0.021, 0.03}, {0, 0, 1});
  EXPECT_TRUE(trace.unused.empty());
}

TEST_F(ForceTraceFile, ReadsCsvByTheNamesOfItsColumns) {
  const ForceTrace trace = read("a.CSV",
                                "\xEF\xBB\xBF"
                                "fz, Time_ms ,px,PY_mm,pz_m,qw,fx_N,fy\r\n"
                                "3,0,0.1,200,0.3,x,1,2\r\n"
                                "6,250,0.4,500,0.6,,4,5\r\n");
  ASSERT_EQ(trace.rows.size(), 2u);
  expect_row(trace.rows[0], 0, {0.1, 0.2, 0.3}, {1, 2, 3});
  expect_row(trace.rows[1], 0.25, {0.4, 0.5, 0.6}, {4, 5, 6});
  EXPECT_EQ(trace.unused, std::vector<std::string>{"qw"});
}

TEST_F(ForceTraceFile, NamesTheColumnsThatAreNotUsed) {
  const ForceTrace trace =
      read("a.traj", "7 0 1 2 3 4 5 6 8 9\n7 1 1 2 3 4 5 6 8 9\n", "count t x y z fx fy fz");
  ASSERT_EQ(trace.rows.size(), 2u);
  expect_row(trace.rows[1], 1, {1, 2, 3}, {4, 5, 6});
  EXPECT_EQ(trace.unused, (std::vector<std::string>{"count", "column 9", "column 10"}));
}

TEST_F(ForceTraceFile, RefusesColumnsInOneLine) {
  EXPECT_HAS(refused("a.csv", "time,x,y,z,fx,fy\n"), "a.csv:1: no column fz: expected time, x, y, z");
  EXPECT_HAS(refused("a.csv", "# comment\ntime,x_cm,y,z,fx,fy,fz\n"), "a.csv:2: no column x: expected");
  EXPECT_HAS(refused("a.csv", "time,x,y,z,fx,fy,fz,px_mm\n"),
             "a.csv:1: column px_mm: expected one column of x");
  EXPECT_HAS(refused("a.traj", "0 0 0 0 0 0 0\n", "time x y z"), "trajectory.columns: no column fx");
}

TEST_F(ForceTraceFile, RefusesRowsInOneLine) {
  const std::string begin = "time,x,y,z,fx,fy,fz\n0,0,0,0,0,0,0\n";
  EXPECT_HAS(refused("a.csv", begin + "1,0,0,0,0,0\n"), "a.csv:3: 6 values: expected 7");
  EXPECT_HAS(refused("a.csv", begin + "1,0,0,0,0,0,0,0\n"), "a.csv:3: 8 values: expected 7");
  EXPECT_HAS(refused("a.csv", begin + "\n1,0,0,0,1N,0,0\n"), "a.csv:4: '1N' in column fx: expected a number");
  EXPECT_HAS(refused("a.csv", begin + "1,0,0,nan,0,0,0\n"), "a.csv:3: 'nan' in column z: expected a number");
  EXPECT_HAS(refused("a.csv", begin + "1,0,0,,0,0,0\n"), "a.csv:3: '' in column z");
  EXPECT_HAS(refused("a.csv", begin + "0,0,0,0,0,0,0\n"), "a.csv:3: time 0.000000 s: expected above");
  EXPECT_HAS(refused("a.csv", begin + "1,0,250,0,0,0,0\n"), "a.csv:3: a position more than 100 m");
  EXPECT_HAS(refused("a.csv", begin), "a.csv: has 1 row(s): expected 2 or more");
  EXPECT_HAS(refused("a.csv", ""), "a.csv: has 0 row(s)");
  EXPECT_HAS(refused("a.traj", "0 1 2 3 4 5\n"), "a.traj:1: 6 values: expected 7 or more");
}

TEST_F(ForceTraceFile, RefusesOtherFiles) {
  EXPECT_HAS(refused("a.txt", "0 0 0 0 0 0 0\n"), "a.txt: expected a file that ends in .csv or .traj");
  EXPECT_HAS(refusal([] { read_force_trace("/no/such/file.traj", kColumns); }),
             "/no/such/file.traj: cannot be read");
}

}  // namespace
}  // namespace remote_touch::force_trace_file_test
