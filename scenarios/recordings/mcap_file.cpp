// Bags of ROS 2 in MCAP files.
#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <optional>
#include <set>

#include "core/parameters/parameter.h"
#include "scenarios/files/input_files.h"
#include "scenarios/recordings/bag_file.h"
#include "scenarios/recordings/frames_from_messages.h"

namespace remote_touch {
namespace {

// A record of an MCAP file: an opcode, a length of 64 bits, a body.
struct McapRecord {
  enum { footer = 2, schema, channel, message, chunk, message_index, chunk_index };  // opcodes
  enum { statistics = 11, data_end = 15 };
  static constexpr std::uint64_t kStart = 9;           // opcode and length
  static constexpr std::uint64_t kMessageHeader = 22;  // channel, number and two times, before the message

  unsigned char opcode = 0;
  std::uint64_t body_at = 0, body_size = 0;  // position and size in the file, or in the records of a chunk
  std::uint64_t end() const { return body_at + body_size; }
};

constexpr std::string_view kMcapMagic{"\x89MCAP0\r\n", 8};
// MessagePlace::part is the position of the message's chunk, or kNoChunk for a message outside of chunks. No
// chunk is at position 0, because the magic number is there.
constexpr std::uint64_t kNoChunk = 0;
constexpr std::uint64_t kFooterBytes = McapRecord::kStart + 8 + 8 + 4;  // two positions and a CRC
constexpr std::uint64_t kMaxNameBytes = 4096;                           // bytes read of a schema or channel
constexpr std::uint64_t kMaxIndexBytes = 64u << 20;                     // limit for one record of an index
constexpr const char* kDamagedIndex = "has a damaged index: it was read from end to end";

// Decodes opcode and length of the record that begins at `at`. start: the first kStart bytes of the record.
McapRecord mcap_record(std::string_view start, std::uint64_t at) {
  McapRecord record;
  record.opcode = static_cast<unsigned char>(start[0]);
  std::memcpy(&record.body_size, start.data() + 1, sizeof record.body_size);
  record.body_at = at + McapRecord::kStart;
  return record;
}

// Reads the same from a file. Throws InputError if the file ends before the record does.
McapRecord mcap_record_at(const ByteFile& file, std::uint64_t at) {
  const McapRecord record = mcap_record(file.bytes(at, McapRecord::kStart), at);
  if (!file.has(record.body_at, record.body_size))
    refuse(file.name(), "the record at byte ", at, " claims ", record.body_size, " bytes: the file has ",
           file.size() - record.body_at, " left");
  return record;
}

// Reads the chunk record that begins at `at`. Throws InputError if there is none.
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

// Finds messages by the index at the file's end. If there is no complete index, the constructor reads the
// whole file, which takes as long as decompressing it. The CRC of a chunk is checked when a message of it is
// read as a whole. The CRC of the index is checked when the index is used.
class McapFile final : public BagFile {
 public:
  McapFile(const std::filesystem::path& file, const WantedTopic& wanted)
      : BagFile(file.string(), wanted), file_(file) {
    const bool long_enough = file_.has(0, kMcapMagic.size());
    if (!long_enough || file_.bytes(0, kMcapMagic.size()) != kMcapMagic)
      refuse(name_, "does not begin as an MCAP file");
    if (!index_by_summary()) scan();
    if (lacks_schema_) scan();  // the schemas of the first pass are those of the second one
    sort_places();
  }

  std::string start(const MessagePlace& place, std::uint64_t max_bytes) const override {
    if (place.part != kNoChunk) return message_in_chunk(place, max_bytes);
    const McapRecord record = mcap_record_at(file_, place.at);
    const std::uint64_t length = message_length(record, "has no message at byte ", place.at);
    return file_.bytes(record.body_at + McapRecord::kMessageHeader, std::min(length, max_bytes));
  }

 private:
  struct Summary {
    std::uint64_t begin = 0, end = 0;
  };
  // Returns the position of the summary, as the footer states it. Returns none if the file has no footer or
  // no summary. Returns none also if the summary has another CRC than stated; remark_ then says so.
  std::optional<Summary> find_summary() {
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

  // Lists the messages from the index. Returns false if the index is missing, damaged or incomplete.
  bool index_by_summary() {
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

  // Lists the messages of wanted topics in one chunk. Returns false if the chunk has no index, or an index of
  // a channel that is not listed.
  bool index_chunk(const McapRecord& chunk_index) {
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

  // Sets the number of messages of each topic, which for unwanted topics is known only from here. Returns
  // false if the chunks' indexes do not contain all messages: some may be outside of chunks.
  bool matches_statistics(const std::string& statistics) {
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

  // Lists the messages anew by reading all records.
  void scan() {
    topics_.clear(), places_.clear(), channels_.clear(), is_wanted_.clear();
    lacks_schema_ = false;
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

  void scan_chunk(const McapRecord& chunk) {
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

  void add_schema(std::string_view body) {
    MessageCursor cursor(body, WireFormat::ros1, name_);
    const std::uint16_t id = cursor.u16();
    schemas_[id] = ros1_type(cursor.text());
  }

  void add_channel(std::string_view body) {
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
  void list_message(std::string_view start, std::uint64_t part, std::uint64_t at) {
    MessageCursor cursor(start, WireFormat::ros1, name_);
    const std::uint16_t id = cursor.u16();
    cursor.u32();  // the number of the message
    const auto logged_ns = static_cast<std::int64_t>(cursor.u64());
    cursor.u64();  // when it was sent
    const auto channel = channels_.find(id);
    if (channel == channels_.end())
      refuse(name_, "a message is of channel ", id, ": expected one that the file has listed before");
    add_message(channel->second, {logged_ns, part, at});
  }

  // Returns the bytes of a message behind its header. problem: of a record that is no message.
  template <class... Parts>
  std::uint64_t message_length(const McapRecord& record, Parts... problem) const {
    if (record.opcode != McapRecord::message || record.body_size < McapRecord::kMessageHeader)
      refuse(name_, problem...);
    require_length(record.body_size - McapRecord::kMessageHeader);
    return record.body_size - McapRecord::kMessageHeader;
  }

  std::string message_in_chunk(const MessagePlace& place, std::uint64_t max_bytes) const {
    const std::lock_guard lock(mutex_);
    if (!chunk_ || chunk_->record_at() != place.part) {
      chunk_.reset();  // frees memory before the next one takes some
      chunk_ = std::make_unique<BagChunk>(file_, mcap_chunk_at(file_, place.part));
    }
    const McapRecord record = mcap_record(chunk_->view(place.at, McapRecord::kStart), place.at);
    const std::uint64_t length =
        message_length(record, "the chunk at byte ", place.part, " has no message at its byte ", place.at);
    if (max_bytes >= length && checked_.count(place.part) == 0) {
      chunk_->check();
      checked_.insert(place.part);
    }
    return std::string(
        chunk_->view(record.body_at + McapRecord::kMessageHeader, std::min(length, max_bytes)));
  }

  std::string body_start(const McapRecord& record, std::uint64_t max_bytes) const {
    return file_.bytes(record.body_at, std::min(record.body_size, max_bytes));
  }

  std::string whole_body(const McapRecord& record) const {
    if (record.body_size > kMaxIndexBytes)
      refuse(name_, "a record of its index has ", record.body_size, " bytes: expected up to ",
             kMaxIndexBytes);
    return file_.bytes(record.body_at, record.body_size);
  }

  const ByteFile file_;
  std::map<std::uint16_t, std::string> schemas_;   // their names
  bool lacks_schema_ = false;                      // a channel has a schema that was not listed before it
  bool schemas_are_in_data_ = false;               // the index is complete, but has no schemas
  std::map<std::uint16_t, std::size_t> channels_;  // their topics
  mutable std::mutex mutex_;                       // guards the members below
  mutable std::unique_ptr<BagChunk> chunk_;        // chunk that was read last
  mutable std::set<std::uint64_t> checked_;        // positions of the chunks whose CRC was checked
};

}  // namespace

std::unique_ptr<BagFile> open_mcap(const std::filesystem::path& file, const WantedTopic& wanted) {
  return std::make_unique<McapFile>(file, wanted);
}

}  // namespace remote_touch
