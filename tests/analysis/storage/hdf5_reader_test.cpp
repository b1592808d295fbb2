// The answer of a child process about an HDF5 file arrives unchanged, or is refused.
#include "analysis/storage/hdf5_reader.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/test_files.h"

namespace remote_touch::hdf5_source_test {
namespace {

const Hdf5Summary kSummary{{{"schema", "x"}, {"empty", ""}}, {"/a", "/b/c"}, {-1, 2048}};

std::vector<Column> columns() {
  return {{"x", "m", "a vector", std::vector<double>{1, -0.0, 5e-324, 1e300, 2, 3}, 3, {}},
          {"state", "1", "", std::vector<std::int32_t>{0, 1, -7}, 1, {"no", "yes"}},
          {"hash", "1", "", std::vector<std::uint64_t>{0, ~std::uint64_t{0}}},
          {"name", "", "", std::vector<std::string>{"", "gr\xc3\xbcn", std::string("a\0b", 3)}},
          {"none", "s", "", std::vector<double>{}}};
}

TEST(ChildAnswer, ComesBackAsItWas) {
  const Hdf5Summary summary = unpacked_summary(packed(kSummary));
  EXPECT_EQ(summary.attributes, kSummary.attributes);
  EXPECT_EQ(summary.datasets, kSummary.datasets);
  EXPECT_EQ(summary.offsets, kSummary.offsets);
  for (const Column& column : columns()) {
    const Column again = unpacked_column(packed(column));
    EXPECT_EQ(again.name, column.name);
    EXPECT_EQ(again.units, column.units);
    EXPECT_EQ(again.long_name, column.long_name);
    EXPECT_EQ(again.values, column.values);
    EXPECT_EQ(again.width, column.width);
    EXPECT_EQ(again.value_names, column.value_names);
  }
}

TEST(ChildAnswer, IsRefusedIfItIsCutOrTooLong) {
  const std::string summary = packed(kSummary);
  for (std::size_t length = 0; length < summary.size(); ++length)
    EXPECT_THROW(unpacked_summary(summary.substr(0, length)), std::runtime_error) << length;
  EXPECT_THROW(unpacked_summary(summary + '\0'), std::runtime_error);
  for (const Column& column : columns()) {
    const std::string bytes = packed(column);
    for (std::size_t length = 0; length < bytes.size(); ++length)
      EXPECT_THROW(unpacked_column(bytes.substr(0, length)), std::runtime_error) << column.name << length;
    EXPECT_THROW(unpacked_column(bytes + '\0'), std::runtime_error) << column.name;
  }
}

TEST(ChildAnswer, IsRefusedIfItsRowsAreNotWhole) {
  Column column = columns()[0];
  for (const int width : {0, -1, 4, 7}) {
    column.width = width;
    EXPECT_THROW(unpacked_column(packed(column)), std::runtime_error) << width;
  }
}

}  // namespace
}  // namespace remote_touch::hdf5_source_test
