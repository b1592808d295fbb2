// Tests the decoding of ROS messages, and which are refused. Other writers' messages are tested in
// tests/system/bags.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "core/points/point_cloud.h"
#include "scenarios/recordings/frames_from_messages.h"
#include "tests/support/bag_files.h"
#include "tests/support/test_files.h"

namespace remote_touch::messages_test {
namespace {

using Format = MessageBytes::Format;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
constexpr std::int64_t kStamp_ns = 1'700'000'000'123'456'789;

WireFormat wire(Format format) {
  return format == Format::ros1 ? WireFormat::ros1 : WireFormat::cdr;
}

PointCloud cloud_of(const std::string& bytes, Format format = Format::cdr) {
  return cloud_from_message(read_point_cloud({bytes, wire(format), "m"}), "m");
}

TEST(Messages, HaveTheSameCloudInEveryFormat) {
  for (const Format format : {Format::cdr, Format::cdr_big_endian, Format::ros1}) {
    const std::string bytes = cloud_message(format, kStamp_ns, 5, 4, 2, "eye");
    const PointCloudMessage message = read_point_cloud({bytes, wire(format), "m"});
    EXPECT_EQ(message.header.stamp_ns, kStamp_ns);
    EXPECT_EQ(message.header.frame_id, "eye");
    const PointCloud cloud = cloud_from_message(message, "m");
    ASSERT_EQ(cloud.size(), 20u);
    EXPECT_TRUE(cloud.point(0).isApprox(Vec3(-0.4, -0.3, 2), 1e-6));
    EXPECT_TRUE(cloud.point(19).isApprox(Vec3(0.4, 0.3, 2), 1e-6));
    ASSERT_TRUE(cloud.image);
    EXPECT_NEAR(cloud.image->camera.fx, 10, 1e-4);
    EXPECT_NEAR(cloud.image->camera.cy, 1.5, 1e-4);
    EXPECT_EQ(cloud.grid_columns, 5);
  }
}

// A message that is cut at any byte is refused in one line.
TEST(Messages, RefuseEveryShorterMessage) {
  for (const Format format : {Format::cdr, Format::ros1}) {
    const std::string bytes = cloud_message(format, 1, 3, 2, 1);
    for (std::size_t size = 0; size + 1 < bytes.size(); ++size) {
      const std::string cut = bytes.substr(0, size);
      EXPECT_HAS(refusal([&] { cloud_of(cut, format); }), "m: ");
    }
  }
  const std::string camera = camera_message(4, 3, {0.1, 0, 0, 0, 0});
  for (std::size_t size = 0; size < camera.size(); ++size)
    EXPECT_HAS(refusal([&] { read_camera_info({camera.substr(0, size), WireFormat::cdr, "m"}); }), "m: ");
}

TEST(Messages, DoNotTrustLengths) {
  std::string bytes = cloud_message(Format::ros1, 1, 3, 2, 1, "");
  bytes.replace(16, 8, std::string(8, '\xff'));  // height and width
  EXPECT_HAS(refusal([&] { cloud_of(bytes, Format::ros1); }), "points: expected up to");
  bytes.replace(24, 4, std::string("\xff\xff\xff\x7f"));  // the number of fields
  EXPECT_HAS(refusal([&] { cloud_of(bytes, Format::ros1); }), "claims 2147483647 elements");
  EXPECT_HAS(refusal([&] { cloud_of(std::string("\1\2\0\0", 4)); }), "encapsulation = 258");
}

PointCloudMessage four_points() {
  PointCloudMessage message;
  message.height = 1, message.width = 4, message.point_step = 16, message.row_step = 64;
  message.fields = {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}, {"rgb", 12, 7, 1}};
  return message;
}

TEST(Messages, MarkMissingPointsAndKeepColours) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::string data;
  for (const auto& p :
       {std::array{1.0f, 2.0f, 3.0f}, {0.0f, 0.0f, 0.0f}, {1.0f, nan, 3.0f}, {0.0f, 0.0f, 4.0f}})
    data += raw(p) + raw(std::uint32_t{0xFF123456});
  PointCloudMessage message = four_points();
  message.data = data;
  const PointCloud cloud = cloud_from_message(message, "m");
  EXPECT_EQ(cloud.point(0), Vec3(1, 2, 3));
  EXPECT_TRUE(cloud.point(1).array().isNaN().all());
  EXPECT_TRUE(cloud.point(2).array().isNaN().all());
  EXPECT_EQ(cloud.point(3), Vec3(0, 0, 4));
  EXPECT_EQ(cloud.colour, std::vector<std::uint32_t>(4, 0x123456));
  EXPECT_FALSE(cloud.image);
  EXPECT_EQ(cloud.grid_columns, 0);
}

// 0x7FC00000 is the NaN that C++ and NumPy write, and is no colour. The NaN of an opaque colour is a colour.
TEST(Messages, HaveNoColourWhereItIsNan) {
  std::string data;
  for (const std::uint32_t rgb : {0x00112233u, 0x7FC00000u, 0xFFFF0000u, 0x4A808060u})
    data += raw(std::array{1.0f, 2.0f, 3.0f}) + raw(rgb);
  PointCloudMessage message = four_points();
  message.data = data;
  EXPECT_EQ(cloud_from_message(message, "m").colour,
            (std::vector<std::uint32_t>{0x112233, kNoColour, 0xFF0000, kNoColour}));
  message.fields[3].datatype = 6;  // an integer is never NaN
  EXPECT_EQ(cloud_from_message(message, "m").colour,
            (std::vector<std::uint32_t>{0x112233, 0xC00000, 0xFF0000, 0x808060}));
}

TEST(Messages, RefuseCloudsThatDoNotFitTogether) {
  const std::string data(64, '\1');
  const auto error = [&](auto change) {
    PointCloudMessage message = four_points();
    message.data = data;
    change(message);
    return refusal([&] { cloud_from_message(message, "m"); });
  };
  EXPECT_HAS(error([](auto& m) { m.fields[1].name = "yy"; }), "has no field y");
  EXPECT_HAS(error([](auto& m) { m.fields[2].datatype = 6; }), "field z has datatype 6: expected 7");
  EXPECT_HAS(error([](auto& m) { m.fields[2].offset = 13; }), "field z ends at byte 17");
  EXPECT_HAS(error([](auto& m) { m.fields[2].offset = 0xFFFFFFFF; }), "field z ends at byte 4294967299");
  EXPECT_HAS(error([](auto& m) { m.fields[3].datatype = 8; }), "field rgb has datatype 8");
  EXPECT_HAS(error([](auto& m) { m.fields[0].count = 3; }), "field x has 3 values a point: expected 1");
  EXPECT_HAS(error([](auto& m) { m.fields[3].count = 2; }), "field rgb has 2 values a point");
  EXPECT_EQ(error([](auto& m) { m.fields[0].count = 0; }), "no InputError") << "some write 0 for one";
  EXPECT_HAS(error([](auto& m) { m.width = 5; }), "has 64 bytes of data: expected 80");
  EXPECT_HAS(error([](auto& m) { m.height = 4, m.width = 1, m.row_step = 8; }), "row_step = 8: expected 16");
}

// A cloud with 0 columns or 0 rows has no points, however large the other number is.
TEST(Messages, HaveNoPointsWithoutColumns) {
  PointCloudMessage message = four_points();
  message.width = 0, message.height = 0xFFFFFFFF;
  EXPECT_EQ(cloud_from_message(message, "m").size(), 0u);
  message.width = 0xFFFFFFFF, message.height = 0;
  EXPECT_EQ(cloud_from_message(message, "m").size(), 0u);
}

ImageMessage image(const std::string& encoding, std::uint32_t step, const std::string& data) {
  ImageMessage message;
  message.height = 1, message.width = 2, message.encoding = encoding, message.step = step,
  message.data = data;
  return message;
}

TEST(Messages, ReadDepthInMillimetresAndMetres) {
  const std::string units = raw(std::uint16_t{1500}) + raw(std::uint16_t{0});
  DepthImage depth = depth_from_message(image("16UC1", 4, units), {}, kNoLimit, "m");
  EXPECT_EQ(depth.z_m[0], 1.5);
  EXPECT_TRUE(std::isnan(depth.z_m[1]));
  EXPECT_TRUE(std::isnan(depth_from_message(image("mono16", 4, units), {}, 1.4, "m").z_m[0]));
  ImageMessage turned = image("16UC1", 4, units);
  turned.big_endian = true;
  EXPECT_EQ(depth_from_message(turned, {1, 1}, kNoLimit, "m").z_m[0], 0xDC05);
  for (const float missing : {-1.0f, 0.0f, std::numeric_limits<float>::infinity(), std::nanf("")}) {
    const std::string metres = raw(1.25f) + raw(missing);
    depth = depth_from_message(image("32FC1", 8, metres), {}, kNoLimit, "m");
    EXPECT_EQ(depth.z_m[0], 1.25);
    EXPECT_TRUE(std::isnan(depth.z_m[1])) << missing;
  }
  EXPECT_EQ(depth_from_message(image("16UC1", 4, units), {0.01, 2}, kNoLimit, "m").z_m[0], 15);
  EXPECT_EQ(depth_from_message(image("32FC1", 8, raw(1.25f) + raw(1.0f)), {0.01, 2}, kNoLimit, "m").z_m[0],
            2.5);
  EXPECT_HAS(refusal([&] { depth_from_message(image("rgb8", 6, units), {}, 1, "m"); }),
             "encoding = \"rgb8\"");
  EXPECT_HAS(refusal([&] { depth_from_message(image("16UC1", 3, units), {}, 1, "m"); }),
             "step = 3: expected 4");
  EXPECT_HAS(refusal([&] { depth_from_message(image("32FC1", 8, units), {}, 1, "m"); }),
             "has 4 bytes of data");
}

TEST(Messages, ReadCompressedDepth) {
  const TestFolder folder("messages_test");
  const std::uint16_t values[] = {0, 51, 101, 1001};
  const std::string png = bytes_of(folder.write_png("q.png", 2, 2, PNG_FORMAT_LINEAR_Y, values));
  CompressedImageMessage message;
  const std::string data = raw(0) + raw(100.0f) + raw(1.0f) + png;
  message.data = data, message.format = "32FC1; compressedDepth png";
  DepthImage depth = depth_from_message(message, {}, kNoLimit, "m");
  ASSERT_EQ(depth.z_m.size(), 4u);
  EXPECT_TRUE(std::isnan(depth.z_m[0]));
  EXPECT_EQ(depth.z_m[1], 2);
  EXPECT_EQ(depth.z_m[2], 1);
  EXPECT_EQ(depth.z_m[3], 0.1);
  EXPECT_EQ(depth_from_message(message, {0.01, 2}, kNoLimit, "m").z_m[1], 4);
  message.format = "16UC1; compressedDepth";
  EXPECT_EQ(depth_from_message(message, {}, kNoLimit, "m").z_m[3], 1001 * 0.001);
  const auto error = [&](const std::string& format, std::string_view bytes) {
    message.format = format, message.data = bytes;
    return refusal([&] { depth_from_message(message, {}, kNoLimit, "m"); });
  };
  EXPECT_HAS(error("16UC1; compressedDepth rvl", data), "with PNG inside");
  EXPECT_HAS(error("rgb8; jpeg compressed bgr8", data), "expected \"16UC1; compressedDepth\"");
  EXPECT_HAS(error("16UC1; compressedDepth", std::string_view(data).substr(0, 11)), "header of 12 bytes");
  EXPECT_HAS(error("16UC1; compressedDepth", std::string_view(data).substr(0, 12)), "no byte of an image");
  EXPECT_HAS(error("16UC1; compressedDepth", std::string_view(data).substr(0, data.size() - 9)),
             "not a whole PNG");
}

CameraInfoMessage info(int width, int height, const std::vector<double>& distortion,
                       const std::string& model = "plumb_bob") {
  static std::string bytes;
  bytes = camera_message(width, height, distortion, model);
  return read_camera_info({bytes, WireFormat::cdr, "m"});
}

// The published formula of the plumb bob: returns the ray to which the lens bends the ray through p.
std::array<double, 2> bent(const Vec3& p, const std::vector<double>& d) {
  const double x = p.x() / p.z(), y = p.y() / p.z(), r2 = x * x + y * y;
  const double radial = 1 + d[0] * r2 + d[1] * r2 * r2 + d[4] * r2 * r2 * r2;
  return {x * radial + 2 * d[2] * x * y + d[3] * (r2 + 2 * x * x),
          y * radial + d[2] * (r2 + 2 * y * y) + 2 * d[3] * x * y};
}

// Each depth identifies its pixel. The lens must bend every point to the centre of the pixel that it is from,
// and the point must lie within pixel_slack of its pixel in the pinhole image.
TEST(Messages, PutPointsOnTheRaysOfALens) {
  const std::vector<double> d = {-0.25, 0.08, 0.002, -0.003, -0.01};
  constexpr int kWidth = 12, kHeight = 9;
  const ImageRays rays(info(kWidth, kHeight, d), false, "m");
  DepthImage depth{kWidth, kHeight, {}};
  for (int i = 0; i < kWidth * kHeight; ++i) depth.z_m.push_back(1 + i * 0.01);
  const PointCloud cloud = rays.cloud(depth);
  ASSERT_TRUE(cloud.image);
  EXPECT_LT(cloud.image->pixel_slack, 1.1);
  int points = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!cloud.is_measured(i)) continue;
    const int source = static_cast<int>(std::lround((cloud.z[i] - 1) / 0.01));
    const auto [x, y] = bent(cloud.point(i), d);
    EXPECT_NEAR(10 * x + 5.5, source % kWidth, 1e-9);
    EXPECT_NEAR(10 * y + 4, source / kWidth, 1e-9);
    const double u = 10 * cloud.x[i] / cloud.z[i] + 5.5, v = 10 * cloud.y[i] / cloud.z[i] + 4;
    EXPECT_LE(std::abs(u - static_cast<double>(i % kWidth)), cloud.image->pixel_slack);
    EXPECT_LE(std::abs(v - static_cast<double>(i / kWidth)), cloud.image->pixel_slack);
    ++points;
  }
  EXPECT_EQ(points, kWidth * kHeight) << "a lens that shrinks shows more than the pinhole";
}

TEST(Messages, UseTheCameraThatFitsTheImage) {
  const DepthImage depth{3, 1, {2, 2, 2}};
  const PointCloud measured = ImageRays(info(3, 1, {}), false, "m").cloud(depth);
  EXPECT_TRUE(measured.point(2).isApprox(Vec3(0.2, 0, 2)));
  EXPECT_LE(measured.image->pixel_slack, 1e-6);
  const PointCloud rectified = ImageRays(info(3, 1, {0.1, 0, 0, 0, 0}), true, "m").cloud(depth);
  EXPECT_TRUE(rectified.point(2).isApprox(Vec3(0.1, 0, 2)));
  for (const char* model : {"", "None", "pinhole", "plumb_bob", "rational_polynomial", "Brown Conrady"}) {
    EXPECT_FALSE(ImageRays(info(3, 1, {0, 0, 0, 0, 0}, model), false, "m").has_distortion()) << model;
    EXPECT_FALSE(ImageRays(info(3, 1, {}, model), false, "m").has_distortion()) << model;
  }
}

TEST(Messages, RefuseWrongCamerasAndImagesThatAreNotClear) {
  const auto error = [](const CameraInfoMessage& camera, bool rectified) {
    return refusal([&] { ImageRays(camera, rectified, "m"); });
  };
  struct Row {
    std::function<void(CameraInfoMessage&)> change;
    std::string text;  // empty: none
    bool rectified = false;
  };
  const auto cropped = [](const RegionMessage& region) {
    return [region](CameraInfoMessage& c) { c.region = region; };
  };
  const auto bent_by = [](const std::vector<double>& distortion) {
    return [distortion](CameraInfoMessage& c) { c.distortion = distortion; };
  };
  const Row rows[] = {
      {[](auto& c) { c.width = 0; }, "has 0 x 4 pixels"},
      {[](auto& c) { c.K[0] = 0; }, "expected a calibrated camera"},
      {[](auto& c) { c.K[0] = 1e-6; }, "expected a calibrated camera"},  // rays would be infinite
      {[](auto& c) { c.K[5] = std::nan(""); }, "expected a calibrated camera"},
      {[](auto& c) { c.K[1] = 20; }, "m: K[1] = 20.000000: expected 0, a camera without skew"},
      {[](auto& c) { c.K[1] = 20; }, "", true},  // the image has the camera P
      {[](auto& c) { c.K[3] = std::nan(""); }, "m: K[3] = nan: expected 0"},
      {[](auto& c) { c.K[8] = 2; }, "m: K[8] = 2.000000: expected 1"},
      {[](auto& c) { c.K[8] = 0; }, ""},
      {[](auto& c) { c.P[3] = -15; }, "m: P[3] = -15.000000: expected 0, the camera of the", true},
      {[](auto& c) { c.P[7] = 1; }, "m: P[7] = 1.000000: expected 0", true},
      {[](auto& c) { c.P[1] = 1; }, "m: P[1] = 1.000000: expected 0, a camera without skew", true},
      {[](auto& c) { c.P[3] = -15, c.P[1] = 1; }, ""},  // the image has the camera K
      {cropped({3, 0, 4, 4, false}), "m: roi has pixels 3 to 7 along x"},
      {cropped({0, 0xFFFFFFFF, 2, 6, false}), "to 4294967297 along y: expected"},
      {cropped({1, 0, 4, 0, false}), "m: roi has pixels 1 to 1 along x"},
      {[](auto& c) { c.binning_x = 7; }, "m: binning = 7 x 1: expected no more than"},
      {cropped({1, 1, 2, 2, true}), "m: roi.do_rectify = true", true},
      {cropped({1, 1, 2, 2, true}), ""},
      {bent_by({0.1, 0, 0}), "with 3 coefficients"},
      {bent_by({std::nan(""), 0, 0, 0}), "finite"},
      {[](auto& c) { c.distortion_model = "equidistant"; }, "", true},  // the image is that of a pinhole
  };
  for (const Row& row : rows) {
    CameraInfoMessage camera = info(6, 4, {});
    row.change(camera);
    EXPECT_HAS(error(camera, row.rectified), row.text.empty() ? "no InputError" : row.text);
  }
  for (const char* fisheye : {"equidistant", "fisheye", "Kannala Brandt4", "Ftheta", "thin_prism_fisheye"})
    for (const std::vector<double>& none : {std::vector<double>(4, 0.0), std::vector<double>()})
      EXPECT_HAS(error(info(3, 2, none, fisheye), false), std::string("distortion_model = \"") + fisheye);
}

TEST(Messages, ReadBinningAndRegion) {
  std::string bytes = camera_message(4, 3);
  const std::size_t at = bytes.size() - 25;
  for (std::uint32_t i = 0; i < 6; ++i) bytes.replace(at + 4 * i, 4, raw(10 + i));
  bytes.back() = 1;
  const CameraInfoMessage camera = read_camera_info({bytes, WireFormat::cdr, "m"});
  EXPECT_EQ(camera.binning_x, 10u);
  EXPECT_EQ(camera.binning_y, 11u);
  EXPECT_EQ(camera.region, (RegionMessage{12, 13, 14, 15, true}));
}

// A pixel has the ray of the mean position of the sensor's pixels that it covers. The test averages them one
// by one.
TEST(Messages, UseBinningAndRegionOfACamera) {
  CameraInfoMessage camera = info(16, 12, {});
  camera.binning_x = 2, camera.binning_y = 3;
  camera.region = {3, 2, 9, 8, false};
  EXPECT_EQ(image_size(camera, "m").width, 4u);
  EXPECT_EQ(image_size(camera, "m").height, 3u);
  for (const bool rectified : {false, true}) {
    const double f = rectified ? 20 : 10;
    const PointCloud cloud = ImageRays(camera, rectified, "m").cloud({4, 3, std::vector<double>(12, 2.0)});
    for (int i = 0; i < 12; ++i) {
      double u = 0, v = 0;
      for (int pixel = 0; pixel < 6; ++pixel) {
        u += (3 + i % 4 * 2 + pixel % 2) / 6.0;
        v += (2 + i / 4 * 3 + pixel / 2) / 6.0;
      }
      const Vec3 seen(2 * (u - 7.5) / f, 2 * (v - 5.5) / f, 2);
      EXPECT_LT((cloud.point(static_cast<std::size_t>(i)) - seen).norm(), 1e-12) << i;
    }
  }
  camera.region = {};
  camera.binning_x = camera.binning_y = 1;
  EXPECT_EQ(ImageRays(camera, false, "m").camera().cx, 7.5);
  EXPECT_EQ(ImageRays(camera, false, "m").camera().width, 16);
}

// A lens that folds the image over gives no points beyond the fold.
TEST(Messages, HaveNoPointsBeyondTheFoldOfALens) {
  const ImageRays rays(info(40, 40, {-1.5, 0, 0, 0, 0}), false, "m");
  const PointCloud cloud = rays.cloud({40, 40, std::vector<double>(1600, 1.0)});
  EXPECT_FALSE(cloud.is_measured(0));
  EXPECT_TRUE(cloud.is_measured(20 * 40 + 20));
}

}  // namespace
}  // namespace remote_touch::messages_test
