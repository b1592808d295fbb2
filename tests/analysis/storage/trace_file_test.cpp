// Trace files hold every bit of a trace, and their digest distinguishes traces.
#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/storage/digest.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::trace_file_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// --- files ---

void expect_round_trip(int ticks) {
  SCOPED_TRACE(std::to_string(ticks) + " ticks");
  const TestFolder folder("trace_file_test");
  const Trace trace = awkward_trace(ticks);
  const std::string sum = write_trace(folder / "trace.h5", trace, kProvenance, {});
  const Hdf5Content content = read_hdf5(folder / "trace.h5");

  EXPECT_EQ(sum, digest(trace.columns()));
  EXPECT_EQ(attribute(content, "digest"), sum);
  EXPECT_EQ(attribute(content, "schema"), "remote-touch-trace/3");
  EXPECT_EQ(attribute(content, "default"), "trace");
  for (const auto& [name, value] : kProvenance) EXPECT_EQ(attribute(content, name), value);

  EXPECT_EQ(content.datasets.size(), trace.columns().size());
  std::vector<Column> stored;
  for (const Column& column : trace.columns()) {
    const Column* found = find(content, "/trace/" + column.name);
    ASSERT_NE(found, nullptr) << column.name;
    EXPECT_TRUE(same_bits(*found, column)) << column.name;
    EXPECT_EQ(found->length(), static_cast<std::size_t>(ticks)) << column.name;
    EXPECT_EQ(found->name, column.name);
    EXPECT_EQ(found->units, column.units);
    EXPECT_EQ(found->long_name, column.long_name);
    EXPECT_EQ(found->value_names, column.value_names);
    stored.push_back(*found);
  }
  EXPECT_EQ(digest(stored), sum);  // the content of the file is enough to check the digest
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"trace.h5"});
}

// Columns of up to 256 rows are not compressed, those of up to 4096 rows are one compressed chunk, and longer
// ones are several chunks.
TEST(TraceFile, TraceSurvivesBitForBit) {
  for (const int ticks : {1, 33, 4096, 4097, 10000}) expect_round_trip(ticks);
}

TEST(TraceFile, AnEmptyTraceSurvives) {
  expect_round_trip(0);
}

TEST(TraceFile, EveryColumnHasUnitsAndAName) {
  for (const Column& column : awkward_trace(1).columns()) {
    EXPECT_FALSE(column.units.empty()) << column.name;
    EXPECT_FALSE(column.long_name.empty()) << column.name;
  }
}

TEST(TraceFile, EqualContentIsEqualBytes) {
  const TestFolder folder("trace_file_test");
  const Trace trace = awkward_trace(5000);
  write_trace(folder / "a.h5", trace, kProvenance, {});
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's time stamps count seconds
  write_trace(folder / "b.h5", trace, kProvenance, {});
  EXPECT_EQ(bytes_of(folder / "a.h5"), bytes_of(folder / "b.h5"));
}

TEST(TraceFile, TimingIsStoredOutsideTheDigest) {
  const TestFolder folder("trace_file_test");
  const Trace trace = awkward_trace(3);
  const std::string plain = write_trace(folder / "plain.h5", trace, kProvenance, {});
  const std::vector<double> timing = {1e-6, 2e-6, 3e-6};
  EXPECT_EQ(write_trace(folder / "timed.h5", trace, kProvenance, timing), plain);
  const Hdf5Content content = read_hdf5(folder / "timed.h5");
  EXPECT_EQ(attribute(content, "digest"), plain);
  const Column* stored = find(content, "/timing/step_duration");
  ASSERT_NE(stored, nullptr);
  EXPECT_EQ(stored->units, "s");
  EXPECT_EQ(std::get<std::vector<double>>(stored->values), timing);
  EXPECT_EQ(find(read_hdf5(folder / "plain.h5"), "/timing/step_duration"), nullptr);
}

// A configuration with thousands of waypoints is longer than an attribute of old HDF5 files may be.
TEST(TraceFile, StoresALongConfiguration) {
  const TestFolder folder("trace_file_test");
  const std::string config = "[" + std::string(1 << 20, ' ') + "]";
  write_trace(folder / "long.h5", awkward_trace(2), {{"config", config}, {"isa", "x86-64"}}, {});
  const Hdf5Content content = read_hdf5(folder / "long.h5");
  EXPECT_EQ(attribute(content, "config"), config);
  EXPECT_EQ(attribute(content, "isa"), "x86-64");
}

// --- digest ---

TEST(Digest, KnownValue) {
  // SHA-256 of the ten bytes "x", 0, int 1, int 7, as any other program computes it.
  const std::vector<Column> columns = {{"x", "1", "", std::vector<std::int32_t>{7}}};
  EXPECT_EQ(digest(columns), "3c9321a871dab2c96afe862488edb30946335a7c28e9f1b63b10c2628145004d");
  EXPECT_EQ(digest(std::vector<Column>{}),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(Digest, EveryBitOfEveryColumnCounts) {
  const std::vector<Column> columns = awkward_trace(4).columns();
  const std::string want = digest(columns);
  EXPECT_EQ(digest(awkward_trace(4).columns()), want);
  for (std::size_t c = 0; c < columns.size(); ++c) {
    std::vector<Column> changed = columns;
    std::visit(
        [](auto& values) {
          reinterpret_cast<unsigned char*>(values.data() + values.size() - 1)[0] ^= 1;  // the last bit
        },
        changed[c].values);
    EXPECT_NE(digest(changed), want) << columns[c].name;
    changed = columns;
    changed[c].name += "x";
    EXPECT_NE(digest(changed), want) << columns[c].name;
  }
}

TEST(Digest, DistinguishesSignsOrderAndShape) {
  const auto of = [](std::vector<double> values, int width = 1) {
    return digest(std::vector<Column>{{"x", "1", "", std::move(values), width, {}}});
  };
  EXPECT_NE(of({0.0}), of({-0.0}));
  EXPECT_NE(of({1, 2}), of({1, 2}, 2));
  EXPECT_NE(of({1, 2}), of({2, 1}));
  EXPECT_NE(of({}), of({0}));
  EXPECT_EQ(of({kNan}), of({kNan}));
  std::vector<Column> columns = awkward_trace(2).columns();
  std::swap(columns[1], columns[2]);
  EXPECT_NE(digest(columns), digest(awkward_trace(2).columns()));
}

}  // namespace
}  // namespace remote_touch::trace_file_test
