// A bag: a file with the messages of many topics. Lists the topics and reads any message without reading the
// others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/files/input_files.h"
#include "scenarios/recordings/messages.h"

namespace remote_touch {

// A file that is read at given positions, so that threads share no current position.
class ByteFile {
 public:
  // Throws InputError when it cannot be opened or is no plain file.
  explicit ByteFile(const std::filesystem::path& file);
  ~ByteFile();
  ByteFile(const ByteFile&) = delete;
  ByteFile& operator=(const ByteFile&) = delete;

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }
  // Returns `size` bytes from `at` on. Throws InputError if the file ends before that; nothing is allocated
  // then.
  std::string bytes(std::uint64_t at, std::uint64_t size) const;
  void read(std::uint64_t at, char* to, std::size_t size) const;
  std::uint32_t crc(std::uint64_t at, std::uint64_t end) const;  // CRC-32 of the bytes from `at` to `end`
  bool has(std::uint64_t at, std::uint64_t size) const { return at <= size_ && size <= size_ - at; }

 private:
  std::string name_;
  std::uint64_t size_ = 0;
  int descriptor_ = -1;
};

// Maximum length of a message; a depth camera sends no longer message.
inline constexpr std::uint64_t kMaxMessageBytes = 256u << 20;

struct BagTopic {
  std::string name;
  std::string type;            // type as ROS 1 writes it, without "/msg": sensor_msgs/PointCloud2
  std::string encoding;        // cdr, ros1, or another, which is not read
  std::uint64_t messages = 0;  // also 0 if the file does not state the number, for an unwanted topic
};

// Removes the folder that ROS 2 adds to the names of its types: sensor_msgs/msg/Image.
std::string ros1_type(const std::string& type);

// True for topics that will be read: only the messages of these topics are listed.
using WantedTopic = std::function<bool(const BagTopic&)>;

struct MessagePlace {
  std::int64_t logged_ns = 0;      // time at which the recorder received the message
  std::uint64_t part = 0, at = 0;  // position of the message, as the kind of file defines it
};

// Several threads may read a bag at once.
class BagFile {
 public:
  virtual ~BagFile() = default;

  const std::vector<BagTopic>& topics() const { return topics_; }
  // Messages of a wanted topic, in the order of logged_ns. Messages with the same time are in the order of
  // the file.
  const std::vector<MessagePlace>& places(std::size_t topic) const { return places_[topic]; }
  // Empty, or what is wrong with the file and what was done about it: "was cut short: ...".
  const std::string& remark() const { return remark_; }

  // message() returns the bytes of a message; start() returns only its first max_bytes, which may take less
  // time. Both throw InputError about the file if the bytes cannot be read.
  std::string message(const MessagePlace& place) const { return start(place, kMaxMessageBytes); }
  virtual std::string start(const MessagePlace& place, std::uint64_t max_bytes) const = 0;

 protected:
  static constexpr std::size_t kMaxPlaces = 1u << 21;  // limit for each topic: 19 hours at 30 Hz, 50 MB
  static constexpr std::size_t kMaxTopics = 65536;

  // name: path of the bag, for an InputError.
  BagFile(const std::string& name, const WantedTopic& wanted) : name_(name), wanted_(wanted) {}

  // Returns the index of the topic. A topic with the same name, type and encoding is the same topic: several
  // publishers may have a connection each. Throws InputError beyond kMaxTopics or for a name that is longer
  // than 1024 bytes.
  std::size_t add_topic(const BagTopic& topic);
  // Lists a message of a wanted topic, and counts a message of another one.
  void add_message(std::size_t topic, const MessagePlace& place);
  void require_length(std::uint64_t bytes) const;  // throws InputError above kMaxMessageBytes
  void sort_places();                              // also sets BagTopic::messages of wanted topics

  const std::string name_;
  std::vector<BagTopic> topics_;
  std::vector<bool> is_wanted_;
  std::vector<std::vector<MessagePlace>> places_;
  std::string remark_;

 private:
  const WantedTopic wanted_;
};

// Opens a .mcap, .db3 or .bag file, by its ending, or a folder of ROS 2: metadata.yaml and one or more files,
// which are read as one bag. Throws InputError if the path is none of them or is damaged. A .mcap or .bag
// file that was cut short is read as far as its records are whole, see remark().
std::unique_ptr<BagFile> open_bag(const std::filesystem::path& path, const WantedTopic& wanted);

// Returns true if open_bag() reads such a path, by its ending or by the content of the folder.
bool is_bag(const std::filesystem::path& path);
// Returns the files that open_bag() reads, and metadata.yaml of a folder. Pre: is_bag(path).
std::vector<std::filesystem::path> files_of_bag(const std::filesystem::path& path);

// --- for the sources of this room ---

// Decodes compressed bytes piece by piece, as they are needed: frames of LZ4 and Zstandard, and bzip2.
// Removes bytes from the front of `from`, writes up to `size` decoded bytes and returns their number. Returns
// 0 only if it needs more bytes than `from` has, or if its frame has ended. Throws InputError for damaged
// bytes.
using Decompress = std::function<std::size_t(std::string_view& from, char* to, std::size_t size)>;

// Position and properties of a chunk, from its record.
struct ChunkPlace {
  std::uint64_t record_at = 0;                   // position of that record in the file
  std::uint64_t stored_at = 0, stored_size = 0;  // position and size of the bytes in the file
  std::uint64_t size = 0;                        // size of the records, decoded
  std::string compression;                       // empty, none, lz4, zstd or bz2
  std::uint32_t crc = 0;                         // CRC of the records, decoded; 0: not stated
  // The recorder ended before the chunk did: the records are those that the bytes give, and `size` is unused.
  bool is_open = false;
};

// One chunk of a bag: a series of records that are compressed together.
class BagChunk {
 public:
  static constexpr std::uint64_t kMaxBytes = 256u << 20;  // limit for the decoded size of a compressed chunk

  // `file` must outlive the chunk. Throws InputError about the file if it does not have the bytes, or the
  // compression is not known.
  BagChunk(const ByteFile& file, const ChunkPlace& place);

  std::uint64_t record_at() const { return place_.record_at; }
  std::uint64_t size() const { return place_.size; }  // bytes of its records
  // Returns `size` bytes of the records, from byte `at` on, valid until the next call. Decodes only as far as
  // needed and keeps the decoded bytes. Throws InputError if the bytes are beyond the end or damaged.
  std::string_view view(std::uint64_t at, std::uint64_t size);
  // Decodes the rest. Throws InputError if the file states a CRC and the records have another.
  void check();

 private:
  void decode_until(std::uint64_t end);
  void decode_open();
  template <class... Parts>
  [[noreturn]] void refuse_chunk(Parts... problem) const {
    refuse(file_.name(), "the chunk at byte ", place_.record_at, " ", problem...);
  }

  const ByteFile& file_;
  ChunkPlace place_;
  std::uint32_t crc_so_far_ = 0;
  Decompress decompress_;  // none: the records are stored as they are
  std::string decoded_;    // bytes decoded so far; if not compressed, those viewed last
  std::string input_;      // a piece of the compressed bytes
  std::string_view input_left_;
  std::uint64_t input_at_ = 0;  // number of compressed bytes read so far
  bool checked_ = false;
};

// The kinds of files whose records are in chunks, see open_bag(): .mcap and .bag.
std::unique_ptr<BagFile> open_mcap(const std::filesystem::path& file, const WantedTopic& wanted);
std::unique_ptr<BagFile> open_ros1_bag(const std::filesystem::path& file, const WantedTopic& wanted);

}  // namespace remote_touch
