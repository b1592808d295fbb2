#include "tests/support/bag_files.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <map>
#include <stdexcept>

namespace remote_touch {
namespace {

template <class Value>
std::string little(Value value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string with_length(const std::string& text) {
  return little(static_cast<std::uint32_t>(text.size())) + text;
}

std::string compressed(const std::string& kind, const std::string& bytes) {
  if (kind == "lz4") {
    std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
    return out;
  }
  if (kind == "zstd") {
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
    return out;
  }
  if (kind == "bz2") {
    unsigned size = static_cast<unsigned>(bytes.size() + bytes.size() / 50 + 1000);
    std::string out(size, '\0');
    BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()),
                             static_cast<unsigned>(bytes.size()), 1, 0, 0);
    out.resize(size);
    return out;
  }
  return bytes;
}

std::uint32_t crc_of_bytes(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::string record(unsigned char opcode, const std::string& body) {
  return std::string(1, static_cast<char>(opcode)) + little(static_cast<std::uint64_t>(body.size())) + body;
}

}  // namespace

MessageBytes::MessageBytes(Format format) : format_(format) {
  if (format == Format::cdr) bytes_ = std::string("\0\1\0\0", 4);
  if (format == Format::cdr_big_endian) bytes_ = std::string("\0\0\0\0", 4);
  origin_ = bytes_.size();
}

MessageBytes& MessageBytes::append(const char* value, std::size_t size) {
  if (format_ != Format::ros1)
    while ((bytes_.size() - origin_) % size != 0) bytes_ += '\0';
  bytes_.append(value, size);
  if (format_ == Format::cdr_big_endian)
    std::reverse(bytes_.end() - static_cast<std::ptrdiff_t>(size), bytes_.end());
  return *this;
}

MessageBytes& MessageBytes::text(const std::string& text) {
  return bytes(format_ == Format::ros1 ? text : text + '\0');
}

MessageBytes& MessageBytes::bytes(const std::string& bytes) {
  add(static_cast<std::uint32_t>(bytes.size()));
  bytes_ += bytes;
  return *this;
}

MessageBytes& MessageBytes::header(std::int64_t stamp_ns, const std::string& frame_id) {
  if (format_ == Format::ros1) add(std::uint32_t{7});
  add(static_cast<std::int32_t>(stamp_ns / 1'000'000'000));
  add(static_cast<std::uint32_t>(stamp_ns % 1'000'000'000));
  return text(frame_id);
}

std::string cloud_message(MessageBytes::Format format, std::int64_t stamp_ns, int width, int height,
                          float z_m, const std::string& frame_id) {
  const bool big = format == MessageBytes::Format::cdr_big_endian;
  MessageBytes message(format);
  message.header(stamp_ns, frame_id).add(height).add(width).add(std::uint32_t{3});
  std::uint32_t offset = 0;
  for (const char* name : {"x", "y", "z"}) {
    message.text(name).add(offset).add(std::uint8_t{7}).add(std::uint32_t{1});
    offset += 4;
  }
  std::string data;
  for (int v = 0; v < height; ++v)
    for (int u = 0; u < width; ++u)
      for (const float value :
           {(u - 0.5f * (width - 1)) / 10 * z_m, (v - 0.5f * (height - 1)) / 10 * z_m, z_m}) {
        std::string bytes = little(value);
        if (big) std::reverse(bytes.begin(), bytes.end());
        data += bytes;
      }
  message.add(std::uint8_t{big}).add(std::uint32_t{12}).add(static_cast<std::uint32_t>(12 * width));
  return message.bytes(data).add(std::uint8_t{1}).done();
}

std::string depth_message(std::int64_t stamp_ns, int width, int height, std::uint16_t millimetres) {
  std::string data;
  for (int i = 0; i < width * height; ++i) data += little(millimetres);
  MessageBytes message;
  message.header(stamp_ns, "optical").add(height).add(width).text("16UC1").add(std::uint8_t{0});
  return message.add(static_cast<std::uint32_t>(2 * width)).bytes(data).done();
}

std::string camera_message(int width, int height, const std::vector<double>& distortion,
                           const std::string& model) {
  MessageBytes message;
  message.header(1, "optical").add(height).add(width).text(model);
  message.add(static_cast<std::uint32_t>(distortion.size()));
  for (const double d : distortion) message.add(d);
  const double cx = 0.5 * (width - 1), cy = 0.5 * (height - 1);
  for (const double k : {10.0, 0.0, cx, 0.0, 10.0, cy, 0.0, 0.0, 1.0}) message.add(k);
  for (const double r : {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) message.add(r);
  for (const double p : {20.0, 0.0, cx, 0.0, 0.0, 20.0, cy, 0.0, 0.0, 0.0, 1.0, 0.0}) message.add(p);
  for (int i = 0; i < 6; ++i) message.add(std::uint32_t{0});  // binning, region of interest
  return message.add(std::uint8_t{0}).done();
}

namespace {

// A file of MCAP while it is written.
class McapText {
 public:
  explicit McapText(const McapLayout& layout) : layout_(layout) {
    file_ = kMagic + record(1, with_length("ros2") + with_length(""));
  }

  void add(const BagMessage& message) {
    std::string& to = layout_.chunks ? chunk_ : file_;
    const bool is_new = ids_.count(message.topic) == 0;
    const auto id = is_new ? static_cast<std::uint16_t>(ids_.size() + 1) : ids_[message.topic];
    if (is_new) {
      const std::string schema =
          record(3, little(id) + with_length(message.type) + with_length("ros2msg") + with_length(""));
      const std::string channel = record(
          4, little(id) + little(id) + with_length(message.topic) + with_length("cdr") + with_length(""));
      to += layout_.channels_first && !layout_.index ? channel + schema : schema + channel;
      ids_[message.topic] = id, schemas_ += schema, channels_ += channel;
    }
    ++counts_[id], ++messages_;
    lists_[id] += little(message.logged_ns) + little(static_cast<std::uint64_t>(to.size()));
    to += record(5, little(id) + little(std::uint32_t{0}) + little(message.logged_ns) +
                        little(message.logged_ns) + message.bytes);
    if (layout_.chunks && ++in_chunk_ == layout_.messages_per_chunk) end_chunk();
  }

  std::string done() {
    if (in_chunk_ > 0) end_chunk();
    file_ += record(15, little(std::uint32_t{0}));
    const std::uint64_t summary_at = file_.size();
    const std::string schemas = layout_.repeats_schemas ? schemas_ : "";
    const std::string names = layout_.channels_first ? channels_ + schemas : schemas + channels_;
    if (layout_.index) file_ += names + indexes_ + statistics();
    const std::string footer = std::string(1, 2) + little(std::uint64_t{20}) +
                               little(layout_.index ? summary_at : std::uint64_t{0}) +
                               little(std::uint64_t{0});
    const bool has_crc = layout_.index && layout_.crc;
    const std::uint32_t crc = has_crc ? crc_of_bytes(file_.substr(summary_at) + footer) : 0;
    return file_ + footer + little(crc) + kMagic;
  }

 private:
  void end_chunk() {
    const std::string stored = compressed(layout_.compression, chunk_);
    const auto stored_size = static_cast<std::uint64_t>(stored.size());
    const std::uint64_t at = file_.size(), size = chunk_.size();
    file_ += record(6, std::string(16, '\0') + little(size) + little(layout_.crc ? crc_of_bytes(chunk_) : 0) +
                           with_length(layout_.compression) + little(stored_size) + stored);
    const std::uint64_t length = file_.size() - at;
    std::string places;
    for (const auto& [id, list] : lists_) {
      places += little(id) + little(static_cast<std::uint64_t>(file_.size()));
      file_ += record(7, little(id) + with_length(list));
    }
    indexes_ += record(8, std::string(16, '\0') + little(at) + little(length) + with_length(places) +
                              little(static_cast<std::uint64_t>(file_.size()) - at - length) +
                              with_length(layout_.compression) + little(stored_size) + little(size));
    chunk_.clear(), lists_.clear(), in_chunk_ = 0, ++chunks_;
  }

  std::string statistics() const {
    std::string counts;
    for (const auto& [id, count] : counts_) counts += little(id) + little(count);
    const auto topics = static_cast<std::uint32_t>(ids_.size());
    return record(11, little(messages_) + little(static_cast<std::uint16_t>(topics)) + little(topics) +
                          std::string(8, '\0') + little(chunks_) + std::string(16, '\0') +
                          with_length(counts));
  }

  const std::string kMagic{"\x89MCAP0\r\n", 8};
  const McapLayout layout_;
  std::string file_, schemas_, channels_, chunk_, indexes_;
  std::map<std::string, std::uint16_t> ids_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::map<std::uint16_t, std::string> lists_;  // index of this chunk's messages, per channel
  std::size_t in_chunk_ = 0;
  std::uint32_t chunks_ = 0;
  std::uint64_t messages_ = 0;
};

}  // namespace

std::string mcap_file(const std::vector<BagMessage>& messages, const McapLayout& layout) {
  McapText text(layout);
  for (const BagMessage& message : messages) text.add(message);
  return text.done();
}

namespace {

using NamedValues = std::vector<std::pair<std::string, std::string>>;

std::string ros1_record(const NamedValues& values, const std::string& data) {
  std::string head;
  for (const auto& [name, value] : values) head += with_length(name + "=" + value);
  return with_length(head) + with_length(data);
}

std::string ros1_time(std::int64_t ns) {
  return little(static_cast<std::uint32_t>(ns / 1'000'000'000)) +
         little(static_cast<std::uint32_t>(ns % 1'000'000'000));
}

std::string op(char code) {
  return std::string(1, code);
}

}  // namespace

std::string ros1_file(const std::vector<BagMessage>& messages, const std::string& compression, bool closed) {
  const std::uint64_t index_pos = closed ? 1 : 0;
  std::string file = "#ROSBAG V2.0\n";
  file += ros1_record({{"op", op(3)},
                       {"index_pos", little(index_pos)},
                       {"conn_count", little(1)},
                       {"chunk_count", little(1)}},
                      std::string(100, ' '));
  std::map<std::string, std::uint32_t> ids;
  std::map<std::uint32_t, std::string> lists;
  std::string chunk, connections;
  for (const BagMessage& message : messages) {
    if (ids.count(message.topic) == 0) {
      const auto id = static_cast<std::uint32_t>(ids.size());
      ids[message.topic] = id;
      std::string type = message.type;
      if (const std::size_t at = type.find("/msg/"); at != std::string::npos) type.erase(at, 4);
      const std::string connection =
          ros1_record({{"op", op(7)}, {"conn", little(id)}, {"topic", message.topic}},
                      with_length("topic=" + message.topic) + with_length("type=" + type));
      chunk += connection, connections += connection;
    }
    const std::uint32_t id = ids[message.topic];
    lists[id] += ros1_time(message.logged_ns) + little(static_cast<std::uint32_t>(chunk.size()));
    chunk += ros1_record({{"op", op(2)}, {"conn", little(id)}, {"time", ros1_time(message.logged_ns)}},
                         message.bytes);
  }
  file += ros1_record({{"op", op(5)},
                       {"compression", compression},
                       {"size", little(static_cast<std::uint32_t>(chunk.size()))}},
                      compressed(compression, chunk));
  for (const auto& [id, list] : lists)
    file += ros1_record({{"op", op(4)},
                         {"ver", little(1)},
                         {"conn", little(id)},
                         {"count", little(static_cast<std::uint32_t>(list.size() / 12))}},
                        list);
  return closed ? file + connections : file;
}

void write_db3(const std::string& file, const std::vector<BagMessage>& messages) {
  sqlite3* database = nullptr;
  sqlite3_open(file.c_str(), &database);
  const auto run = [&](const std::string& text) {
    if (sqlite3_exec(database, text.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
      throw std::runtime_error(sqlite3_errmsg(database));
  };
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format TEXT "
      "NOT NULL, offered_qos_profiles TEXT NOT NULL); CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER "
      "NOT NULL, timestamp INTEGER NOT NULL, data BLOB NOT NULL); BEGIN");
  std::map<std::string, std::size_t> ids;
  for (const BagMessage& message : messages) {
    if (ids.emplace(message.topic, ids.size() + 1).second)
      run("INSERT INTO topics VALUES (" + std::to_string(ids.size()) + ", '" + message.topic + "', '" +
          message.type + "', 'cdr', '')");
    sqlite3_stmt* query = nullptr;
    sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)", -1,
                       &query, nullptr);
    sqlite3_bind_int64(query, 1, static_cast<sqlite3_int64>(ids[message.topic]));
    sqlite3_bind_int64(query, 2, message.logged_ns);
    sqlite3_bind_blob(query, 3, message.bytes.data(), static_cast<int>(message.bytes.size()),
                      SQLITE_TRANSIENT);
    sqlite3_step(query);
    sqlite3_finalize(query);
  }
  run("COMMIT");
  sqlite3_close(database);
}

}  // namespace remote_touch
