// Bags of ROS 1 (.bag, version 2.0), as rosbag and librealsense write them.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag_chunk.h"
#include "scenarios/recordings/bags/bag_file.h"

namespace remote_touch {

// A record: named values, then data.
struct Ros1Record {
  enum Opcode { message = 2, bag_header = 3, index = 4, chunk = 5, chunk_info = 6, connection = 7 };

  std::map<std::string, std::string> values;
  std::uint64_t data_at = 0, data_size = 0;  // position and size in the file, or in the records of a chunk
  std::uint64_t end() const { return data_at + data_size; }
  // Both throw InputError about the subject if there is no such value.
  std::uint32_t number(const std::string& name, const std::string& subject) const;
  int opcode(const std::string& subject) const;
};

// Finds messages by the lists behind the chunks. If the bag was not closed or was cut short, it reads all
// whole chunks instead. A recorder that was killed leaves an open chunk at the end, whose record claims 0
// bytes: the whole messages behind that record are read, too.
class Ros1Bag final : public BagFile {
 public:
  Ros1Bag(const std::filesystem::path& file, const WantedTopic& wanted);
  std::string start(const MessagePlace& place, std::uint64_t max_bytes) const override;

 private:
  Ros1Record record_at(std::uint64_t at) const;
  Ros1Record record_in(BagChunk& chunk, std::uint64_t at) const;
  std::unique_ptr<BagChunk> open_chunk(std::uint64_t at) const;
  bool walk();  // false: the file ends within a record, or with an open chunk
  void add_connection(const Ros1Record& record, std::string_view data);
  void add_index(std::uint64_t chunk_at, const Ros1Record& record);
  void scan_chunk(std::uint64_t at);
  void scan_open_chunk();
  void add_record_of_chunk(BagChunk& chunk, const Ros1Record& record, std::uint64_t at);
  void add_message_of(std::uint32_t connection, const MessagePlace& place);

  const ByteFile file_;
  std::map<std::uint32_t, std::size_t> topic_of_;  // key: connection
  struct Listed {
    std::uint64_t chunk_at, index_at;  // index_at 0: the chunk itself
  };
  std::vector<Listed> listed_;
  bool is_closed_ = false;
  std::uint64_t open_at_ = 0;  // position of the chunk that was being written; 0: none
  mutable std::mutex mutex_;   // guards the chunk that was read last
  mutable std::unique_ptr<BagChunk> chunk_;
};

}  // namespace remote_touch
