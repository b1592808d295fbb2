// Small bags for the tests of their readers: messages, files of MCAP, of ROS 1 and of SQLite.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace remote_touch {

// The values of a message one after the other, as ROS 2 (CDR, in either byte order) or ROS 1 stores them.
class MessageBytes {
 public:
  enum class Format { cdr, cdr_big_endian, ros1 };
  explicit MessageBytes(Format format = Format::cdr);

  template <class Value>
  MessageBytes& add(Value value) {
    return append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  MessageBytes& text(const std::string& text);
  MessageBytes& bytes(const std::string& bytes);  // a sequence of bytes
  MessageBytes& header(std::int64_t stamp_ns, const std::string& frame_id);
  const std::string& done() const { return bytes_; }

 private:
  MessageBytes& append(const char* value, std::size_t size);  // value: in this machine's byte order

  Format format_;
  std::string bytes_;
  std::size_t origin_ = 0;
};

// An organised cloud of float32 x, y, z: pixel (u, v) is at depth z_m of a pinhole with f = 10 and the
// principal point in the middle.
std::string cloud_message(MessageBytes::Format format, std::int64_t stamp_ns, int width, int height,
                          float z_m, const std::string& frame_id = "optical");
std::string depth_message(std::int64_t stamp_ns, int width, int height, std::uint16_t millimetres);
// The camera has fx = fy = 10 and the principal point in the middle.
std::string camera_message(int width, int height, const std::vector<double>& distortion = {},
                           const std::string& model = "plumb_bob");

struct BagMessage {
  std::string topic, type;  // type is, for example, sensor_msgs/msg/PointCloud2
  std::int64_t logged_ns = 0;
  std::string bytes;
};

struct McapLayout {
  bool chunks = true, index = true, crc = true;
  std::string compression = "";  // empty, lz4 or zstd
  std::size_t messages_per_chunk = 2;
  bool repeats_schemas = true;  // copies in the summary
  bool channels_first =
      false;  // copies in the summary; without a summary also before the schemas of the data
};
std::string mcap_file(const std::vector<BagMessage>& messages, const McapLayout& layout = {});
// compression is none, lz4 or bz2. Types are written without "/msg". A file that is not closed has no index
// at the end.
std::string ros1_file(const std::vector<BagMessage>& messages, const std::string& compression = "none",
                      bool closed = true);
void write_db3(const std::string& file, const std::vector<BagMessage>& messages);

}  // namespace remote_touch
