// Files of time-stamped messages: MCAP, https://mcap.dev/spec, with chunks that are not compressed.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace remote_touch {

struct McapTopic {
  std::string name;
  std::string schema, schema_encoding, schema_text, message_encoding;
};

// Passes the bytes of the file to `write` as it grows. All topics are added before the first message.
class McapWriter {
 public:
  using Texts = std::vector<std::pair<std::string, std::string>>;

  McapWriter(const std::string& profile, const std::string& library,
             std::function<void(const std::string&)> write);
  // Topics whose schemas have the same name share the schema. Returns the number of the topic's channel.
  std::uint16_t add_topic(const McapTopic& topic);
  void add_metadata(const std::string& name, const Texts& texts);
  void message(std::uint16_t channel, std::uint64_t log_ns, std::uint64_t publish_ns,
               const std::string& data);
  void finish();

  // Returns the bytes with which a file of that profile and library begins.
  static std::string opening(const std::string& profile, const std::string& library);

 private:
  struct Times {
    std::uint64_t first = 0, last = 0;
    bool is_empty = true;
    void add(std::uint64_t time_ns);
  };
  struct Chunk {
    std::string records;
    Times times;
    std::map<std::uint16_t, std::string> index;  // time and position of each message, by channel
  };
  void emit(const std::string& bytes);
  void close_chunk();
  std::string statistics() const;

  std::function<void(const std::string&)> write_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;  // CRC-32 of all bytes so far
  Chunk chunk_;
  Times times_;
  std::map<std::string, std::uint16_t> schemas_;
  std::map<std::uint16_t, std::uint64_t> messages_;  // number of messages by channel
  // Records that are repeated at the end.
  std::string schema_records_, channel_records_, chunk_indexes_, metadata_indexes_;
  std::uint32_t chunks_ = 0, metadata_ = 0;
};

}  // namespace remote_touch
