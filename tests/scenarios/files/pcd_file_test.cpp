// Files of point clouds: what the format allows, the camera that is fitted to the points, where it is, and
// what is refused.
#include "scenarios/files/depth_images.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "core/points/point_cloud.h"
#include "tests/support/test_files.h"

namespace remote_touch::pcd_file_test {
namespace {

namespace fs = std::filesystem;

class PcdFile : public ::testing::Test {
 protected:
  PcdCloud read(const std::string& bytes) { return read_pcd(folder_.write("cloud.pcd", bytes)); }

  // Returns the message of the refusal, which must name the file.
  std::string error(const std::string& bytes) {
    std::string text = refusal([&] { read(bytes); });
    EXPECT_EQ(text.rfind((folder_ / "cloud.pcd").string() + ":", 0), 0u) << text;
    return text;
  }

  const TestFolder folder_{"pcd_file_test"};
};

void expect_three_points(const PcdCloud& read) {
  ASSERT_EQ(read.cloud.size(), 3u);
  EXPECT_EQ(std::pair(read.width, read.height), std::pair(3, 1));
  EXPECT_FALSE(read.cloud.image);
  EXPECT_EQ(read.cloud.point(0), Vec3(0.1f, -0.25f, 1.5f));
  EXPECT_EQ(read.cloud.point(1), Vec3(1e-3f, 2, 3));
  EXPECT_TRUE(read.cloud.point(2).array().isNaN().all());
}

TEST_F(PcdFile, AsciiBinaryAndCompressedAreTheSameBits) {
  expect_three_points(read(xyz_header("3", "ascii") + "0.1 -0.25 1.5\n1e-3 +2 3\nnan 1 1\n"));
  const float points[3][3] = {{0.1f, -0.25f, 1.5f}, {1e-3f, 2, 3}, {NAN, 1, 1}};
  std::string by_point, by_field;
  for (int i = 0; i < 9; ++i) by_point += raw(points[i / 3][i % 3]), by_field += raw(points[i % 3][i / 3]);
  expect_three_points(read(xyz_header("3", "binary") + by_point));
  expect_three_points(read(xyz_header("3", "binary") + by_point + std::string(100, '\0')));  // padding
  expect_three_points(read(xyz_header("3", "binary_compressed") + compressed(lzf_literals(by_field), 36)));
}

TEST_F(PcdFile, ExpandsBackReferences) {
  // x = y = z = 1 for four points: 4 literal bytes, a long reference (distance 4, length 2 + 7 + 31 = 40),
  // then a short one (distance 8, length 4).
  const std::string block = "\x03" + raw(1.0f) + "\xe0\x1f\x03" + "\x40\x07";
  const PcdCloud four = read(xyz_header("4", "binary_compressed") + compressed(block, 48));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(four.cloud.point(i), Vec3(1, 1, 1)) << i;
  // A distance of more than 256 uses the low 5 bits of the control byte: 100 points, x = 0..99, y = z = x.
  std::string x;
  for (int i = 0; i < 100; ++i) x += raw(static_cast<float>(i + 1));
  std::string far = lzf_literals(x);
  for (int k = 0; k < 100; ++k) far += std::string("\xc1\x8f", 2);  // length 8, distance 256 + 0x8f + 1 = 400
  const PcdCloud hundred = read(xyz_header("100", "binary_compressed") + compressed(far, 1200));
  for (int i = 0; i < 100; ++i) EXPECT_EQ(hundred.cloud.point(i), Vec3(i + 1, i + 1, i + 1)) << i;
}

TEST_F(PcdFile, SkipsOtherFieldsAndReadsDoubles) {
  const std::string head = "label y histogram x z rgba";
  const auto expect = [](const PcdCloud& read) {
    ASSERT_EQ(read.cloud.size(), 2u);
    EXPECT_EQ(read.cloud.point(0), Vec3(0.1, 0.2, 0.3f));
    EXPECT_EQ(read.cloud.point(1), Vec3(0.4, 0.5, 0.6f));
    EXPECT_EQ(read.cloud.colour, (std::vector<std::uint32_t>{0x010203, 0xFFFEFD}));
  };
  const std::string size = "1 8 2 8 4 4", type = "U F I F F U", count = "1 1 3 1 1 1";
  const std::string hist(6, 'h'), l = "l";
  const auto row = [&](double x, double y, float z, std::uint32_t c) {
    return l + raw(y) + hist + raw(x) + raw(z) + raw(c);
  };
  expect(read(pcd_header(head, size, type, count, "2", "1", "2", "binary") + row(0.1, 0.2, 0.3f, 0x010203) +
              row(0.4, 0.5, 0.6f, 0xFFFFFEFD)));
  const std::string columns = l + l + raw(0.2) + raw(0.5) + hist + hist + raw(0.1) + raw(0.4) + raw(0.3f) +
                              raw(0.6f) + raw(std::uint32_t{0x010203}) + raw(std::uint32_t{0xFFFFFEFD});
  expect(read(pcd_header(head, size, type, count, "2", "1", "2", "binary_compressed") +
              compressed(lzf_literals(columns), static_cast<std::uint32_t>(columns.size()))));
  expect(read(pcd_header(head, size, type, count, "2", "1", "2", "ascii") +
              "1 0.2 7 8 9 0.1 0.3 66051\r\n\n1 0.5 a b c 0.4 0.6 4294967037\n"));
}

TEST_F(PcdFile, ReadsTheColourOfAFloatField) {
  const std::uint32_t colour = 0x00A1B2C3;
  char digits[64];
  std::snprintf(digits, sizeof digits, "%.9g", static_cast<double>(std::bit_cast<float>(colour)));
  const auto head = [](const std::string& data) {
    return pcd_header("x y z rgb", "4 4 4 4", "F F F F", "1 1 1 1", "1", "1", "1", data);
  };
  EXPECT_EQ(read(head("ascii") + "1 2 3 " + digits + "\n").cloud.colour.at(0), 0xA1B2C3u);
  const std::string point = raw(1.f) + raw(2.f) + raw(3.f) + raw(colour);
  EXPECT_EQ(read(head("binary") + point).cloud.colour.at(0), 0xA1B2C3u);
}

// A float whose bits hold no colour, or that has lost digits, gives kNoColour.
TEST_F(PcdFile, HasNoColourIfTheWordHoldsNone) {
  const auto colour = [&](const char* type, const char* word) {
    const std::string types = std::string("F F F ") + type;
    return read(pcd_header("x y z rgb", "4 4 4 4", types, "1 1 1 1", "1", "1", "1", "ascii") + "1 2 3 " +
                word + "\n")
        .cloud.colour.at(0);
  };
  for (const char* none : {"nan", "-nan", "inf", "4.2108e+06", "0.5"})
    EXPECT_EQ(colour("F", none), kNoColour) << none;
  EXPECT_EQ(colour("F", "4210752"), 0x404040u);     // the value of 0x404040, not its bits
  EXPECT_EQ(colour("F", "4278255615"), 0x00FFFFu);  // 0xFF00FFFF
  EXPECT_EQ(colour("F", "0"), 0u);
  EXPECT_EQ(colour("U", "nan"), kNoColour);
  EXPECT_EQ(colour("U", "6.605100000000000000e+04"), 0x010203u);
  EXPECT_EQ(colour("I", "-16777216"), 0u);
  EXPECT_HAS(refusal([&] { colour("U", "12.5"); }), "'12.5': expected a 32-bit colour");

  const auto binary = [&](const char* type, std::uint32_t bits) {
    const std::string types = std::string("F F F ") + type;
    return read(pcd_header("x y z rgb", "4 4 4 4", types, "1 1 1 1", "1", "1", "1", "binary") + raw(1.f) +
                raw(2.f) + raw(3.f) + raw(bits))
        .cloud.colour.at(0);
  };
  EXPECT_EQ(binary("F", 0x7FC00000), kNoColour);
  EXPECT_EQ(binary("F", 0xFFFF0000), 0xFF0000u) << "opaque, as PCL writes it, though it is a NaN";
  EXPECT_EQ(binary("U", 0x7FC00000), 0xC00000u);
}

TEST_F(PcdFile, AcceptsOlderVersions) {
  const std::string layout = "\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  const std::string rest = "WIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 2 3";
  for (const char* version : {"0.7", ".7", "0.6", ".6", "0.5", ".5"})
    EXPECT_EQ(read("VERSION " + (version + layout) + rest).cloud.point(0), Vec3(1, 2, 3)) << version;
  EXPECT_EQ(
      read("VERSION .5\nCOLUMNS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 1\nDATA ascii\n1 2 3").cloud.point(0),
      Vec3(1, 2, 3));
  EXPECT_HAS(error("VERSION .5" + layout + "WIDTH 1\nPOINTS 1\nDATA ascii\n1 2 3"), "no HEIGHT entry");
}

TEST_F(PcdFile, FitsTheCameraOfAnOrganisedCloud) {
  const CameraIntrinsics camera{16, 12, 20, 25, 7.25, 5.5};
  const PcdCloud result = read(organised_pcd(camera, 0));
  EXPECT_EQ(std::pair(result.width, result.height), std::pair(16, 12));
  for (const int hole : {0, 5, 7}) EXPECT_TRUE(result.cloud.point(hole).array().isNaN().all()) << hole;
  ASSERT_TRUE(result.cloud.image);
  const ImageLayout& image = *result.cloud.image;
  EXPECT_EQ(std::pair(image.camera.width, image.camera.height), std::pair(16, 12));
  EXPECT_NEAR(image.camera.fx, 20, 1e-4);
  EXPECT_NEAR(image.camera.fy, 25, 1e-4);
  EXPECT_NEAR(image.camera.cx, 7.25, 1e-4);
  EXPECT_NEAR(image.camera.cy, 5.5, 1e-4);
  EXPECT_TRUE(image.X_WC.matrix().isIdentity(0));
  // The slack holds for every point, and is not much larger than float rounding makes it.
  EXPECT_LT(image.pixel_slack, 1e-4);
  for (int i = 0; i < 16 * 12; ++i) {
    const Vec3 p = result.cloud.point(i);
    const int u = i % 16, v = i / 16;
    if (std::isnan(p.z())) continue;
    EXPECT_LE(std::abs(image.camera.fx * p.x() / p.z() + image.camera.cx - u), image.pixel_slack) << i;
    EXPECT_LE(std::abs(image.camera.fy * p.y() / p.z() + image.camera.cy - v), image.pixel_slack) << i;
  }
}

TEST_F(PcdFile, GivesNoCameraWhereTheFitFails) {
  const CameraIntrinsics camera{16, 12, 20, 25, 7.25, 5.5};
  const auto slightly_off = read(organised_pcd(camera, 0.3)).cloud.image;
  ASSERT_TRUE(slightly_off);
  EXPECT_GT(slightly_off->pixel_slack, 0.2);
  EXPECT_FALSE(read(organised_pcd(camera, 0.8)).cloud.image);                      // one point off its pixel
  EXPECT_FALSE(read(organised_pcd({16, 12, -20, 25, 7.25, 5.5}, 0)).cloud.image);  // mirrored
  const std::string two_by_two = pcd_header("x y z", "4 4 4", "F F F", "1 1 1", "2", "2", "4", "ascii");
  EXPECT_FALSE(read(two_by_two + "0 0 1\nnan 0 1\n0 1 1\n nan 0 1\n").cloud.image);  // one column only
  EXPECT_FALSE(read(two_by_two + "nan 0 1\nnan 0 1\nnan 1 1\n nan 0 1\n").cloud.image);
  EXPECT_FALSE(read(two_by_two + "0 0 1\n1 0 1\n0 1 1\n1 1 -1\n").cloud.image);  // behind the camera
  EXPECT_TRUE(read(two_by_two + "-1 -1 1\n1 -1 1\n-1 1 1\n1 1 1\n").cloud.image);
}

// One row for each refusal: the file, and what is wrong in it.
TEST_F(PcdFile, RefusesBadHeadersSizesAndData) {
  const auto one = [](const auto&... layout) { return pcd_header(layout..., "1", "1", "1", "ascii"); };
  const auto sized = [](const auto&... sizes) {
    return pcd_header("x y z", "4 4 4", "F F F", "1 1 1", sizes...);
  };
  const std::string much = "4000000000", nines(23, '9');  // more than an int holds, and than any integer
  const std::string all = "2147483647", two_points = xyz_header("2", "ascii");  // 11 header lines
  std::vector<std::pair<std::string, std::string>> rows = {
      {"", "no VERSION entry"},
      {"hello\n", ":1: 'hello' is not a PCD header entry: expected VERSION FIELDS"},
      {std::string("\x89PNG\x01\x02") + std::string(100, '\xff'), "'?PNG??"},
      {"VERSION 0.8\n", "VERSION = '0.8': expected 0.5, 0.6 or 0.7"},
      {"VERSION 0.7\nDATA ascii\n", "no FIELDS entry"},
      {"VERSION 0.7\nFIELDS x y z\nSIZE 4 4\n", "SIZE has 2 values: expected 3"},
      {one("x z", "4 4", "F F", "1 1"), "FIELDS has no y"},
      {one("x y z", "4 4 4", "F U F", "1 1 1"),
       "field y = TYPE U SIZE 4 COUNT 1: expected TYPE F SIZE 4 or 8"},
      {one("x y z", "4 4 4", "F F F", "1 1 2"), "field z = TYPE F SIZE 4 COUNT 2"},
      {one("x y z", "4 3 4", "F F F", "1 1 1"), "SIZE = '3': expected 1, 2, 4, 8"},
      {one("x y z", "4 4 4", "F Q F", "1 1 1"), "TYPE = 'Q': expected F, I, U"},
      {one("x y z", "4 4 4", "F F F", "1 0 1"), "COUNT = '0': expected 1 to"},
      {one("x y z rgb", "4 4 4 2", "F F F U", "1 1 1 1"), "field rgb = TYPE U SIZE 2"},
      {xyz_header("1", "zip"), "DATA = 'zip': expected ascii, binary, binary_compressed"},
      {sized(much, "1", much, "binary"), "WIDTH = '4000000000': expected 1 to 2147483647"},
      {sized(nines, "1", "1", "binary"), "WIDTH = '" + nines + "'"},
      {sized("3", "-1", "3", "ascii"), "HEIGHT = '-1'"},
      {sized("3", "2", "5", "ascii"), "POINTS = '5': expected WIDTH * HEIGHT = 6"},
      {pcd_header("x y z h", "4 4 4 8", "F F F F", "1 1 1 2147483647", "2", "1", "2", "binary") +
           std::string(64, 'x'),
       "POINTS = 2: the 64 bytes of binary data hold at most 0"},
      {xyz_header("2", "binary") + std::string(23, 'x'),
       "POINTS = 2: the 23 bytes of binary data hold at most 1"},
      {xyz_header("1", "ascii") + "1 +-2 3\n", ":12: '+-2': expected a number"},
      {two_points + "1 2 3\n                      \n", "the data end after 1 points: POINTS = 2"},
      {two_points + "1.25 2 3\n1 2\n", ":13: 2 values: expected 3"},
      {two_points + "1 2 3\n1 2 3 4\n", ":13: 4 values: expected 3"},
      {two_points + "1 2 3\n1 2 3\n\n1 2 3\n", ":15: a line behind the last point: POINTS = 2"},
  };
  // Consistent, but far more than the file holds: refused before any allocation.
  for (const std::string data : {"ascii", "binary", "binary_compressed"})
    rows.push_back({sized(all, all, "4611686014132420609", data) + "12345678",
                    "POINTS = 4611686014132420609: the 8 bytes of " + data + " data hold at most"});
  for (const auto& [bytes, text] : rows) EXPECT_HAS(error(bytes), text);
  for (const fs::path& path : {folder_ / "missing.pcd", folder_.path()})
    EXPECT_HAS(refusal([&] { read_pcd(path); }), path.string() + ": cannot be read");
}

TEST_F(PcdFile, RefusesDamagedCompressedData) {
  const std::string head = xyz_header("1", "binary_compressed"), damaged = "damaged LZF block of ";
  const std::string good = lzf_literals(raw(1.f) + raw(2.f) + raw(3.f));  // 13 bytes
  const std::string four = lzf_literals("1234");
  const auto claiming = [&](std::uint32_t size) { return head + raw(size) + raw(std::uint32_t{12}) + good; };
  const auto block = [&](const std::string& bytes) { return head + compressed(bytes, 12); };
  const std::pair<std::string, std::string> rows[] = {
      {head + "1234567", "end before the sizes"},
      {head + compressed(good, 16), "raw size = 16: expected 12"},
      {block(good.substr(0, 5)), damaged + "5 bytes"},          // run cut short
      {block(four), damaged + "5 bytes: expected 12 bytes"},    // too little
      {block(lzf_literals(std::string(13, 'x'))), damaged},     // too much
      {block(four + std::string("\x20\x04", 2)), damaged},      // before the start
      {block(four + std::string("\xe0\xff\x00", 3)), damaged},  // past the end
      {block(four + "\xe0"), damaged + "6 bytes"},              // no length
      {block(four + "\x20"), damaged + "6 bytes"},              // no distance
      {claiming(13).substr(0, head.size() + 15), "compressed size = 13: the file has 7 bytes"},
      {claiming(0xFFFFFFFF), "compressed size = 4294967295: the file has 13 bytes left"},
      {claiming(12), damaged + "12 bytes: expected 12 bytes from it"},
      {claiming(0), damaged + "0 bytes: expected 12 bytes from it"},
  };
  for (const auto& [bytes, text] : rows) EXPECT_HAS(error(bytes), text);
  EXPECT_EQ(read(claiming(13)).cloud.point(0), Vec3(1, 2, 3));
}

TEST_F(PcdFile, ReadsOrRefusesDamagedFiles) {
  // Damages every byte of a good file in turn, in two ways: the file can still be read, or it is an
  // InputError.
  const CameraIntrinsics camera{4, 3, 20, 25, 1.5, 1};
  const std::string binary = organised_pcd(camera, 0);
  const std::string packed =
      xyz_header("1", "binary_compressed") + compressed(lzf_literals(raw(1.f) + raw(2.f) + raw(3.f)), 12);
  for (const std::string& good : {binary, packed, xyz_header("1", "ascii") + "1 2 3\n"}) {
    for (std::size_t i = 0; i < good.size(); ++i) {
      for (const int flip : {0x01, 0xA5}) {
        std::string damaged = good;
        damaged[i] = static_cast<char>(damaged[i] ^ flip);
        refusal([&] { read(damaged); });
      }
    }
  }
}

}  // namespace
}  // namespace remote_touch::pcd_file_test

namespace remote_touch::pcd_viewpoint_test {
namespace {

PcdCloud read_text(const std::string& bytes) {
  const TestFolder folder("pcd_viewpoint_test");
  return read_pcd(folder.write("cloud.pcd", bytes));
}

std::string refusal_of(const std::string& bytes) {
  return refusal([&] { read_text(bytes); });
}

// Returns the point of pixel (u, v) in the camera's frame.
Vec3 seen_by(int u, int v) {
  return {0.2 * (u - 1.5), 0.2 * (v - 1), 2 + 0.1 * u};
}

// Returns a file with a wall in 4 x 3 pixels before a camera at X_FC. The colours identify the pixels, which
// are stored from left to right or from right to left.
std::string wall_before(const RigidTransform& X_FC, const std::string& viewpoint, bool right_to_left) {
  std::string pcd = pcd_header("x y z rgb", "4 4 4 4", "F F F U", "1 1 1 1", "4", "3", "12", "ascii");
  for (int i = 0; i < 12; ++i) {
    const int u = right_to_left ? 3 - i % 4 : i % 4, v = i / 4;
    const Vec3 p = X_FC * seen_by(u, v);
    for (const double value : {p.x(), p.y(), p.z()}) pcd += std::to_string(value) + " ";
    pcd += std::to_string(10 * v + u) + "\n";
  }
  return seen_from(pcd, viewpoint);
}

// The axes of the sensor are not those of the file: the points form an image along x, against z, and so on. A
// viewpoint may look along z of the camera or against it.
TEST(PcdViewpoint, IsWhereTheCameraIs) {
  const RigidTransform about_y(Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::UnitY())),
      about_x(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX())),
      away = Eigen::Translation3d(1, 2, 3) * about_y;
  const std::pair<RigidTransform, std::string> rows[] = {{away, "1 2 3 0.70710678 0 0.70710678 0"},
                                                         {away, "1 2 3 0 0.70710678 0 -0.70710678"},
                                                         {about_y, "0 0 0 0.70710678 0 0.70710678 0"},
                                                         {about_x, "0 0 0 0 1 0 0"}};
  for (const auto& [X_FC, viewpoint] : rows)
    for (const bool right_to_left : {false, true}) {
      if (right_to_left && X_FC.translation().isZero()) continue;
      const PcdCloud file = read_text(wall_before(X_FC, viewpoint, right_to_left));
      ASSERT_TRUE(file.cloud.image) << viewpoint;
      EXPECT_FALSE(file.has_unused_viewpoint);
      EXPECT_TRUE(file.X_FC.isApprox(X_FC, 1e-6));
      for (std::size_t i = 0; i < 12; ++i) {
        const int u = static_cast<int>(i % 4), v = static_cast<int>(i / 4);
        EXPECT_EQ(file.cloud.colour[i], static_cast<std::uint32_t>(10 * v + u));
        EXPECT_TRUE(file.cloud.point(i).isApprox(seen_by(u, v), 1e-5));
      }
    }
}

TEST(PcdViewpoint, IsNotUsedWhereTheImageIsSeenFromTheOrigin) {
  const CameraIntrinsics camera{16, 12, 20, 25, 7.25, 5.5};
  const std::string at_origin = organised_pcd(camera, 0);
  const PcdCloud expected = read_text(at_origin), other = read_text(seen_from(at_origin, "0 0.5 -2 1 0 0 0"));
  EXPECT_TRUE(other.has_unused_viewpoint);
  EXPECT_TRUE(other.X_FC.matrix().isIdentity(0));
  ASSERT_TRUE(other.cloud.image);
  EXPECT_EQ(other.cloud.x[3], expected.cloud.x[3]);
  // A sensor at the origin may have its own frame turned in any way: the points are the same, bit for bit.
  const PcdCloud turned = read_text(seen_from(at_origin, "0 0 0 0 1 0 0"));
  EXPECT_FALSE(turned.has_unused_viewpoint);
  EXPECT_EQ(turned.cloud.x[3], expected.cloud.x[3]);
  EXPECT_EQ(turned.cloud.image->camera.fx, expected.cloud.image->camera.fx);
  EXPECT_TRUE(
      read_text(seen_from(xyz_header("1", "ascii") + "1 2 3\n", "0 0 1 1 0 0 0")).has_unused_viewpoint);
}

// The image is seen along z, but the VIEWPOINT says that the camera looks elsewhere; points in no order are
// no image at all.
TEST(PcdViewpoint, ATurnAwayFromTheImageIsReported) {
  const CameraIntrinsics camera{16, 12, 20, 25, 7.25, 5.5};
  const PcdCloud turned = read_text(seen_from(organised_pcd(camera, 0), "0 0 0 0.70710678 0 0.70710678 0"));
  EXPECT_TRUE(turned.has_unused_viewpoint);
  EXPECT_TRUE(turned.X_FC.matrix().isIdentity(0));
  EXPECT_TRUE(turned.cloud.image);
  const std::string unorganised = xyz_header("1", "ascii") + "1 2 3\n";
  EXPECT_TRUE(read_text(seen_from(unorganised, "0 0 0 0 1 0 0")).has_unused_viewpoint);
  EXPECT_FALSE(read_text(seen_from(unorganised, "0 0 0 0 0 0 0")).has_unused_viewpoint)
      << "zeros for unknown";
  EXPECT_FALSE(read_text(seen_from(unorganised, "0 0 0 -1 0 0 0")).has_unused_viewpoint)
      << "no rotation, too";
  const std::string holes = xyz_header("2", "ascii") + "nan nan nan\nnan nan nan\n";
  EXPECT_FALSE(read_text(seen_from(holes, "0 0.5 -2 1 0 0 0")).has_unused_viewpoint) << "nothing to turn";
}

TEST(PcdViewpoint, IsRefusedIfItIsNotSevenNumbers) {
  const std::string good = xyz_header("1", "ascii") + "1 2 3\n";
  EXPECT_HAS(refusal_of(seen_from(good, "0 0 1")), "VIEWPOINT has 3 values: expected 7");
  EXPECT_HAS(refusal_of(seen_from(good, "0 0 one 1 0 0 0")), "VIEWPOINT has 'one': expected numbers");
  EXPECT_HAS(refusal_of(seen_from(good, "0 0 inf 1 0 0 0")), "VIEWPOINT has 'inf': expected numbers");
  EXPECT_HAS(refusal_of(seen_from(good, "0 0 1 1 0 0 1")), "a quaternion of length 1.414214: expected 1");
}

}  // namespace
}  // namespace remote_touch::pcd_viewpoint_test
