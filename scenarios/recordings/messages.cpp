#include "scenarios/recordings/frames_from_messages.h"

#include <bit>
#include <cmath>

#include "scenarios/files/input_files.h"

namespace remote_touch {

MessageCursor::MessageCursor(std::string_view bytes, WireFormat format, const std::string& subject)
    : bytes_(bytes), format_(format), subject_(subject) {
  if (format_ == WireFormat::ros1) return;
  const std::string_view header = view(4);
  const unsigned kind = static_cast<unsigned char>(header[0]) << 8 | static_cast<unsigned char>(header[1]);
  if (kind > 1) refuse(subject_, "encapsulation = ", kind, ": expected 0 or 1, plain CDR");
  big_endian_ = kind == 0;
  origin_ = at_;
}

std::string_view MessageCursor::view(std::size_t size) {
  if (size > bytes_.size() - at_)
    refuse(subject_, "ends after ", bytes_.size(), " bytes: expected ", size, " more at byte ", at_);
  at_ += size;
  return bytes_.substr(at_ - size, size);
}

std::uint64_t MessageCursor::take(std::size_t size) {
  if (format_ == WireFormat::cdr) view((size - (at_ - origin_) % size) % size);
  const std::string_view stored = view(size);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value = value << 8 | static_cast<unsigned char>(stored[big_endian_ ? i : size - 1 - i]);
  return value;
}

float MessageCursor::f32() {
  return std::bit_cast<float>(u32());
}

double MessageCursor::f64() {
  return std::bit_cast<double>(take(8));
}

std::string MessageCursor::text() {
  std::string_view stored = view(u32());
  if (format_ == WireFormat::cdr && stored.ends_with('\0')) stored.remove_suffix(1);
  return std::string(stored);
}

std::uint32_t MessageCursor::count(std::size_t min_bytes) {
  const std::uint32_t claimed = u32();
  const std::size_t left = bytes_.size() - at_;
  if (claimed > left / min_bytes)
    refuse(subject_, "claims ", claimed, " elements: the ", left, " bytes left hold at most ",
           left / min_bytes);
  return claimed;
}

std::string_view MessageCursor::bytes() {
  return view(u32());
}

namespace {

constexpr std::size_t kMinText = 4;              // its length
constexpr std::size_t kMinField = kMinText + 9;  // name, offset, datatype, count

}  // namespace

std::int64_t read_stamp_ns(MessageCursor& from) {
  std::int64_t seconds = 0;
  if (from.format() == WireFormat::ros1) {
    from.u32();  // the number of the message, which ROS 2 dropped
    seconds = from.u32();
  } else {
    seconds = from.i32();
  }
  return seconds * 1'000'000'000 + from.u32();
}

MessageHeader read_header(MessageCursor& from) {
  MessageHeader header;
  header.stamp_ns = read_stamp_ns(from);
  header.frame_id = from.text();
  return header;
}

PointCloudMessage read_point_cloud(MessageCursor from) {
  PointCloudMessage cloud;
  cloud.header = read_header(from);
  cloud.height = from.u32(), cloud.width = from.u32();
  cloud.fields.resize(from.count(kMinField));
  for (PointField& field : cloud.fields) {
    field.name = from.text(), field.offset = from.u32();
    field.datatype = from.u8(), field.count = from.u32();
  }
  cloud.big_endian = from.u8() != 0;
  cloud.point_step = from.u32(), cloud.row_step = from.u32();
  cloud.data = from.bytes();
  return cloud;
}

ImageMessage read_image(MessageCursor from) {
  ImageMessage image;
  image.header = read_header(from);
  image.height = from.u32(), image.width = from.u32();
  image.encoding = from.text();
  image.big_endian = from.u8() != 0;
  image.step = from.u32();
  image.data = from.bytes();
  return image;
}

CompressedImageMessage read_compressed_image(MessageCursor from) {
  CompressedImageMessage image;
  image.header = read_header(from);
  image.format = from.text();
  image.data = from.bytes();
  return image;
}

CameraInfoMessage read_camera_info(MessageCursor from) {
  CameraInfoMessage camera;
  camera.header = read_header(from);
  camera.height = from.u32(), camera.width = from.u32();
  camera.distortion_model = from.text();
  camera.distortion.resize(from.count(sizeof(double)));
  for (double& d : camera.distortion) d = from.f64();
  for (double& k : camera.K) k = from.f64();
  for (int i = 0; i < 9; ++i) from.f64();  // R is skipped: a rectified image is used as it is
  for (double& p : camera.P) p = from.f64();
  camera.binning_x = from.u32(), camera.binning_y = from.u32();
  for (std::uint32_t* part :
       {&camera.region.x_offset, &camera.region.y_offset, &camera.region.height, &camera.region.width})
    *part = from.u32();
  camera.region.do_rectify = from.u8() != 0;
  return camera;
}

std::vector<StampedTransform> read_transforms(MessageCursor from) {
  constexpr std::size_t kMinTransform = 8 + 2 * kMinText + 7 * sizeof(double);
  std::vector<StampedTransform> transforms(from.count(kMinTransform));
  for (StampedTransform& transform : transforms) {
    transform.parent = read_header(from).frame_id;
    transform.child = from.text();
    Vec3 p;
    for (double* value : {&p.x(), &p.y(), &p.z()}) *value = from.f64();
    Eigen::Quaterniond q;
    for (double* value : {&q.x(), &q.y(), &q.z(), &q.w()}) *value = from.f64();
    if (!p.allFinite() || !(std::abs(q.norm() - 1) < 1e-3))
      refuse(from.subject(), "transform from '", transform.child, "' to '", transform.parent,
             "': expected finite numbers and a quaternion of length 1");
    transform.X = Eigen::Translation3d(p) * q.normalized();
  }
  return transforms;
}

double read_float32(MessageCursor from) {
  return from.f32();
}

}  // namespace remote_touch
