// Result files: traces and figures bit by bit, claims, and the seal that finds a changed byte.
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "analysis/storage/atomic_file.h"
#include "analysis/storage/digest.h"
#include "analysis/storage/hdf5_reader.h"
#include "analysis/storage/other_processes.h"
#include "analysis/storage/result_file.h"
#include "analysis/trace/trace.h"
#include "tests/support/result_files.h"
#include "tests/support/test_files.h"

// Trace files hold every bit of a trace, and their digest distinguishes traces.
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
    EXPECT_FALSE(column.units.empty() || column.long_name.empty()) << column.name;
    stored.push_back(*found);
  }
  EXPECT_EQ(digest(stored), sum);  // the content of the file is enough to check the digest
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"trace.h5"});
}

// Columns of up to 256 rows are not compressed, those of up to 4096 rows are one compressed chunk, and longer
// ones are several chunks.
TEST(TraceFile, TraceSurvivesBitForBit) {
  for (const int ticks : {0, 1, 33, 4096, 4097, 10000}) expect_round_trip(ticks);
}

TEST(TraceFile, EqualContentIsEqualBytes) {
  const TestFolder folder("trace_file_test");
  const Trace trace = awkward_trace(5000);
  write_trace(folder / "a.h5", trace, kProvenance, {});
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's time stamps count seconds
  write_trace(folder / "b.h5", trace, kProvenance, {});
  EXPECT_EQ(bytes_of(folder / "a.h5"), bytes_of(folder / "b.h5"));
}

TEST(TraceFile, TimingIsStoredOutsideTheDigestAndALongConfigurationIsStored) {
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
  // A configuration with thousands of waypoints is longer than an attribute of old HDF5 files may be.
  const std::string config = "[" + std::string(1 << 20, ' ') + "]";
  write_trace(folder / "long.h5", trace, {{"config", config}}, {});
  EXPECT_EQ(attribute(read_hdf5(folder / "long.h5"), "config"), config);
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

// Figure files hold the tables of a figure, bit for bit, and its panels.
namespace remote_touch::figure_file_test {
namespace {

struct FigureFile : testing::Test {
  const TestFolder folder{"figure_file_test"};
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Figure small_figure() {
  Table table{"heights", "heights of two things", {}};
  table.add("time", "s", "simulated time", {0, 1, 2});
  table.add("y", "m", "height", {0.1, kNan, -0.0});
  table.columns.push_back(
      {"state", "1", "state", std::vector<std::int32_t>{0, 1, 0}, 1, {"free", "contact"}});
  Figure figure{"9.9", "A title", "A caption.", {table, {"other", "of another length", {}}}, {}, {}};
  figure.tables[1].add("x", "m", "place", {4});
  figure.panels = {
      {"Left",
       "time (s)",
       "y (m)",
       true,
       {{"heights", "time", "y", CurveStyle::line, ""}},
       {},
       std::pair(-1.0, 2.0)},
      {"Right", "x", "x", false, {{"other", "x", "x", CurveStyle::circle, "ball", 0.005}}, {}, {}}};
  figure.panels[1].grid_position = std::pair(3.0, 7.0);
  figure.claims = {claim_at_most("9.9", "a claim", "-", 1, 2, "m")};
  return figure;
}

TEST_F(FigureFile, TablesSurvive) {
  const Figure figure = small_figure();
  const std::string sum = write_figure(folder / "fig9.9.h5", figure, kProvenance);
  const Hdf5Content content = read_hdf5(folder / "fig9.9.h5");
  EXPECT_EQ(sum, digest(figure.tables));
  EXPECT_EQ(attribute(content, "digest"), sum);
  EXPECT_EQ(attribute(content, "schema"), "remote-touch-figure/3");
  EXPECT_EQ(attribute(content, "figure"), "9.9");
  EXPECT_EQ(attribute(content, "title"), "A title");
  EXPECT_EQ(attribute(content, "caption"), "A caption.");
  EXPECT_EQ(attribute(content, "command"), "remote-touch run x --set seed=1");
  EXPECT_EQ(content.datasets.size(), 4u);
  for (const Table& table : figure.tables) {
    for (const Column& column : table.columns) {
      const Column* found = find(content, "/tables/" + table.name + "/" + column.name);
      ASSERT_NE(found, nullptr) << column.name;
      EXPECT_TRUE(same_bits(*found, column)) << column.name;
      EXPECT_EQ(found->units, column.units);
      EXPECT_EQ(found->value_names, column.value_names);
    }
  }
  write_figure(folder / "again.h5", figure, kProvenance);
  EXPECT_EQ(bytes_of(folder / "again.h5"), bytes_of(folder / "fig9.9.h5"));
  write_figure(folder / "none.h5", Figure{"9.9", "", "Not run: no recording", {}, {}, {}}, {});
  const Hdf5Content none = read_hdf5(folder / "none.h5");
  EXPECT_TRUE(none.datasets.empty());
  EXPECT_EQ(attribute(none, "title"), "");
  EXPECT_EQ(attribute(none, "caption"), "Not run: no recording");
}

// read_hdf5 does not read panels (h5dump does), so the test only checks that every word of a panel and of its
// scene is in the file.
TEST_F(FigureFile, PanelsAndScenesAreStored) {
  Figure figure = small_figure();
  ScenePart solid{ScenePart::Kind::solid, "corners", 0xE07B39};
  solid.triangles = "faces", solid.poses = "places", solid.pose_row = 5, solid.opacity = 0.375;
  solid.label = "a thing";
  ScenePart dust{ScenePart::Kind::points, "dust", 0, 0.0625};
  dust.coloured_by = "height";
  figure.panels.push_back(figure.panels[0]);
  figure.panels[2].scene = Scene{{1, 2, 3}, {4, 5, 6}, {7, 8, 9},
                                 0.25,      0.625,     {solid, dust, {ScenePart::Kind::segments, "lines"}}};
  write_figure(folder / "fig.h5", figure, {});
  const std::string bytes = bytes_of(folder / "fig.h5");
  EXPECT_HAS(bytes, raw(-1.0) + raw(2.0));  // y_range of the first panel
  EXPECT_HAS(bytes, raw(3.0) + raw(7.0));   // place of the second
  EXPECT_HAS(bytes, raw(0.005));            // radius of the ball
  for (const char* word :
       {"panels",  "Left",     "Right",      "time (s)",    "y (m)",  "equal_aspect", "x_range",
        "y_range", "place",    "curve0",     "heights",     "other",  "line",         "circle",
        "ball",    "radius",   "scene",      "eye",         "target", "part2",        "solid",
        "points",  "segments", "corners",    "faces",       "places", "pose_row",     "dust",
        "lines",   "a thing",  "proportion", "coloured_by", "height"})
    EXPECT_HAS(bytes, word);
  EXPECT_HAS(bytes, raw(1.0) + raw(2.0) + raw(3.0));  // position of the eye
  for (const double value : {0.25, 0.625, 0.375, 0.0625}) EXPECT_HAS(bytes, raw(value));
}

TEST_F(FigureFile, StylesOfCurvesAreStoredByName) {
  Figure figure = small_figure();
  for (const auto& [style, name] :
       {std::pair(CurveStyle::line, "line"), std::pair(CurveStyle::dots, "dots"),
        std::pair(CurveStyle::steps, "steps"), std::pair(CurveStyle::dashed, "dashed"),
        std::pair(CurveStyle::circle, "circle"), std::pair(CurveStyle::bars, "bars"),
        std::pair(CurveStyle::letters, "letters"), std::pair(CurveStyle::intervals, "intervals")}) {
    figure.panels = {{"P", "", "", false, {{"heights", "time", "y", style, ""}}, {}, {}}};
    write_figure(folder / "fig.h5", figure, {});
    EXPECT_HAS(bytes_of(folder / "fig.h5"), name);
  }
}

}  // namespace
}  // namespace remote_touch::figure_file_test

// Verdicts of claims. A known difference from the dissertation is not a failure, unless the measured value
// leaves its known range.
namespace remote_touch::claim_test {
namespace {

Verdict differs(double measured) {
  return claim_differs("1.1", "speed", "16", measured, 28, 30, "m/s").verdict;
}

TEST(Claim, DiffersIfItIsInTheKnownRange) {
  EXPECT_EQ(differs(29), Verdict::differs);
  EXPECT_EQ(differs(28), Verdict::differs);
  EXPECT_EQ(differs(16), Verdict::fail) << "what the paper prints is no longer different: to be looked at";
  EXPECT_EQ(differs(30.1), Verdict::fail);
  EXPECT_EQ(differs(std::nan("")), Verdict::fail);
  EXPECT_EQ(claim_differs("1.1", "speed", "16", 29, 28, 30, "m/s").paper, "16");
}

TEST(Claim, TheCriterionIsInWordsAndASetUpCheckIsMarked) {
  // A check of the set-up is marked, and still judged.
  EXPECT_FALSE(claim_at_most("1.1", "depth", "-", 1, 2, "m").set_up);
  for (const double measured : {1.0, 3.0}) {
    const Claim claim = set_up(claim_at_most("1.1", "depth", "-", measured, 2, "m"));
    EXPECT_TRUE(claim.set_up);
    EXPECT_EQ(claim.verdict, measured < 2 ? Verdict::pass : Verdict::fail);
  }
  EXPECT_EQ(claim_between("1.1", "speed", "16", 29, 28, 30.5, "m/s").criterion, "from 28 to 30.5");
  EXPECT_EQ(claim_at_most("1.1", "depth", "-", 1, 0.001, "m").criterion, "at most 0.001");
  EXPECT_EQ(claim_at_least("1.1", "depth", "-", 1, -2, "m").criterion, "at least -2");
  EXPECT_EQ(claim_differs("1.1", "speed", "16", 29, 28, 30, "m/s").criterion, "expected here: from 28 to 30");
  EXPECT_EQ(claim_at_most("1.1", "depth", "-", 1, 1.0 / 3, "m").criterion, "at most 0.333333");
}

}  // namespace
}  // namespace remote_touch::claim_test

// A changed byte in a finished result is found, wherever it is, before the HDF5 library sees the file.
namespace remote_touch::digest_test {
namespace {

struct FileDigest : testing::Test {
  const TestFolder folder{"file_digest_test"};
};

TEST_F(FileDigest, IsTheSha256OfWhatFollows) {
  write_trace(folder / "trace.h5", awkward_trace(50), kProvenance, {});
  const std::string bytes = bytes_of(folder / "trace.h5");
  EXPECT_NE(bytes.substr(0, kSealBlockSize).find(sha256_of_file(folder / "trace.h5", kSealBlockSize)),
            std::string::npos);
  EXPECT_EQ(bytes.substr(kSealBlockSize, 4), "\x89HDF");
  EXPECT_EQ(seal_state_of(folder / "trace.h5"), SealState::valid);
}

// Every byte of the seal and of the file's beginning is changed, and a sample of the others. Each change must
// be found, and none may lead to a crash.
TEST_F(FileDigest, NoChangedByteIsReadAsATrace) {
  write_trace(folder / "trace.h5", awkward_trace(50), kProvenance, {});
  const std::string bytes = bytes_of(folder / "trace.h5");
  std::size_t tried = 0;
  for (std::size_t i = 0; i < bytes.size(); i += i < 1024 ? 1 : 97) {
    std::string changed = bytes;
    changed[i] = static_cast<char>(changed[i] ^ (1 << (i % 8)));
    const auto file = folder.write("changed.h5", changed);
    EXPECT_HAS(refusal([&] { Hdf5Reader{file}; }), "damaged");
    ++tried;
  }
  EXPECT_GT(tried, 1100u);
}

// The HDF5 library changes addresses like this if a program opens the file for writing, and closes it again.
std::string with_addresses_from_the_start(std::string bytes) {
  for (const std::size_t place : {24u, 40u}) {  // addresses of the base and of the end
    std::uint64_t address = 0;
    std::memcpy(&address, &bytes[kSealBlockSize + place], sizeof address);
    address += kSealBlockSize;
    std::memcpy(&bytes[kSealBlockSize + place], &address, sizeof address);
  }
  return bytes;
}

TEST_F(FileDigest, HoldsWhereAnotherProgramOpenedTheFileAndChangedNothing) {
  write_trace(folder / "trace.h5", awkward_trace(50), kProvenance, {});
  EXPECT_FALSE(was_opened_for_writing(folder / "trace.h5"));
  const std::string opened = with_addresses_from_the_start(bytes_of(folder / "trace.h5"));
  const auto file = folder.write("opened.h5", opened);
  EXPECT_TRUE(was_opened_for_writing(file));
  EXPECT_EQ(seal_state_of(file), SealState::valid);
  EXPECT_TRUE(same_bits(Hdf5Reader(file).column("/trace/force"),
                        Hdf5Reader(folder / "trace.h5").column("/trace/force")));
  for (std::size_t i = 0; i < opened.size(); i += i < 1024 ? 7 : 997) {
    std::string changed = opened;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(was_opened_for_writing(folder.write("changed.h5", changed))) << i;
  }
  folder.write("changed.h5", opened + "x");
  EXPECT_EQ(seal_state_of(folder / "changed.h5"), SealState::broken);
}

TEST_F(FileDigest, OtherHdf5FilesHaveNone) {
  const auto write = [&](const char* schema, const char* name) {
    Hdf5Writer hdf5(Hdf5Writer::Finished::no);
    hdf5.attribute("/", "schema", schema);
    hdf5.save(folder / name);
  };
  write("of-another/1", "other.h5"), write("remote-touch-trace/3", "ours.h5");
  EXPECT_EQ(seal_state_of(folder / "other.h5"), SealState::absent);
  const Hdf5Reader reader(folder / "other.h5");
  EXPECT_HAS(refusal([&] { reader.require_kind("trace", "what I write"); }), "of-another/1");
  EXPECT_HAS(refusal([&] { Hdf5Reader{folder / "ours.h5"}; }), "SHA-256 header is missing");
}

TEST(Sha256, KnownValuesAlsoAfterAnInterruption) {
  const TestFolder folder("file_digest_test");
  EXPECT_EQ(sha256_of_file(folder.write("abc", "abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_file(folder.write("empty", "")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_of_file(folder.write("xyabc", "xyabc"), 2),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_HAS(refusal([&] { sha256_of_file(folder / "missing"); }),
             "missing: cannot be read (No such file or directory): expected a readable file");
  EXPECT_HAS(refusal([&] { sha256_of_file(folder.path()); }), "cannot be read (Is a directory)");
  // The end of a file is not taken for an interrupted call, even if errno is still EINTR from an earlier
  // call.
  const auto file = folder / "abc";
  EXPECT_EQ(in_child({256u << 20, 5}, [&] { return errno = EINTR, sha256_of_file(file); }),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

}  // namespace
}  // namespace remote_touch::digest_test
