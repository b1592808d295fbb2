#include "scenarios/recordings/bags/mcap_file.h"

#include <algorithm>

#include "core/parameters/input_error.h"

namespace remote_touch {
namespace {

// MessagePlace::part is the position of the message's chunk, or kNoChunk for a message outside of chunks. No
// chunk is at position 0, because the magic number is there.
constexpr std::uint64_t kNoChunk = 0;

[[noreturn]] void refuse_length(const std::string& file, std::uint64_t length) {
  throw InputError(file, "a message has " + std::to_string(length) + " bytes: expected up to " +
                             std::to_string(kMaxMessageBytes));
}

}  // namespace

McapFile::McapFile(const std::filesystem::path& file, const WantedTopic& wanted)
    : file_(file), wanted_(wanted) {
  const bool long_enough = file_.has(0, kMcapMagic.size());
  if (!long_enough || file_.bytes(0, kMcapMagic.size()) != kMcapMagic)
    throw InputError(file_.name(), "does not begin as an MCAP file");
  if (!index_by_summary()) {
    forget();
    scan();
  }
  sort_places();
}

void McapFile::forget() {
  topics_.clear(), places_.clear(), schemas_.clear(), channels_.clear(), is_wanted_.clear();
}

void McapFile::add_schema(std::string_view body) {
  MessageCursor cursor(body, WireFormat::ros1, file_.name());
  const std::uint16_t id = cursor.u16();
  schemas_[id] = ros1_type(cursor.text());
}

// Adds a channel to its topic. Several publishers of a topic may have a channel each.
void McapFile::add_channel(std::string_view body) {
  MessageCursor cursor(body, WireFormat::ros1, file_.name());
  const std::uint16_t id = cursor.u16(), schema = cursor.u16();
  BagTopic topic;
  topic.name = cursor.text(), topic.encoding = cursor.text();
  if (const auto found = schemas_.find(schema); found != schemas_.end()) topic.type = found->second;
  const auto same = std::find_if(topics_.begin(), topics_.end(), [&](const BagTopic& other) {
    return other.name == topic.name && other.type == topic.type && other.encoding == topic.encoding;
  });
  const bool is_new = same == topics_.end();
  const std::size_t index =
      is_new ? add_topic(file_.name(), topic) : static_cast<std::size_t>(same - topics_.begin());
  if (is_new) is_wanted_[index] = wanted_(topic);
  channels_[id] = index;
}

// start: the first bytes of a message's record body, with the header that MCAP puts before the message.
void McapFile::add_message(std::string_view start, std::uint64_t part, std::uint64_t at) {
  const McapMessageHeader header = mcap_message_header(start, file_.name());
  const auto channel = channels_.find(header.channel);
  if (channel == channels_.end())
    throw InputError(file_.name(), "a message is of channel " + std::to_string(header.channel) +
                                       ": expected one that the file has listed before");
  if (is_wanted_[channel->second]) {
    add_place(file_.name(), channel->second, {header.logged_ns, part, at});
  } else {
    ++topics_[channel->second].messages;
  }
}

std::string McapFile::body_start(const McapRecord& record, std::uint64_t max_bytes) const {
  return file_.bytes(record.body_at, std::min(record.body_size, max_bytes));
}

std::string McapFile::start(const MessagePlace& place, std::uint64_t max_bytes) const {
  if (place.part != kNoChunk) return message_in_chunk(place, max_bytes);
  const McapRecord record = mcap_record_at(file_, place.at);
  if (record.opcode != McapRecord::message || record.body_size < McapRecord::kMessageHeader)
    throw InputError(file_.name(), "has no message at byte " + std::to_string(place.at));
  const std::uint64_t length = record.body_size - McapRecord::kMessageHeader;
  if (length > kMaxMessageBytes) refuse_length(file_.name(), length);
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
    throw InputError(file_.name(), "the chunk at byte " + std::to_string(place.part) +
                                       " has no message at its byte " + std::to_string(place.at));
  const std::uint64_t length = record.body_size - McapRecord::kMessageHeader;
  if (length > kMaxMessageBytes) refuse_length(file_.name(), length);
  if (max_bytes >= length && checked_.count(place.part) == 0) {
    chunk_->check();
    checked_.insert(place.part);
  }
  return std::string(chunk_->view(record.body_at + McapRecord::kMessageHeader, std::min(length, max_bytes)));
}

}  // namespace remote_touch
