// Bags of ROS 2 in MCAP files.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "scenarios/recordings/bags/bag_chunk.h"
#include "scenarios/recordings/bags/bag_file.h"

namespace remote_touch {

// The records of an MCAP file: an opcode, a length of 64 bits, a body.

struct McapRecord {
  enum Opcode : unsigned char {
    header = 1,
    footer = 2,
    schema = 3,
    channel = 4,
    message = 5,
    chunk = 6,
    message_index = 7,
    chunk_index = 8,
    statistics = 11,
    data_end = 15
  };
  static constexpr std::uint64_t kStart = 9;           // opcode and length
  static constexpr std::uint64_t kMessageHeader = 22;  // channel, number and two times, before the message

  unsigned char opcode = 0;
  std::uint64_t body_at = 0, body_size = 0;  // position and size in the file, or in the records of a chunk
  std::uint64_t end() const { return body_at + body_size; }
};

inline constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};

// Decodes opcode and length of the record that begins at `at`. start: the first kStart bytes of the record.
McapRecord mcap_record(std::string_view start, std::uint64_t at);
// Reads the same from a file. Throws InputError if the file ends before the record does.
McapRecord mcap_record_at(const ByteFile& file, std::uint64_t at);

// Reads the chunk record that begins at `at`. Throws InputError if there is none.
ChunkPlace mcap_chunk_at(const ByteFile& file, std::uint64_t at);

struct McapMessageHeader {
  std::uint16_t channel = 0;
  std::int64_t logged_ns = 0;
};
McapMessageHeader mcap_message_header(std::string_view body, const std::string& subject);

// Finds messages by the index at the file's end. If there is no complete index, the constructor reads the
// whole file, which takes as long as decompressing it. The CRC of a chunk is checked when a message of it is
// read as a whole. The CRC of the index is checked when the index is used.
class McapFile final : public BagFile {
 public:
  McapFile(const std::filesystem::path& file, const WantedTopic& wanted);
  std::string start(const MessagePlace& place, std::uint64_t max_bytes) const override;

 private:
  struct Summary {
    std::uint64_t begin = 0, end = 0;
  };
  std::optional<Summary> find_summary();
  // Lists the messages from the index. Returns false if the index is missing, damaged or incomplete.
  bool index_by_summary();
  bool index_chunk(const McapRecord& chunk_index);
  bool matches_statistics(const std::string& statistics);
  // Lists the messages by reading all records.
  void scan();
  void scan_chunk(const McapRecord& chunk);
  void forget();

  void add_schema(std::string_view body);
  void add_channel(std::string_view body);
  void list_message(std::string_view start, std::uint64_t part, std::uint64_t at);
  std::string message_in_chunk(const MessagePlace& place, std::uint64_t max_bytes) const;
  std::string body_start(const McapRecord& record, std::uint64_t max_bytes) const;
  std::string whole_body(const McapRecord& record) const;

  const ByteFile file_;
  std::map<std::uint16_t, std::string> schemas_;   // their names
  bool lacks_schema_ = false;                      // a channel has a schema that was not listed before it
  bool schemas_are_in_data_ = false;               // the index is complete, but has no schemas
  std::map<std::uint16_t, std::size_t> channels_;  // their topics
  mutable std::mutex mutex_;                       // guards the members below
  mutable std::unique_ptr<BagChunk> chunk_;        // chunk that was read last
  mutable std::set<std::uint64_t> checked_;        // positions of the chunks whose CRC was checked
};

}  // namespace remote_touch
