#include "scenarios/recordings/bags/mcap_file.h"

#include <algorithm>
#include <cstring>

#include "core/parameters/input_error.h"
#include "scenarios/recordings/bags/messages.h"
#include "scenarios/text_files/text_file.h"

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

namespace {

// MessagePlace::part is the position of the message's chunk, or kNoChunk for a message outside of chunks. No
// chunk is at position 0, because the magic number is there.
constexpr std::uint64_t kNoChunk = 0;

}  // namespace

McapFile::McapFile(const std::filesystem::path& file, const WantedTopic& wanted)
    : BagFile(file.string(), wanted), file_(file) {
  const bool long_enough = file_.has(0, kMcapMagic.size());
  if (!long_enough || file_.bytes(0, kMcapMagic.size()) != kMcapMagic)
    refuse(name_, "does not begin as an MCAP file");
  if (!index_by_summary()) {
    forget();
    scan();
  }
  if (lacks_schema_) {  // the schemas of the first pass are those of the second one
    forget();
    scan();
  }
  sort_places();
}

void McapFile::forget() {
  topics_.clear(), places_.clear(), channels_.clear(), is_wanted_.clear();
  lacks_schema_ = false;
}

void McapFile::add_schema(std::string_view body) {
  MessageCursor cursor(body, WireFormat::ros1, name_);
  const std::uint16_t id = cursor.u16();
  schemas_[id] = ros1_type(cursor.text());
}

void McapFile::add_channel(std::string_view body) {
  MessageCursor cursor(body, WireFormat::ros1, name_);
  const std::uint16_t id = cursor.u16(), schema = cursor.u16();
  BagTopic topic;
  topic.name = cursor.text(), topic.encoding = cursor.text();
  constexpr std::uint16_t kNoSchema = 0;
  if (const auto found = schemas_.find(schema); found != schemas_.end())
    topic.type = found->second;
  else
    lacks_schema_ |= schema != kNoSchema;
  channels_[id] = add_topic(topic);
}

// start: the first bytes of a message's record body, with the header that MCAP puts before the message.
void McapFile::list_message(std::string_view start, std::uint64_t part, std::uint64_t at) {
  const McapMessageHeader header = mcap_message_header(start, name_);
  const auto channel = channels_.find(header.channel);
  if (channel == channels_.end())
    refuse(name_, "a message is of channel ", header.channel,
           ": expected one that the file has listed before");
  add_message(channel->second, {header.logged_ns, part, at});
}

std::string McapFile::body_start(const McapRecord& record, std::uint64_t max_bytes) const {
  return file_.bytes(record.body_at, std::min(record.body_size, max_bytes));
}

std::string McapFile::start(const MessagePlace& place, std::uint64_t max_bytes) const {
  if (place.part != kNoChunk) return message_in_chunk(place, max_bytes);
  const McapRecord record = mcap_record_at(file_, place.at);
  if (record.opcode != McapRecord::message || record.body_size < McapRecord::kMessageHeader)
    refuse(name_, "has no message at byte ", place.at);
  const std::uint64_t length = record.body_size - McapRecord::kMessageHeader;
  require_length(length);
  return file_.bytes(record.body_at + McapRecord::kMessageHeader, std::min(length, max_bytes));
}

std::string McapFile::message_in_chunk(const MessagePlace& place, std::uint64_t max_bytes) const {
  const std::lock_guard lock(mutex_);
  if (!chunk_ || chunk_->record_at() != place.part) {
    chunk_.reset();  // frees memory before the next one takes some
    chunk_ = std::make_unique<BagChunk>(file_, mcap_chunk_at(file_, place.part));
  }
  const McapRecord record = mcap_record(chunk_->view(place.at, McapRecord::kStart), place.at);
  if (record.opcode != McapRecord::message || record.body_size < McapRecord::kMessageHeader)
    refuse(name_, "the chunk at byte ", place.part, " has no message at its byte ", place.at);
  const std::uint64_t length = record.body_size - McapRecord::kMessageHeader;
  require_length(length);
  if (max_bytes >= length && checked_.count(place.part) == 0) {
    chunk_->check();
    checked_.insert(place.part);
  }
  return std::string(chunk_->view(record.body_at + McapRecord::kMessageHeader, std::min(length, max_bytes)));
}

namespace {

// Finds the messages of an MCAP file: by the summary at its end, or by reading all of its records.

constexpr std::uint64_t kFooterBytes = McapRecord::kStart + 8 + 8 + 4;  // two positions and a CRC
constexpr std::uint64_t kMaxNameBytes = 4096;                           // bytes read of a schema or channel
constexpr std::uint64_t kMaxIndexBytes = 64u << 20;                     // limit for one record of an index

constexpr const char* kDamagedIndex = "has a damaged index: it was read from end to end";

}  // namespace

std::string McapFile::whole_body(const McapRecord& record) const {
  if (record.body_size > kMaxIndexBytes)
    refuse(name_, "a record of its index has ", record.body_size, " bytes: expected up to ", kMaxIndexBytes);
  return file_.bytes(record.body_at, record.body_size);
}

// Returns the position of the summary, as the footer states it. Returns none if the file has no footer or no
// summary. Returns none also if the summary has another CRC than stated; remark_ then says so.
std::optional<McapFile::Summary> McapFile::find_summary() {
  const std::uint64_t ends = kFooterBytes + kMcapMagic.size();
  if (!file_.has(0, kMcapMagic.size() + ends)) return std::nullopt;
  const std::uint64_t footer_at = file_.size() - ends;
  if (file_.bytes(file_.size() - kMcapMagic.size(), kMcapMagic.size()) != kMcapMagic) return std::nullopt;
  const McapRecord footer = mcap_record(file_.bytes(footer_at, McapRecord::kStart), footer_at);
  if (footer.opcode != McapRecord::footer || footer.end() != footer_at + kFooterBytes) return std::nullopt;
  const std::string body = file_.bytes(footer.body_at, footer.body_size);
  MessageCursor cursor(body, WireFormat::ros1, name_);
  const std::uint64_t summary_at = cursor.u64();
  cursor.u64();
  const std::uint32_t crc = cursor.u32();
  if (summary_at < kMcapMagic.size() || summary_at > footer_at) return std::nullopt;
  if (crc != 0 && crc != file_.crc(summary_at, footer.end() - 4)) {
    remark_ = kDamagedIndex;
    return std::nullopt;
  }
  return Summary{summary_at, footer_at};
}

bool McapFile::index_by_summary() {
  const auto summary = find_summary();
  if (!summary) return false;
  bool any_chunk = false;
  std::string statistics;
  const auto for_records = [&](auto use) {
    for (std::uint64_t at = summary->begin; at < summary->end;) {
      const McapRecord record = mcap_record_at(file_, at);
      if (!use(record)) return false;
      at = record.end();
    }
    return true;
  };
  try {
    // The records may have any order: channels before their schemas, and chunks before their channels.
    for_records([&](const McapRecord& record) {
      if (record.opcode == McapRecord::schema) add_schema(body_start(record, kMaxNameBytes));
      return true;
    });
    for_records([&](const McapRecord& record) {
      if (record.opcode == McapRecord::channel) add_channel(body_start(record, kMaxNameBytes));
      if (record.opcode == McapRecord::statistics) statistics = whole_body(record);
      return true;
    });
    schemas_are_in_data_ = lacks_schema_;  // a summary need not repeat them
    if (lacks_schema_) return false;
    const bool all_indexed = for_records([&](const McapRecord& record) {
      any_chunk |= record.opcode == McapRecord::chunk_index;
      return record.opcode != McapRecord::chunk_index || index_chunk(record);
    });
    return all_indexed && (statistics.empty() ? any_chunk : matches_statistics(statistics));
  } catch (const InputError&) {  // the cause does not matter, because the file is scanned next
    remark_ = kDamagedIndex;
    return false;
  }
}

// Lists the messages of wanted topics in one chunk. Returns false if the chunk has no index, or an index of a
// channel that is not listed.
bool McapFile::index_chunk(const McapRecord& chunk_index) {
  const std::string body = whole_body(chunk_index);
  MessageCursor cursor(body, WireFormat::ros1, name_);
  cursor.u64(), cursor.u64();  // the times of its messages
  const std::uint64_t chunk_at = cursor.u64();
  cursor.u64();
  const std::string_view offsets = cursor.bytes();
  const std::uint64_t index_length = cursor.u64();
  MessageCursor entry(offsets, WireFormat::ros1, name_);
  if (offsets.empty() && index_length == 0) return false;
  while (entry.left() > 0) {
    const std::uint16_t id = entry.u16();
    const std::uint64_t index_at = entry.u64();
    const auto channel = channels_.find(id);
    if (channel == channels_.end()) return false;
    if (!is_wanted_[channel->second]) continue;
    const McapRecord record = mcap_record_at(file_, index_at);
    if (record.opcode != McapRecord::message_index) return false;
    const std::string list = whole_body(record);
    MessageCursor messages(list, WireFormat::ros1, name_);
    if (messages.u16() != id) return false;
    MessageCursor places(messages.bytes(), WireFormat::ros1, name_);
    while (places.left() > 0) {
      const auto logged_ns = static_cast<std::int64_t>(places.u64());
      add_message(channel->second, {logged_ns, chunk_at, places.u64()});
    }
  }
  return true;
}

// Sets the number of messages of each topic, which for unwanted topics is known only from here. Returns false
// if the chunks' indexes do not contain all messages: some may be outside of chunks.
bool McapFile::matches_statistics(const std::string& statistics) {
  MessageCursor cursor(statistics, WireFormat::ros1, name_);
  cursor.view(8 + 2 + 4 + 4 + 4 + 4 + 8 + 8);  // other numbers, and the times of the messages
  MessageCursor entry(cursor.bytes(), WireFormat::ros1, name_);
  std::map<std::size_t, std::uint64_t> counts;
  while (entry.left() > 0) {
    const auto channel = channels_.find(entry.u16());
    const std::uint64_t count = entry.u64();
    if (channel == channels_.end()) return false;
    counts[channel->second] += count;
  }
  for (std::size_t t = 0; t < topics_.size(); ++t) {
    if (is_wanted_[t] && places_[t].size() != counts[t]) return false;
    topics_[t].messages = counts[t];
  }
  return true;
}

void McapFile::scan() {
  std::uint64_t at = kMcapMagic.size(), chunks = 0;
  bool ended = false;
  while (!ended && file_.has(at, McapRecord::kStart)) {
    const McapRecord record = mcap_record(file_.bytes(at, McapRecord::kStart), at);
    if (!file_.has(record.body_at, record.body_size)) break;
    if (record.opcode == McapRecord::schema) add_schema(body_start(record, kMaxNameBytes));
    if (record.opcode == McapRecord::channel) add_channel(body_start(record, kMaxNameBytes));
    if (record.opcode == McapRecord::message)
      list_message(body_start(record, McapRecord::kMessageHeader), 0, at);
    if (record.opcode == McapRecord::chunk) scan_chunk(record), ++chunks;
    ended = record.opcode == McapRecord::data_end || record.opcode == McapRecord::footer;
    at = record.end();
  }
  if (!ended) {
    remark_ = "was cut short after " + std::to_string(at) + " bytes of whole records: only these are used";
  } else if (chunks > 0 && remark_.empty() && !schemas_are_in_data_) {
    remark_ = "has no index of all messages: it was read from end to end";
  }
}

void McapFile::scan_chunk(const McapRecord& chunk) {
  const std::uint64_t part = chunk.body_at - McapRecord::kStart;
  BagChunk records(file_, mcap_chunk_at(file_, part));
  records.check();
  for (std::uint64_t at = 0; at < records.size();) {
    const McapRecord record = mcap_record(records.view(at, McapRecord::kStart), at);
    const std::uint64_t wanted =
        record.opcode == McapRecord::message ? McapRecord::kMessageHeader : kMaxNameBytes;
    const std::string body(records.view(record.body_at, std::min(record.body_size, wanted)));
    if (record.opcode == McapRecord::schema) add_schema(body);
    if (record.opcode == McapRecord::channel) add_channel(body);
    if (record.opcode == McapRecord::message) list_message(body, part, at);
    if (record.body_size > records.size() - record.body_at)
      refuse(name_, "the chunk at byte ", part, " ends within a record: it claims ", record.body_size,
             " bytes");
    at = record.end();
  }
  const std::lock_guard lock(mutex_);
  checked_.insert(part);
}

}  // namespace remote_touch
