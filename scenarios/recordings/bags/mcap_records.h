// The records of an MCAP file: an opcode, a length of 64 bits, a body.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "scenarios/recordings/bags/bag_chunk.h"
#include "scenarios/recordings/bags/byte_file.h"

namespace remote_touch {

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

}  // namespace remote_touch
