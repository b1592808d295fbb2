#include "scenarios/recordings/bags/mcap_records.h"

#include <algorithm>
#include <cstring>

#include "scenarios/recordings/bags/message_cursor.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {

McapRecord mcap_record(std::string_view start, std::uint64_t at) {
  McapRecord record;
  record.opcode = static_cast<unsigned char>(start[0]);
  std::memcpy(&record.body_size, start.data() + 1, sizeof record.body_size);
  record.body_at = at + McapRecord::kStart;
  return record;
}

McapRecord mcap_record_at(const ByteFile& file, std::uint64_t at) {
  const McapRecord record = mcap_record(file.bytes(at, McapRecord::kStart), at);
  if (!file.has(record.body_at, record.body_size))
    refuse(file.name(), "the record at byte ", at, " claims ", record.body_size, " bytes: the file has ",
           file.size() - record.body_at, " left");
  return record;
}

ChunkPlace mcap_chunk_at(const ByteFile& file, std::uint64_t at) {
  constexpr std::uint64_t kMaxHeader = 8 + 8 + 8 + 4 + 4 + 32 + 8;  // the name of a compression is short
  const McapRecord record = mcap_record_at(file, at);
  const std::string name = file.name() + ", the record at byte " + std::to_string(at);
  if (record.opcode != McapRecord::chunk) refuse(name, "is not a chunk");
  const std::string start = file.bytes(record.body_at, std::min(record.body_size, kMaxHeader));
  MessageCursor cursor(start, WireFormat::ros1, name);
  ChunkPlace chunk;
  chunk.record_at = at;
  cursor.u64(), cursor.u64();  // the times of its messages
  chunk.size = cursor.u64(), chunk.crc = cursor.u32();
  chunk.compression = cursor.text();
  chunk.stored_size = cursor.u64();
  const std::uint64_t header = start.size() - cursor.left();
  chunk.stored_at = record.body_at + header;
  if (chunk.stored_size > record.body_size - header)
    refuse(name, "claims a chunk of ", chunk.stored_size, " bytes: it has ", record.body_size - header);
  return chunk;
}

McapMessageHeader mcap_message_header(std::string_view body, const std::string& subject) {
  MessageCursor cursor(body, WireFormat::ros1, subject);
  McapMessageHeader header;
  header.channel = cursor.u16();
  cursor.u32();  // the number of the message
  header.logged_ns = static_cast<std::int64_t>(cursor.u64());
  cursor.u64();  // when it was sent
  return header;
}

}  // namespace remote_touch
