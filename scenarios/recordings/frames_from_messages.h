// Messages of ROS, and the depth images, viewing rays and clouds from them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"

namespace remote_touch {

// Encoding of a message's values. ROS 2 uses CDR: a header of 4 bytes that states the byte order, then values
// aligned to their size. ROS 1 uses little-endian values without gaps.
enum class WireFormat { cdr, ros1 };

// Reads the bytes of one message of ROS, value after value. No length in them is trusted.
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

// Messages of ROS that come from a depth camera, as they are stored. Only their lengths and the transforms
// are checked.

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

// Converts an Image or a CompressedImage to depths.

// Factors that convert the values of a depth image to metres, for integers and for floats.
struct DepthUnits {
  double of_integers_m = 0.001;
  double of_floats_m = 1;
};

// Returns true for the encodings of depth images: integers as 16UC1, mono16 and Z16, floats as 32FC1.
bool is_depth_encoding(const std::string& encoding);
inline constexpr const char* kDepthEncodings = "16UC1, mono16, Z16 or 32FC1";

// Converts an image to depths in metres. A depth that is 0, negative, not finite or beyond max_depth_m
// becomes NaN. Throws InputError about the subject for another encoding, or if the data are shorter than
// height and step claim. At most 2^26 pixels.
DepthImage depth_from_message(const ImageMessage& message, const DepthUnits& units, double max_depth_m,
                              const std::string& subject);

// Converts an image of the transport compressedDepth: 12 bytes (a format, then two floats a and b), then a
// 16-bit PNG. The format "16UC1; ..." holds integers. The format "32FC1; ..." holds integers q: the float is
// a / (q - b), and q = 0 means no measurement. Throws InputError also if the PNG is damaged or of another
// kind.
DepthImage depth_from_message(const CompressedImageMessage& message, const DepthUnits& units,
                              double max_depth_m, const std::string& subject);

// Viewing rays of the pixels of a depth image, from a CameraInfo. They convert a depth image to a cloud.

// Size in pixels of the images of a camera: the size of its region of interest, divided by its binning.
struct ImageSize {
  std::uint32_t width = 0, height = 0;
};
// Throws InputError about the subject, with the name of the field, if the region is not within
// width x height, or if the binning leaves no pixel.
ImageSize image_size(const CameraInfoMessage& info, const std::string& subject);

// Binning by b: pixel u of the image covers the pixels b u + x_offset to b u + x_offset + b - 1 of the
// sensor, and its ray is that of their mean position. Therefore fx = K[0] / b and cx =
// (K[2] - x_offset - (b - 1) / 2) / b, the same along y, with P instead of K if rectified.
//
// An image as measured has rays that its lens bends (plumb bob: k1, k2, p1, p2, k3). A rectified image is
// that of a pinhole. So is an image whose coefficients are all 0, unless the lens is a fisheye (equidistant).
// The points of a bending lens are those of the measured pixels, on their true rays, in the order of a
// pinhole image with the intrinsics K: each of its pixels has the point whose ray passes nearest, within
// pixel_slack. A pixel near the edge may have no point, and where the lens shrinks the image two pixels may
// have the same point.
class ImageRays {
 public:
  // rectified: the image was undistorted before it was recorded, and its intrinsics are P. Throws InputError
  // about the subject in these cases:
  // - image_size() refuses the region or the binning, or the image has no pixel or more than kMaxImagePixels;
  // - the intrinsics are not finite, the focal lengths are not within 1e-6 to 1e6 px, or the centre is 1e6 px
  //   or more away;
  // - the lens is of another model;
  // - K or P is not (fx 0 cx; 0 fy cy; 0 0 1): it has skew, or P has P[3] or P[7] of the second camera of a
  //   stereo pair, whose points are in the frame of the first camera;
  // - a rectified image shows another region (do_rectify).
  ImageRays(const CameraInfoMessage& info, bool rectified, const std::string& subject);

  const CameraIntrinsics& camera() const { return camera_; }
  bool has_distortion() const { return !source_.empty(); }
  // Returns the cloud in the camera frame: x right, y down, z forward. Pre: the image has the camera's size.
  PointCloud cloud(const DepthImage& depth) const;

 private:
  void make_table(const CameraInfoMessage& info);

  CameraIntrinsics camera_;
  // One entry for each pixel of the pinhole image: index of the measured pixel (-1: none), and the ray of the
  // measured pixel with z = 1. Empty if the lens does not bend the rays.
  std::vector<int> source_;
  std::vector<double> ray_x_, ray_y_;
  double slack_ = 0;
};

// Reads the points of a PointCloud2 with any layout of its fields. Reads the fields x, y, z (float32 or
// float64, metres) and, if present, rgb or rgba (4 bytes, 0xAARRGGBB). Alpha is dropped, but see
// colour_of_float() for rgb as float32. Other fields are skipped. The message's frame is the world frame. A
// point with a coordinate that is not finite, or at exactly (0, 0, 0), is a missing measurement: it keeps its
// index, and its three coordinates are NaN.
//
// height > 1: the cloud is organised. It gets cloud.image if a pinhole camera explains it, as for a PCD file.
// height = 1: the points are in no order.
//
// Throws InputError about the subject when a field is missing, of another type or of several values, or the
// data are shorter than width, height and steps claim. At most 2^24 points.
PointCloud cloud_from_message(const PointCloudMessage& message, const std::string& subject);

}  // namespace remote_touch
