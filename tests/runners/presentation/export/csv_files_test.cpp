#include "runners/presentation/export/csv_files.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>

#include "runners/presentation/export/result_tables.h"

namespace remote_touch::csv_files_test {
namespace {

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

TEST(CsvFiles, WritesNumbersThatAreNotFinite) {
  const double infinity = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  const Table table{"t", "", {numbers("a", {nan, -nan, infinity, -infinity, -0.0})}};
  EXPECT_EQ(csv_rows(table, 0, 5), "nan\nnan\ninf\n-inf\n-0\n");
}

TEST(CsvFiles, WritesNamesHashesAndTexts) {
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

TEST(CsvFiles, WritesOnlyTheGivenRows) {
  const Table table{"t", "", {numbers("a", {1, 2, 3, 4})}};
  EXPECT_EQ(csv_rows(table, 1, 3), "2\n3\n");
  EXPECT_EQ(csv_rows(table, 4, 4), "");
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
}  // namespace remote_touch::csv_files_test
