#include "analysis/result_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <csignal>
#include <limits>
#include <thread>

#include "analysis/digest.h"
#include "analysis/whole_file.h"
#include "tests/test_files.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

const TextAttributes kProvenance = {{"config", R"({"title": "gr\u00fcn", "seed": 1})"},
                                    {"command", "remote-touch run x --set seed=1"},
                                    {"isa", "x86-64"},
                                    {"empty", ""},
                                    {"umlaut", "grün"}};

// Numbers that a careless writer would change.
constexpr double kAwkward[] = {
    0.0,       -0.0,       0.1,  1.0 / 3,           -1e308, 5e-324, 2.2250738585072014e-308,
    kInfinity, -kInfinity, kNan, 1.0000000000000002};

Trace awkward_trace(int ticks) {
  Trace trace;
  std::size_t next = 0;
  const auto number = [&] { return kAwkward[next++ % std::size(kAwkward)]; };
  const auto vector = [&] { return Vec3(number(), number(), number()); };
  for (int i = 0; i < ticks; ++i) {
    RenderOutput out;
    out.proxy_W = vector(), out.force_N = vector(), out.normal_W = vector();
    out.state = static_cast<ContactState>(i % 3), out.status = static_cast<RenderStatus>(i % 5);
    out.steps = i, out.converged = i % 2 == 0;
    out.contact_count = std::numeric_limits<int>::max() - i, out.frame_index = i / 33 - 1;
    out.surface_velocity_m_per_s = number(), out.nearest_m = number();
    trace.append(0.001 * i, {vector()}, out, number());
  }
  return trace;
}

bool same_bits(const Column& a, const Column& b) {
  if (a.values.index() != b.values.index() || a.width != b.width) return false;
  if (const auto* x = std::get_if<std::vector<double>>(&a.values)) {
    const auto& y = std::get<std::vector<double>>(b.values);
    return std::equal(x->begin(), x->end(), y.begin(), y.end(), [](double p, double q) {
      return std::bit_cast<std::uint64_t>(p) == std::bit_cast<std::uint64_t>(q);
    });
  }
  return a.values == b.values;
}

const Column* find(const Hdf5Content& content, const std::string& path) {
  for (const auto& [name, column] : content.datasets)
    if (name == path) return &column;
  return nullptr;
}

std::string attribute(const Hdf5Content& content, const std::string& wanted) {
  for (const auto& [name, value] : content.attributes)
    if (name == wanted) return value;
  return "no attribute " + wanted;
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

// --- traces ---

void expect_round_trip(int ticks) {
  SCOPED_TRACE(std::to_string(ticks) + " ticks");
  const TestFolder folder("result_file_test");
  const Trace trace = awkward_trace(ticks);
  const std::string sum = write_trace(folder / "trace.h5", trace, kProvenance, {});
  const Hdf5Content content = read_hdf5(folder / "trace.h5");

  EXPECT_EQ(sum, digest(trace.columns()));
  EXPECT_EQ(attribute(content, "digest"), sum);
  EXPECT_EQ(attribute(content, "schema"), "remote-touch-trace/1");
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
  EXPECT_EQ(digest(stored), sum);  // anybody can check the digest with what is in the file
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"trace.h5"});
}

// Up to 4096 rows lie in one piece, more in compressed chunks.
TEST(ResultFile, TraceSurvivesBitForBit) {
  for (const int ticks : {1, 33, 4096, 4097, 10000}) expect_round_trip(ticks);
}

TEST(ResultFile, EmptyTrace) {
  expect_round_trip(0);
}

TEST(ResultFile, EveryColumnHasUnitsAndAName) {
  for (const Column& column : awkward_trace(1).columns()) {
    EXPECT_FALSE(column.units.empty()) << column.name;
    EXPECT_FALSE(column.long_name.empty()) << column.name;
  }
}

TEST(ResultFile, EqualContentIsEqualBytes) {
  const TestFolder folder("result_file_test");
  const Trace trace = awkward_trace(5000);
  write_trace(folder / "a.h5", trace, kProvenance, {});
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // HDF5's time stamps count seconds
  write_trace(folder / "b.h5", trace, kProvenance, {});
  EXPECT_EQ(bytes_of(folder / "a.h5"), bytes_of(folder / "b.h5"));
}

TEST(ResultFile, TimingIsStoredOutsideTheDigest) {
  const TestFolder folder("result_file_test");
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
TEST(ResultFile, LongConfiguration) {
  const TestFolder folder("result_file_test");
  const std::string config = "[" + std::string(1 << 20, ' ') + "]";
  write_trace(folder / "long.h5", awkward_trace(2), {{"config", config}, {"isa", "x86-64"}}, {});
  const Hdf5Content content = read_hdf5(folder / "long.h5");
  EXPECT_EQ(attribute(content, "config"), config);
  EXPECT_EQ(attribute(content, "isa"), "x86-64");
}

// --- digest ---

TEST(Digest, KnownValue) {
  // SHA-256 of the ten bytes "x", 0, int 1, int 7, as any other program computes it.
  const std::vector<Column> columns = {{"x", "1", "", std::vector<std::int32_t>{7}, 1, {}}};
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

TEST(Digest, ToldApart) {
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

// --- figures ---

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
  figure.panels[1].place = std::pair(3.0, 7.0);
  figure.claims = {claim_at_most("9.9", "a claim", "-", 1, 2, "m")};
  return figure;
}

TEST(FigureFile, TablesSurvive) {
  const TestFolder folder("result_file_test");
  const Figure figure = small_figure();
  const std::string sum = write_figure(folder / "fig9.9.h5", figure, kProvenance);
  const Hdf5Content content = read_hdf5(folder / "fig9.9.h5");
  EXPECT_EQ(sum, digest(figure.tables));
  EXPECT_EQ(attribute(content, "digest"), sum);
  EXPECT_EQ(attribute(content, "schema"), "remote-touch-figure/1");
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
}

// What read_hdf5 does not read, h5dump does; here it is enough that every word of a panel is in the file.
TEST(FigureFile, PanelsAreStored) {
  const TestFolder folder("result_file_test");
  write_figure(folder / "fig.h5", small_figure(), {});
  const std::string bytes = bytes_of(folder / "fig.h5");
  for (const char* word :
       {"panels", "Left", "Right", "time (s)", "y (m)", "equal_aspect", "x_range", "y_range", "place",
        "curve0", "heights", "other", "line", "circle", "ball", "radius"})
    EXPECT_HAS(bytes, word);
  EXPECT_HAS(bytes, raw(-1.0) + raw(2.0));  // y_range of the first panel
  EXPECT_HAS(bytes, raw(3.0) + raw(7.0));   // place of the second
  EXPECT_HAS(bytes, raw(0.005));            // radius of the ball
}

TEST(FigureFile, EveryStyleHasItsName) {
  const TestFolder folder("result_file_test");
  Figure figure = small_figure();
  for (const auto& [style, name] :
       {std::pair(CurveStyle::line, "line"), std::pair(CurveStyle::dots, "dots"),
        std::pair(CurveStyle::steps, "steps"), std::pair(CurveStyle::dashed, "dashed"),
        std::pair(CurveStyle::circle, "circle"), std::pair(CurveStyle::bars, "bars")}) {
    figure.panels = {{"P", "", "", false, {{"heights", "time", "y", style, ""}}, {}, {}}};
    write_figure(folder / "fig.h5", figure, {});
    EXPECT_HAS(bytes_of(folder / "fig.h5"), name);
  }
}

TEST(FigureFile, WithoutTablesOrPanels) {
  const TestFolder folder("result_file_test");
  write_figure(folder / "fig.h5", Figure{"9.9", "", "Not run: no recording", {}, {}, {}}, {});
  const Hdf5Content content = read_hdf5(folder / "fig.h5");
  EXPECT_TRUE(content.datasets.empty());
  EXPECT_EQ(attribute(content, "title"), "");
  EXPECT_EQ(attribute(content, "caption"), "Not run: no recording");
}

TEST(FigureFile, EqualContentIsEqualBytes) {
  const TestFolder folder("result_file_test");
  write_figure(folder / "a.h5", small_figure(), kProvenance);
  write_figure(folder / "b.h5", small_figure(), kProvenance);
  EXPECT_EQ(bytes_of(folder / "a.h5"), bytes_of(folder / "b.h5"));
}

// --- files that cannot be read ---

void expect_unreadable(const fs::path& file) {
  const std::string message = refusal([&] { read_hdf5(file); });
  EXPECT_HAS(message, file.string() + ": ");
  EXPECT_HAS(message, "allowed");
}

TEST(ReadHdf5, MissingOrAnotherKindOfFile) {
  const TestFolder folder("result_file_test");
  expect_unreadable(folder / "missing.h5");
  expect_unreadable(folder.path());
  expect_unreadable(folder.write("empty.h5", ""));
  expect_unreadable(folder.write("text.h5", "{\"seed\": 1}\n"));
  expect_unreadable(folder.write("signature.h5", "\x89HDF\r\n\x1a\n"));
  expect_unreadable(folder.write("a file", "") / "inside.h5");
  expect_unreadable(folder / std::string(300, 'a'));
  fs::create_symlink(folder / "loop", folder / "loop");
  expect_unreadable(folder / "loop");
}

TEST(ReadHdf5, TruncatedAnywhere) {
  const TestFolder folder("result_file_test");
  write_trace(folder / "whole.h5", awkward_trace(50), kProvenance, {});
  const std::string bytes = bytes_of(folder / "whole.h5");
  for (std::size_t i = 0; i < 200; ++i)
    expect_unreadable(folder.write("cut.h5", bytes.substr(0, i * bytes.size() / 200)));
  EXPECT_NO_THROW(read_hdf5(folder.write("cut.h5", bytes)));
}

// Long columns carry a checksum.
TEST(ReadHdf5, DamagedChunk) {
  const TestFolder folder("result_file_test");
  write_trace(folder / "whole.h5", awkward_trace(20000), kProvenance, {});
  std::string bytes = bytes_of(folder / "whole.h5");
  const std::string deflate_header = "\x78\x01";  // zlib at level 1, the first bytes of a chunk
  const std::size_t chunk = bytes.find(deflate_header);
  ASSERT_NE(chunk, std::string::npos);
  bytes[chunk + 20] = static_cast<char>(~bytes[chunk + 20]);
  expect_unreadable(folder.write("damaged.h5", bytes));
}

// --- places that cannot be written ---

void expect_unwritable(const fs::path& file) {
  const std::string message = refusal([&] { write_trace(file, awkward_trace(2000), kProvenance, {}); });
  EXPECT_HAS(message, file.string() + ": cannot be written (");
  EXPECT_HAS(message, "; allowed a writable place");
}

TEST(WriteTrace, PlacesThatCannotBeWritten) {
  const TestFolder folder("result_file_test");
  folder.write("file", "as it was");
  fs::create_directory(folder / "folder");
  fs::create_symlink(folder / "loop", folder / "loop");
  for (const char* name : {"missing/x.h5", "file/x.h5", "folder", "folder/", "loop/x.h5"})
    expect_unwritable(folder / name);
  expect_unwritable(folder / std::string(300, 'a'));
  expect_unwritable("");
  EXPECT_EQ(files_in(folder.path()), (std::vector<std::string>{"file", "folder", "loop"}));
  EXPECT_TRUE(files_in(folder / "folder").empty());
  EXPECT_EQ(bytes_of(folder / "file"), "as it was");
  if (fs::exists("/dev/full")) expect_unwritable("/dev/full");
}

TEST(WriteTrace, FolderWithoutPermission) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  const TestFolder folder("result_file_test");
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  expect_unwritable(folder / "locked/x.h5");
  EXPECT_TRUE(files_in(folder / "locked").empty());
}

// A limit on the length of files stands for a full disk: the write begins and then fails.
TEST(WriteTrace, FailureInTheMiddleLeavesTheOldFile) {
  const TestFolder folder("result_file_test");
  folder.write("x.h5", "as it was");
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const rlimit tight{8192, old.rlim_max};
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &tight), 0);
  expect_unwritable(folder / "x.h5");
  expect_unwritable(folder / "y.h5");
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"x.h5"});
  EXPECT_EQ(bytes_of(folder / "x.h5"), "as it was");
}

TEST(WriteWholeFile, ReplacesAndKeepsNothingElse) {
  const TestFolder folder("result_file_test");
  const std::string text = "new", empty;
  folder.write("file", "old and longer");
  write_whole_file(folder / "file", text.data(), text.size());
  EXPECT_EQ(bytes_of(folder / "file"), "new");
  write_whole_file(folder / "file", empty.data(), 0);
  EXPECT_EQ(bytes_of(folder / "file"), "");
  EXPECT_EQ(files_in(folder.path()), std::vector<std::string>{"file"});
}

TEST(WriteWholeFile, DevicesAreWrittenThrough) {
  if (!fs::exists("/dev/null")) GTEST_SKIP() << "no /dev/null";
  const std::string text = "anything";
  EXPECT_NO_THROW(write_whole_file("/dev/null", text.data(), text.size()));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

}  // namespace
}  // namespace remote_touch
