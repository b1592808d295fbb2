#include "scenarios/recordings/bags/mcap_file.h"

#include <algorithm>

#include "scenarios/text_files/refuse.h"

namespace remote_touch {
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

}  // namespace remote_touch
