#include "runners/presentation/export_formats.h"

#include <gtest/gtest.h>

#include "tests/support/test_files.h"

namespace remote_touch::mcap_file_test {
namespace {

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

}  // namespace
}  // namespace remote_touch::mcap_file_test
