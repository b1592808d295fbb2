// Messages of ROS that come from a depth camera, as they are stored. Only their lengths and the transforms
// are checked.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/points/vector.h"

namespace remote_touch {

// Reads the bytes of one message of ROS, value after value. No length in them is trusted.

// Encoding of a message's values. ROS 2 uses CDR: a header of 4 bytes that states the byte order, then values
// aligned to their size. ROS 1 uses little-endian values without gaps.
enum class WireFormat { cdr, ros1 };

class MessageCursor {
 public:
  // bytes must outlive the cursor and all views that it returns. subject: what an InputError is about. Throws
  // InputError if the header of CDR is missing or of another encoding.
  MessageCursor(std::string_view bytes, WireFormat format, const std::string& subject);

  WireFormat format() const { return format_; }
  const std::string& subject() const { return subject_; }

  // Each reads one value. Throws InputError if the message ends before the value does.
  std::uint8_t u8() { return static_cast<std::uint8_t>(take(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(take(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(take(4)); }
  std::uint64_t u64() { return take(8); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  float f32();
  double f64();
  std::string text();
  // Reads the length of a sequence whose elements have at least min_bytes each. Throws InputError if the
  // bytes left cannot hold as many elements.
  std::uint32_t count(std::size_t min_bytes);
  std::string_view bytes();                 // a sequence of bytes: its length in 32 bits first
  std::string_view view(std::size_t size);  // size bytes as they are
  std::size_t left() const { return bytes_.size() - at_; }

 private:
  std::uint64_t take(std::size_t size);

  std::string_view bytes_;
  WireFormat format_;
  std::string subject_;
  std::size_t at_ = 0, origin_ = 0;
  bool big_endian_ = false;
};

// Maximum number of pixels of an image: 8192 x 8192, 0.5 GB as depths.
inline constexpr std::uint64_t kMaxImagePixels = 1u << 26;

struct MessageHeader {
  std::int64_t stamp_ns = 0;  // time at which the sensor measured; 0: not stated
  std::string frame_id;       // the name of the coordinate frame
};

// sensor_msgs/PointCloud2.
struct PointField {
  std::string name;
  std::uint32_t offset = 0;   // offset of the value within the bytes of a point
  std::uint8_t datatype = 0;  // 1 int8, 2 uint8, 3 int16, 4 uint16, 5 int32, 6 uint32, 7 float32, 8 float64
  std::uint32_t count = 0;
};
struct PointCloudMessage {
  MessageHeader header;
  std::uint32_t height = 0, width = 0;
  std::vector<PointField> fields;
  bool big_endian = false;
  std::uint32_t point_step = 0, row_step = 0;  // bytes
  std::string_view data;
};

// sensor_msgs/Image.
struct ImageMessage {
  MessageHeader header;
  std::uint32_t height = 0, width = 0;
  std::string encoding;
  bool big_endian = false;
  std::uint32_t step = 0;  // bytes of a row
  std::string_view data;
};

// sensor_msgs/CompressedImage.
struct CompressedImageMessage {
  MessageHeader header;
  std::string format;
  std::string_view data;
};

// sensor_msgs/RegionOfInterest: the part of the sensor that the image shows, in pixels without binning. All 0
// means the whole sensor.
struct RegionMessage {
  std::uint32_t x_offset = 0, y_offset = 0, height = 0, width = 0;
  bool do_rectify = false;  // the rectified image shows another region, which is not stated
  bool operator==(const RegionMessage&) const = default;
};

// sensor_msgs/CameraInfo.
struct CameraInfoMessage {
  MessageHeader header;
  std::uint32_t height = 0, width = 0;  // size of the sensor, without binning
  std::string distortion_model;
  std::vector<double> distortion;
  std::array<double, 9> K{};                   // intrinsics of the whole sensor, row by row
  std::array<double, 12> P{};                  // projection of the rectified image of the whole sensor
  std::uint32_t binning_x = 0, binning_y = 0;  // pixels of the sensor that make one of the image; 0: one
  RegionMessage region;
};

// One transform of tf2_msgs/TFMessage: p_parent = X * p_child.
struct StampedTransform {
  std::string parent, child;
  RigidTransform X = RigidTransform::Identity();
};

// Each throws InputError, about the cursor's subject, if the bytes end too early. read_transforms() also
// throws it if a transform is not finite or is no rotation. Views point into the bytes. Bytes behind the last
// value are ignored.
MessageHeader read_header(MessageCursor& from);
std::int64_t read_stamp_ns(MessageCursor& from);  // stamp of a header; kStampBytes of the message are enough
inline constexpr std::size_t kStampBytes = 12;
PointCloudMessage read_point_cloud(MessageCursor from);
ImageMessage read_image(MessageCursor from);
CompressedImageMessage read_compressed_image(MessageCursor from);
CameraInfoMessage read_camera_info(MessageCursor from);
std::vector<StampedTransform> read_transforms(MessageCursor from);
double read_float32(MessageCursor from);  // std_msgs/Float32

}  // namespace remote_touch
