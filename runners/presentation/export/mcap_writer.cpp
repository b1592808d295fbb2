#include "runners/presentation/export/mcap_writer.h"

#include <zlib.h>

#include <algorithm>

#include "runners/presentation/export/little_endian.h"

namespace remote_touch {

namespace {

enum class Record : std::uint8_t {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0b,
  metadata = 0x0c,
  metadata_index = 0x0d,
  summary_offset = 0x0e,
  data_end = 0x0f
};

constexpr std::size_t kChunkSize = 1 << 20;
const std::string kMagic("\x89MCAP0\r\n", 8);

std::uint32_t crc_after(std::uint32_t before, const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

std::string record(Record kind, const std::string& content) {
  std::string bytes;
  put(bytes, static_cast<std::uint8_t>(kind));
  put(bytes, std::uint64_t{content.size()});
  return bytes + content;
}

// Appends the length of the text, then the text.
void put_text(std::string& bytes, const std::string& text) {
  put(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += text;
}

std::string text_map(const McapWriter::Texts& texts) {
  std::string entries, map;
  for (const auto& [name, value] : texts) put_text(entries, name), put_text(entries, value);
  put_text(map, entries);
  return map;
}

void put_number_map(std::string& bytes, const std::map<std::uint16_t, std::uint64_t>& numbers) {
  std::string entries;
  for (const auto& [channel, number] : numbers) put(entries, channel), put(entries, number);
  put_text(bytes, entries);
}

std::string header_record(const std::string& profile, const std::string& library) {
  std::string content;
  put_text(content, profile), put_text(content, library);
  return record(Record::header, content);
}

}  // namespace

void McapWriter::Times::add(std::uint64_t time_ns) {
  first = is_empty ? time_ns : std::min(first, time_ns);
  last = is_empty ? time_ns : std::max(last, time_ns);
  is_empty = false;
}

std::string McapWriter::opening(const std::string& profile, const std::string& library) {
  return kMagic + header_record(profile, library);
}

McapWriter::McapWriter(const std::string& profile, const std::string& library,
                       std::function<void(const std::string&)> write)
    : write_(std::move(write)) {
  emit(opening(profile, library));
}

void McapWriter::emit(const std::string& bytes) {
  write_(bytes);
  crc_ = crc_after(crc_, bytes);
  size_ += bytes.size();
}

std::uint16_t McapWriter::add_topic(const McapTopic& topic) {
  const auto [known, is_new] =
      schemas_.try_emplace(topic.schema, static_cast<std::uint16_t>(schemas_.size() + 1));  // 0: no schema
  if (is_new) {
    std::string content;
    put(content, known->second);
    put_text(content, topic.schema), put_text(content, topic.schema_encoding);
    put_text(content, topic.schema_text);
    schema_records_ += record(Record::schema, content);
    chunk_.records += record(Record::schema, content);
  }
  const auto channel = static_cast<std::uint16_t>(messages_.size());
  std::string content;
  put(content, channel), put(content, known->second);
  put_text(content, topic.name), put_text(content, topic.message_encoding);
  content += text_map({});
  channel_records_ += record(Record::channel, content);
  chunk_.records += record(Record::channel, content);
  messages_[channel] = 0;
  return channel;
}

void McapWriter::add_metadata(const std::string& name, const Texts& texts) {
  std::string content, index;
  put_text(content, name);
  content += text_map(texts);
  const std::string whole = record(Record::metadata, content);
  put(index, size_), put(index, std::uint64_t{whole.size()});
  put_text(index, name);
  metadata_indexes_ += record(Record::metadata_index, index);
  ++metadata_;
  emit(whole);
}

void McapWriter::message(std::uint16_t channel, std::uint64_t log_ns, std::uint64_t publish_ns,
                         const std::string& data) {
  std::string& index = chunk_.index[channel];
  put(index, log_ns), put(index, std::uint64_t{chunk_.records.size()});
  std::string content;
  put(content, channel), put(content, static_cast<std::uint32_t>(messages_[channel]++));
  put(content, log_ns), put(content, publish_ns);
  chunk_.records += record(Record::message, content + data);
  chunk_.times.add(log_ns);
  times_.add(log_ns);
  if (chunk_.records.size() >= kChunkSize) close_chunk();
}

void McapWriter::close_chunk() {
  if (chunk_.records.empty()) return;
  const std::uint64_t start = size_, records = chunk_.records.size();
  std::string content, indexes, index;
  put(content, chunk_.times.first), put(content, chunk_.times.last);
  put(content, records), put(content, crc_after(0, chunk_.records));
  put_text(content, "");  // not compressed
  put(content, records);
  emit(record(Record::chunk, content + chunk_.records));
  const std::uint64_t length = size_ - start;
  std::map<std::uint16_t, std::uint64_t> places;
  for (const auto& [channel, entries] : chunk_.index) {
    places[channel] = size_ + indexes.size();
    std::string of_channel;
    put(of_channel, channel), put_text(of_channel, entries);
    indexes += record(Record::message_index, of_channel);
  }
  emit(indexes);
  put(index, chunk_.times.first), put(index, chunk_.times.last);
  put(index, start), put(index, length);
  put_number_map(index, places);
  put(index, std::uint64_t{indexes.size()});
  put_text(index, "");
  put(index, records), put(index, records);
  chunk_indexes_ += record(Record::chunk_index, index);
  ++chunks_;
  chunk_ = {};
}

std::string McapWriter::statistics() const {
  std::uint64_t all = 0;
  for (const auto& [channel, count] : messages_) all += count;
  std::string content;
  put(content, all), put(content, static_cast<std::uint16_t>(schemas_.size()));
  put(content, static_cast<std::uint32_t>(messages_.size())), put(content, std::uint32_t{0});  // attachments
  put(content, metadata_), put(content, chunks_);
  put(content, times_.first), put(content, times_.last);
  put_number_map(content, messages_);
  return record(Record::statistics, content);
}

void McapWriter::finish() {
  close_chunk();
  std::string end;
  put(end, crc_);
  emit(record(Record::data_end, end));
  const std::uint64_t start = size_;
  std::string summary, offsets;
  const auto add = [&](Record kind, const std::string& records) {
    if (records.empty()) return;
    std::string offset;
    put(offset, static_cast<std::uint8_t>(kind));
    put(offset, start + summary.size()), put(offset, std::uint64_t{records.size()});
    offsets += record(Record::summary_offset, offset);
    summary += records;
  };
  add(Record::schema, schema_records_);
  add(Record::channel, channel_records_);
  add(Record::statistics, statistics());
  add(Record::chunk_index, chunk_indexes_);
  add(Record::metadata_index, metadata_indexes_);
  // The CRC covers everything from the start of the summary to the footer's own field for it.
  std::string footer;
  put(footer, start), put(footer, start + summary.size());
  put(footer, std::uint32_t{0});
  footer = record(Record::footer, footer);
  footer.resize(footer.size() - sizeof(std::uint32_t));
  const std::string checked = summary + offsets + footer;
  emit(checked);
  std::string sum;
  put(sum, crc_after(0, checked));
  emit(sum + kMagic);
}

}  // namespace remote_touch
