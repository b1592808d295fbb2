#include "scenarios/recordings/bags/messages.h"

#include <cmath>

#include "scenarios/text_files/refuse.h"

namespace remote_touch {
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
