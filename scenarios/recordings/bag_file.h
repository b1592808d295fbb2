// A bag: a file with the messages of many topics, and the frames in it. Lists the topics and reads any
// message without reading the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/points/point_cloud.h"
#include "scenarios/files/input_files.h"
#include "scenarios/recordings/frames_from_messages.h"

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

// Chunks of a bag, for the sources of this room only.

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

// The frames in a bag of ROS: the messages of one topic, in the order of their stamps, as clouds.

// The part of a bag that is used. topic and camera_info are names of topics. If a name is empty, the program
// chooses the topic.
struct BagChoice {
  enum class Images { by_name, measured, rectified };
  std::string topic;                // topic of clouds or depth images; empty: the only one that has them
  std::string camera_info;          // topic of their camera; empty: found by the name of the images' topic
  Images images = Images::by_name;  // `by_name`: rectified if the last part of the topic's name has "rect"
  std::string frame_id;             // coordinate frame of tf_static; empty: that of the messages
  // Size of one unit of depth images. 0: floats are in metres, and integers are in the unit that a RealSense
  // recorded, or else in 0.001 m.
  double depth_unit_m = 0;
};

// Fixed transforms between the coordinate frames of a robot, as in tf_static: each frame has at most one
// parent.

// Removes the leading / that older programs write in front of the name of a frame.
std::string plain_frame(const std::string& frame);

class StaticTransforms {
 public:
  // A frame that is added again gets its new parent and transform. Throws InputError about the subject for
  // more than 10000 frames.
  void add(const std::vector<StampedTransform>& transforms, const std::string& subject = "tf_static");
  // p_to = X * p_from. Throws InputError about the subject when the two are not connected, or a frame is its
  // own ancestor.
  RigidTransform between(const std::string& to, const std::string& from, const std::string& subject) const;

 private:
  struct Parent {
    std::string name;
    RigidTransform X;
  };
  // Returns the transform from the frame to its root, the ancestor without a parent, and writes the root's
  // name. Throws InputError about the subject if a frame is its own ancestor.
  RigidTransform to_root(std::string frame, std::string& root, const std::string& subject) const;

  std::map<std::string, Parent> parent_of_;
};

// Reads sensor_msgs/PointCloud2, Image and CompressedImage (compressedDepth). The first CameraInfo is used
// for all frames, see camera_change(). Integers of depth images are in units of 1 mm, or in the unit that the
// option Depth Units of a RealSense recording states. Floats are metres. BagChoice::depth_unit_m replaces
// these units. All messages must name the same coordinate frame.
//
// The frames are in the order of the stamps in the messages' headers; captured_s counts from the first stamp.
// If several messages have the same stamp, the first one is used. If a stamp is 0, all times are those of the
// recorder. Only one message at a time is in memory. Several threads may read at once.
class BagFrames {
 public:
  // Throws InputError about the path or a topic in these cases: there is no topic of frames or more than one,
  // the chosen topic has no frames, or the camera or the transform is missing or cannot be used. For depth
  // images the constructor reads the first one.
  BagFrames(const std::filesystem::path& path, const BagChoice& choice);

  const std::vector<double>& captured_s() const { return captured_s_; }
  // Stamp of the first frame.
  double first_stamp_s() const { return first_stamp_s_; }
  // Camera of the depth images; all 0 for clouds.
  CameraIntrinsics camera() const { return rays_ ? rays_->camera() : CameraIntrinsics{}; }
  // Pose of the messages' coordinate frame in the chosen one.
  const RigidTransform& pose() const { return X_chosen_; }
  std::string kind() const { return topic().type + " " + topic().name; }
  // Empty, or one line that says what was wrong with the bag and what was done about it.
  const std::string& remark() const { return remark_; }
  // One line that names the first CameraInfo and the first depth unit that differ from those in use. Empty if
  // none differs.
  const std::string& camera_change() const { return camera_change_; }

  // Path, topic and number of the message of a frame, for a message to the user about it.
  std::string name_of(std::size_t frame) const { return subject(topic_, frames_[frame]); }

  // Returns a frame in the coordinate frame of the messages. Pixels of an image whose depth z is above
  // max_depth_m are NaN; the limit does not apply to clouds that are no image. Throws InputError about the
  // message if it cannot be used.
  PointCloud cloud(std::size_t frame, double max_depth_m) const;

 private:
  const BagTopic& topic() const { return bag_->topics()[topic_]; }
  std::string subject(std::size_t topic, const MessagePlace& place) const;
  DepthImage depth_of(const MessagePlace& place, double max_depth_m) const;
  void refuse_image_settings(const BagChoice& choice) const;
  void choose_camera(const BagChoice& choice);
  template <class IsSame>
  void note_changes(std::size_t topic, IsSame&& is_same);
  void choose_unit(double chosen_m);
  void choose_frame_id(const std::string& frame_id);
  void order_frames();
  void check_frame_id(const MessageHeader& header, const std::string& subject) const;

  std::string path_;
  std::unique_ptr<BagFile> bag_;
  std::size_t topic_ = 0;
  std::vector<MessagePlace> frames_;
  std::vector<double> captured_s_;
  double first_stamp_s_ = 0;
  std::optional<ImageRays> rays_;  // only for depth images
  DepthUnits units_;
  std::string frame_id_;  // coordinate frame of the first frame, and so of all
  RigidTransform X_chosen_ = RigidTransform::Identity();
  std::string remark_, camera_change_;
};

}  // namespace remote_touch
