// Exports: the frames of a run, what is refused, and the bytes of each format by its specification.
#include "runners/presentation/export_formats.h"

#include <gtest/gtest.h>
#include <stdexcept>
#include <tuple>

#include "analysis/storage/result_file.h"
#include "runners/experiment/settings/provenance.h"
#include "runners/experiment/simulation/simulation.h"
#include "tests/support/scenes.h"
#include "tests/support/test_files.h"

namespace remote_touch::export_formats_test {
namespace {

constexpr const char* kThreePoints = R"({
  "scenario": {"name": "points", "points": [[0, 0, 0], [0.01, 0, 0], [0, 0, 0.5]]},
  "renderer": {"name": "proxy"},
  "trajectory": {"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, -0.01, 0, 0.1]]},
  "duration_s": 0.05, "frame_latency_s": 0.0105})";

class ExportedRunTest : public testing::Test {
 protected:
  std::filesystem::path store(const std::string& command, std::vector<Column> columns) {
    const Experiment experiment = Experiment::from_json(kThreePoints, "a test");
    if (columns.empty()) {
      SimulationOptions options;
      options.hash_frames = true;
      columns = (trace_ = simulate(experiment, options)).columns();
    }
    write_trace(folder_ / "a.h5", columns, provenance(experiment.to_json(), command, ""), {});
    return folder_ / "a.h5";
  }
  std::string export_as(const char* name, const std::filesystem::path& file,
                        const std::atomic<bool>* stop = nullptr) {
    const Hdf5Reader result(file);
    return refusal([&] {
      NewFiles files;
      export_result(export_format(name), {result, folder_ / name, files, {}, &scenes::kernels(), stop});
      files.finish();
    });
  }
  TestFolder folder_{"exported_run"};
  Trace trace_;
};

// The points are those of the configuration, from the first tick after the frame arrives at 10.5 ms.
TEST_F(ExportedRunTest, FramesAreThoseOfTheRun) {
  const Hdf5Reader result(store("remote-touch run a.json", {}));
  NewFiles files;
  const ExportJob job{result, folder_ / "x.vtp", files, {}, &scenes::kernels(), nullptr};
  const ExportedRun run = exported_run(job);
  EXPECT_EQ(run.time_s, trace_.time_s);
  EXPECT_EQ(run.hip_W[7], trace_.hip_position_m[7]);
  EXPECT_EQ(run.tool, nullptr);
  std::vector<ExportedFrame> frames;
  for_each_frame(job, run, [&](const ExportedFrame& frame) { frames.push_back(frame); });
  ASSERT_EQ(frames.size(), 1u);
  EXPECT_EQ(frames[0].first_tick, 11u);
  EXPECT_EQ(frames[0].captured_s, 0);
  EXPECT_EQ(frames[0].arrives_s, 0.0105);
  EXPECT_EQ(frames[0].points.x, (std::vector<double>{0, 0.01, 0}));
  EXPECT_EQ(frames[0].points.z, (std::vector<double>{0, 0, 0.5}));
}

TEST_F(ExportedRunTest, OtherFramesAreRefused) {
  store("remote-touch run a.json", {});
  std::vector<Column> columns = trace_.columns();
  for (Column& column : columns)
    if (column.name == "frame_hash") std::get<std::vector<std::uint64_t>>(column.values)[11] += 1;
  const auto file = store("remote-touch run a.json", columns);
  EXPECT_HAS(export_as("x.mcap", file), "has other frames than this program makes");
  EXPECT_HAS(export_as("x.vtp", file), "has other frames than this program makes");
  EXPECT_EQ(export_as("x.csv", file), "no InputError");
  EXPECT_EQ(files_in(folder_.path()), (std::vector<std::string>{"a.h5", "x.csv", "x_columns.csv"}));
}

// A run without a tool has no torque.
TEST_F(ExportedRunTest, OddColumnsAreRefused) {
  store("remote-touch run a.json", {});
  using Change = void (*)(std::vector<Column>&, std::size_t);
  const Change without = [](auto& columns, std::size_t i) {
    columns.erase(columns.begin() + static_cast<long>(i));
  };
  const std::tuple<const char*, Change, const char*> cases[] = {
      {"time", [](auto& columns, std::size_t i) { std::get<std::vector<double>>(columns[i].values)[3] = -1; },
       "/trace/time has a time that is not a number, negative, or 2e9 s or more"},
      {"frame_index",
       [](auto& columns, std::size_t i) { std::get<std::vector<std::int32_t>>(columns[i].values)[3] = 9; },
       "/trace/frame_index goes back"},
      {"force", [](auto& columns, std::size_t i) { columns[i].width = 1; },
       "/trace/force has values of another type or width"},
      {"hip_position",
       [](auto& columns, std::size_t i) { std::get<std::vector<double>>(columns[i].values).resize(3); },
       "hip_position is not as long as /trace/time"},
      {"hip_position", without, "damaged (it has no /trace/hip_position)"},
      {"proxy_position", without, "damaged (it has no /trace/proxy_position)"},
      {"force", without, "damaged (it has no /trace/force)"}};
  for (const auto& [name, change, why] : cases) {
    std::vector<Column> columns = trace_.columns();
    std::size_t place = 0;
    while (columns.at(place).name != name) ++place;
    change(columns, place);
    EXPECT_HAS(export_as("x.mcap", store("remote-touch run a.json", columns)), why);
  }
  EXPECT_HAS(export_as("x.vtp", store("remote-touch live a.json", {})), "is of a live run");
  EXPECT_EQ(files_in(folder_.path()), std::vector<std::string>{"a.h5"});
}

TEST_F(ExportedRunTest, AnInterruptedExportLeavesNothing) {
  const auto file = store("remote-touch run a.json", {});
  const std::atomic<bool> stop = true;
  for (const char* name : {"x.csv", "x.npz", "x.vtp", "x.mcap"})
    EXPECT_THROW(export_as(name, file, &stop), Interrupted) << name;
  EXPECT_EQ(files_in(folder_.path()), std::vector<std::string>{"a.h5"});
}

// CRC-32 bit by bit, by its definition.
std::uint32_t crc(const std::string& bytes) {
  std::uint32_t sum = ~0u;
  for (const char c : bytes) {
    sum ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum & 1 ? 0xedb88320u : 0);
  }
  return ~sum;
}

std::string u16(int value) {
  return raw(static_cast<std::uint16_t>(value));
}
std::string u32(std::size_t value) {
  return raw(static_cast<std::uint32_t>(value));
}
std::string u64(std::uint64_t value) {
  return raw(value);
}
std::string text(const std::string& value) {
  return u32(value.size()) + value;
}
std::string record(int kind, const std::string& content) {
  return std::string(1, static_cast<char>(kind)) + u64(content.size()) + content;
}

// Follows https://mcap.dev/spec, record by record.
TEST(McapWriter, HasTheRecordsOfTheSpecification) {
  std::string file;
  McapWriter mcap([&](const std::string& bytes) { file += bytes; });
  const std::uint16_t channel = mcap.add_topic("/a", {"schema", "definition"});
  mcap.add_metadata("about", {{"key", "value"}});
  mcap.message(channel, 7, 5, "one");
  mcap.message(channel, 9, 9, "two");
  mcap.finish();

  const std::string magic("\x89MCAP0\r\n", 8);
  const std::string schema = record(3, u16(1) + text("schema") + text("ros2msg") + text("definition"));
  const std::string topic = record(4, u16(0) + u16(1) + text("/a") + text("cdr") + u32(0));
  const std::string first = record(5, u16(0) + u32(0) + u64(7) + u64(5) + "one");
  const std::string second = record(5, u16(0) + u32(1) + u64(9) + u64(9) + "two");
  const std::string records = schema + topic + first + second;
  const std::string metadata = record(12, text("about") + text(text("key") + text("value")));
  std::string data = magic + record(1, text("ros2") + text("remote-touch export"));
  const std::size_t metadata_at = data.size();
  data += metadata;
  const std::size_t chunk_at = data.size();
  const std::string chunk = record(6, u64(7) + u64(9) + u64(records.size()) + u32(crc(records)) + text("") +
                                          u64(records.size()) + records);
  data += chunk;
  const std::size_t index_at = data.size(), first_at = schema.size() + topic.size();
  const std::string index =
      record(7, u16(0) + text(u64(7) + u64(first_at) + u64(9) + u64(first_at + first.size())));
  data += index;
  data += record(15, u32(crc(data)));

  const std::string statistics = record(
      11, u64(2) + u16(1) + u32(1) + u32(0) + u32(1) + u32(1) + u64(7) + u64(9) + text(u16(0) + u64(2)));
  const std::string chunk_index =
      record(8, u64(7) + u64(9) + u64(chunk_at) + u64(chunk.size()) + text(u16(0) + u64(index_at)) +
                    u64(index.size()) + text("") + u64(records.size()) + u64(records.size()));
  const std::string metadata_index = record(13, u64(metadata_at) + u64(metadata.size()) + text("about"));
  std::string summary, offsets;
  for (const auto& [kind, part] :
       {std::pair{3, schema}, {4, topic}, {11, statistics}, {8, chunk_index}, {13, metadata_index}}) {
    offsets += record(
        14, std::string(1, static_cast<char>(kind)) + u64(data.size() + summary.size()) + u64(part.size()));
    summary += part;
  }
  std::string footer = record(2, u64(data.size()) + u64(data.size() + summary.size()) + u32(0));
  footer.resize(footer.size() - 4);
  const std::string checked = summary + offsets + footer;
  EXPECT_EQ(file, data + checked + u32(crc(checked)) + magic);
  EXPECT_TRUE(file.starts_with(McapWriter::opening()));
}

// A message larger than a chunk, and many small ones: each chunk can be found by its index.
TEST(McapWriter, LongFilesHaveSeveralChunks) {
  std::string file;
  McapWriter mcap([&](const std::string& bytes) { file += bytes; });
  const std::uint16_t channel = mcap.add_topic("/a", {"s", ""});
  EXPECT_EQ(mcap.add_topic("/b", {"s", ""}), channel + 1);
  mcap.message(channel, 0, 0, std::string(3 << 20, 'x'));
  for (std::uint64_t i = 1; i <= 5000; ++i) mcap.message(channel, i, i, std::string(1000, 'y'));
  mcap.finish();
  std::size_t chunks = 0, schemas = 0, at = 8;
  for (std::uint64_t length = 0; at + 9 < file.size() - 8; at += 9 + length) {
    std::memcpy(&length, file.data() + at + 1, sizeof length);
    chunks += file[at] == 6, schemas += file[at] == 3;
  }
  EXPECT_EQ(at, file.size() - 8);
  EXPECT_EQ(chunks, 6u);   // 3 MiB, then 5 MB in pieces of a MiB
  EXPECT_EQ(schemas, 1u);  // outside of chunks: in the summary
}

// Header of a message at 3.5 s: encoding; seconds, nanoseconds, length of the text with its zero, the text,
// and two bytes up to a multiple of four or eight. The sizes are 4 + 4 + 4 + 6 = 18, and 20 or 24.
std::string header(int padding) {
  return std::string("\0\1\0\0", 4) + raw(3) + raw(500'000'000) + raw(6) + std::string("world\0", 6) +
         std::string(static_cast<std::size_t>(padding), '\0');
}

TEST(RosMessages, EncodeAPose) {
  EXPECT_EQ(pose_message(3'500'000'000, {1, 2, 3}, Eigen::Quaterniond(0.5, 0.1, 0.2, 0.3)),
            header(6) + raw(1.0) + raw(2.0) + raw(3.0) + raw(0.1) + raw(0.2) + raw(0.3) + raw(0.5));
}

TEST(RosMessages, Wrench) {
  EXPECT_EQ(wrench_message(3'500'000'000, {1, 2, 3}, {4, 5, 6}),
            header(6) + raw(1.0) + raw(2.0) + raw(3.0) + raw(4.0) + raw(5.0) + raw(6.0));
}

TEST(RosMessages, PointCloud) {
  const std::string data = raw(1.0f) + raw(2.0f) + raw(3.0f) + raw(4.0f);
  const std::string zero3(3, '\0'), zero2(2, '\0');
  EXPECT_EQ(point_cloud_message(3'500'000'000, {"x", "rgb"}, data),
            header(2) + raw(1) + raw(2) + raw(2) +                                           // 1 x 2, fields
                raw(2) + std::string("x\0", 2) + zero2 + raw(0) + "\x07" + zero3 + raw(1) +  // x
                raw(4) + std::string("rgb\0", 4) + raw(4) + "\x07" + zero3 + raw(1) +        // rgb
                std::string("\0", 1) + zero3 + raw(8) + raw(16) + raw(16) + data + "\x01");
}

// The header has 10 bytes, the text padded to 128 bytes with its line feed, and the values.
std::string npy(const std::string& text, const std::string& values) {
  std::string file("\x93NUMPY\x01\x00\x76\x00", 10);
  file += text;
  file.resize(127, ' ');
  return file + "\n" + values;
}

TEST(NpyArray, WritesNumbersVectorsCountsAndHashes) {
  const Column column{"a", "m", "", std::vector<double>{1.5, -2}, 1, {}};
  EXPECT_EQ(npy_array(column), npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }",
                                   std::string("\0\0\0\0\0\0\xf8\x3f\0\0\0\0\0\0\0\xc0", 16)));
  const Column counts{"a", "1", "", std::vector<std::int32_t>{1, 2, 3, -1, 5, 6}, 3, {}};
  EXPECT_EQ(npy_array(counts),
            npy("{'descr': '<i4', 'fortran_order': False, 'shape': (2, 3), }",
                raw(1) + raw(2) + raw(3) + std::string("\xff\xff\xff\xff", 4) + raw(5) + raw(6)));
  const Column hashes{"a", "1", "", std::vector<std::uint64_t>{0x0123456789abcdef}, 1, {}};
  EXPECT_EQ(npy_array(hashes), npy("{'descr': '<u8', 'fortran_order': False, 'shape': (1,), }",
                                   "\xef\xcd\xab\x89\x67\x45\x23\x01"));
  const Column none{"a", "m", "", std::vector<double>{}, 3, {}};
  EXPECT_EQ(npy_array(none), npy("{'descr': '<f8', 'fortran_order': False, 'shape': (0, 3), }", ""));
}

// Characters have four bytes; U+00E9, U+20AC and U+1F600 have two, three and four in UTF-8.
TEST(NpyArray, WritesTexts) {
  const Column column{"a", "1", "", std::vector<std::string>{"\u00e9\u20ac\U0001f600", "x", ""}, 1, {}};
  const auto c = [](std::uint32_t character) { return raw(character); };
  EXPECT_EQ(npy_array(column),
            npy("{'descr': '<U3', 'fortran_order': False, 'shape': (3,), }",
                c(0xe9) + c(0x20ac) + c(0x1f600) + c('x') + c(0) + c(0) + c(0) + c(0) + c(0)));
  EXPECT_EQ(npy_text("ok"), npy("{'descr': '<U2', 'fortran_order': False, 'shape': (), }", c('o') + c('k')));
  EXPECT_EQ(npy_text("a\xff\xc3"),
            npy("{'descr': '<U3', 'fortran_order': False, 'shape': (), }", c('a') + c(0xfffd) + c(0xfffd)));
}

// Forms that are too long, halves of pairs of UTF-16, and numbers above U+10FFFF, which NumPy refuses.
TEST(NpyArray, ACharacterThatIsNoneBecomesAQuestion) {
  const std::string question = raw(std::uint32_t{0xfffd});
  const auto values = [](const std::string& text) { return npy_text(text).substr(128); };
  for (const char* wrong : {"\xe0\x80\x80", "\xed\xa0\x80", "\xed\xbf\xbf"})
    EXPECT_EQ(values(wrong), question + question + question) << wrong;
  for (const char* wrong : {"\xf0\x80\x80\x80", "\xf4\x90\x80\x80"})
    EXPECT_EQ(values(wrong), question + question + question + question) << wrong;
  for (const auto& [right, number] : {std::pair("\xe0\xa0\x80", 0x800u),
                                      {"\xed\x9f\xbf", 0xd7ffu},
                                      {"\xee\x80\x80", 0xe000u},
                                      {"\xf0\x90\x80\x80", 0x10000u},
                                      {"\xf4\x8f\xbf\xbf", 0x10ffffu}})
    EXPECT_EQ(values(right), raw(std::uint32_t{number})) << right;
}

// The bytes follow the specification (APPNOTE 4.3). The CRC-32 of "123456789" is the check value of its
// catalogue.
TEST(ZipArchive, HasTheBytesOfTheSpecification) {
  std::string archive;
  ZipArchive zip([&](const std::string& bytes) { archive += bytes; });
  zip.add("a", "123456789");
  zip.add("bc", "");
  zip.finish();
  const auto member = [&](std::uint32_t crc, std::uint32_t size, int name_length) {
    return u16(20) + u16(0) + u16(0) + u16(0) + u16(0x21) + raw(crc) + raw(size) + raw(size) +
           u16(name_length) + u16(0);
  };
  const std::string local = std::string("PK\3\4") + member(0xcbf43926, 9, 1) + "a" + "123456789" + "PK\3\4" +
                            member(0, 0, 2) + "bc";
  const std::string no_more = u16(0) + u16(0) + u16(0) + raw(std::uint32_t{0});
  const std::string central = std::string("PK\1\2") + u16(20) + member(0xcbf43926, 9, 1) + no_more +
                              raw(std::uint32_t{0}) + "a" + "PK\1\2" + u16(20) + member(0, 0, 2) + no_more +
                              raw(std::uint32_t{40}) + "bc";
  const std::string end = std::string("PK\5\6") + u16(0) + u16(0) + u16(2) + u16(2) +
                          raw(static_cast<std::uint32_t>(central.size())) +
                          raw(static_cast<std::uint32_t>(local.size())) + u16(0);
  EXPECT_EQ(archive, local + central + end);
  EXPECT_TRUE(archive.starts_with(ZipArchive::opening("a", "123456789")));
}

TEST(ZipArchive, HasNoMoreMembersThanTheFormatCounts) {
  ZipArchive zip([](const std::string&) {});
  for (int i = 0; i < 65534; ++i) zip.add("a", "");
  EXPECT_THROW(zip.add("a", ""), std::length_error);
}

std::string array(const char* type, const char* name, int components, int offset) {
  return std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(offset) + "\"/>\n";
}

TEST(VtkPolyData, IsTheFileOfTheFormat) {
  VtkPolyData data;
  data.time_s = 0.25;
  data.points = {{1, 2, 3}, {4, 5, 6}};
  data.has_vertices = true;
  data.lines = {{0, 1}};
  data.of_points = {{"a<b", "UInt8", 1, std::string("\x07\x08", 2)}};
  data.of_cells = {};
  const std::string expected =
      "<?xml version=\"1.0\"?>\n<!-- remote-touch export -->\n"
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
      "<PolyData>\n<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">0.25</DataArray>\n</FieldData>\n"
      "<Piece NumberOfPoints=\"2\" NumberOfVerts=\"2\" NumberOfLines=\"1\" NumberOfStrips=\"0\" "
      "NumberOfPolys=\"0\">\n<Points>\n" +
      array("Float64", "Points", 3, 0) + "</Points>\n<Verts>\n" + array("Int64", "connectivity", 1, 56) +
      array("Int64", "offsets", 1, 80) + "</Verts>\n<Lines>\n" + array("Int64", "connectivity", 1, 104) +
      array("Int64", "offsets", 1, 128) + "</Lines>\n<Polys>\n" + array("Int64", "connectivity", 1, 144) +
      array("Int64", "offsets", 1, 152) + "</Polys>\n<PointData>\n" + array("UInt8", "a&lt;b", 1, 160) +
      "</PointData>\n<CellData>\n</CellData>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_" +
      u64(48) + raw(1.0) + raw(2.0) + raw(3.0) + raw(4.0) + raw(5.0) + raw(6.0) +  // points
      u64(16) + u64(0) + u64(1) + u64(16) + u64(1) + u64(2) +                      // vertices
      u64(16) + u64(0) + u64(1) + u64(8) + u64(2) +                                // lines
      u64(0) + u64(0) +                                                            // faces
      u64(2) + "\x07\x08" + "\n</AppendedData>\n</VTKFile>\n";
  EXPECT_EQ(vtp_file(data), expected);
}

}  // namespace
}  // namespace remote_touch::export_formats_test
