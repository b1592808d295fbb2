// Depth and colour images: PNG and NumPy files are read exactly, in each format; damaged ones are refused.
#include "scenarios/files/depth_images.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "core/points/point_cloud.h"
#include "tests/support/test_files.h"

namespace remote_touch::depth_images_test {
namespace {

namespace fs = std::filesystem;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

class DepthPng : public ::testing::Test {
 protected:
  static std::string error(const fs::path& file) {
    return refusal([&] { read_depth_png(file, 0.001, kNoLimit); });
  }
  // Expects an image of one row, or of one column if it is upright, with these colours.
  static void expect_colours(const fs::path& file, const std::vector<std::uint32_t>& expected,
                             bool upright = false) {
    int width = 0, height = 0;
    EXPECT_EQ(read_colour_png(file, width, height), expected);
    EXPECT_EQ(upright ? width : height, 1);
    EXPECT_EQ(upright ? height : width, 2);
  }

  const TestFolder folder_{"depth_png_test"};
};

// No measurement is 0; the limit itself is kept.
TEST_F(DepthPng, KeepsEverySampleAndScalesIt) {
  const std::uint16_t samples[6] = {0, 255, 256, 1000, 32768, 65535};
  const fs::path file = folder_.write_png("d.png", 3, 2, PNG_FORMAT_LINEAR_Y, samples);
  const DepthImage depth = read_depth_png(file, 0.0002, kNoLimit), near = read_depth_png(file, 0.001, 1.0);
  ASSERT_EQ(depth.width, 3);
  ASSERT_EQ(depth.height, 2);
  ASSERT_EQ(depth.z_m.size(), 6u);
  EXPECT_TRUE(std::isnan(depth.z_m[0]));
  for (int i = 1; i < 6; ++i) EXPECT_EQ(depth.z_m[i], samples[i] * 0.0002) << i;
  EXPECT_EQ(near.z_m[3], 1.0);
  EXPECT_TRUE(std::isnan(near.z_m[4]));
}

TEST_F(DepthPng, RefusesEveryTruncation) {
  std::uint16_t samples[64];
  for (int i = 0; i < 64; ++i) samples[i] = static_cast<std::uint16_t>(i * 997);
  const std::string bytes = bytes_of(folder_.write_png("d.png", 8, 8, PNG_FORMAT_LINEAR_Y, samples));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const fs::path cut = folder_.write("cut.png", bytes.substr(0, length));
    EXPECT_HAS(error(cut), cut.string() + ": is not a whole PNG file: ") << "cut to " << length;
  }
  std::string damaged = bytes;
  damaged[damaged.find("IDAT") + 8] ^= 0x55;
  EXPECT_HAS(error(folder_.write("d.png", damaged)), "not a whole PNG");
}

std::string big_endian(std::uint32_t value) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
  return bytes;
}

// Returns a chunk: length, type, data and the CRC over type and data.
std::string chunk(const std::string& type, const std::string& data) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const char c : type + data) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
  }
  return big_endian(static_cast<std::uint32_t>(data.size())) + type + data + big_endian(~crc);
}

// Returns the signature and the header of a 16-bit grey PNG. The caller adds the rest.
std::string png_header(std::uint32_t width, std::uint32_t height) {
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big_endian(width) + big_endian(height) + std::string("\x10\0\0\0\0", 5));
}

// A deflate stream of 0.8 MB could expand to that many zeros, which would take 4 GB in memory.
TEST_F(DepthPng, RefusesOtherFormatsAndSizesThatCannotBe) {
  const std::uint8_t samples[3] = {1, 2, 3};
  const std::uint16_t deep[3] = {1, 2, 3};
  const std::string end = chunk("IEND", ""), much = chunk("IDAT", std::string(800'000, 'x')) + end;
  const fs::path rgb16 = folder_.write_png("rgb16.png", 1, 1, PNG_FORMAT_LINEAR_RGB, deep);
  const std::pair<fs::path, std::string> rows[] = {
      {folder_.write_png("grey.png", 1, 1, PNG_FORMAT_GRAY, samples),
       "8-bit grey: expected 16-bit grey (one channel)"},
      {folder_.write_png("rgb.png", 1, 1, PNG_FORMAT_RGB, samples), "8-bit RGB"},
      {rgb16, "16-bit RGB"},
      {folder_.write("claim.png", png_header(8000, 8000) + chunk("IDAT", "x") + end),
       ": claims 8000 x 8000 pixels: more than its 58 bytes can hold"},
      {folder_.write("square.png", png_header(20000, 20000) + much), "expected up to"},
      {folder_.write("wide.png", png_header(100000, 1000) + much), "expected up to"},
      {folder_.write("tall.png", png_header(1000, 100000) + much), "expected up to"},
      {folder_ / "missing.png", ": cannot be read"},
      {folder_.path(), ": cannot be read"},
  };
  for (const auto& [file, text] : rows) {
    EXPECT_HAS(error(file), file.string() + ": ");
    EXPECT_HAS(error(file), text);
  }
  int width = 0, height = 0;
  EXPECT_HAS(refusal([&] { read_colour_png(rgb16, width, height); }), "16-bit RGB: expected up to 8 bits");
}

TEST_F(DepthPng, RefusesAChunkLongerThanTheFile) {
  const std::uint16_t samples[1] = {5};
  const std::string whole = bytes_of(folder_.write_png("d.png", 1, 1, PNG_FORMAT_LINEAR_Y, samples));
  const std::size_t after_header = 33, end = whole.size() - 12;
  for (const char* type : {"tEXt", "zTXt", "iTXt", "iCCP", "sPLT", "eXIf", "PLTE", "IDAT", "abCd"})
    for (const std::size_t place : {after_header, end})
      for (const std::uint32_t length : {0x7FFFFFFFu, 0xFFFFFFFFu, 1000u}) {
        const fs::path file =
            folder_.write("d.png", whole.substr(0, place) + big_endian(length) + type + whole.substr(place));
        EXPECT_HAS(error(file), std::string("is not a whole PNG file: ") + type + " claims " +
                                    std::to_string(length) + " bytes");
      }
}

// Chunks other than those of the pixels change nothing.
TEST_F(DepthPng, LeavesOutTexts) {
  const std::uint16_t samples[1] = {5};
  std::string bytes = bytes_of(folder_.write_png("d.png", 1, 1, PNG_FORMAT_LINEAR_Y, samples));
  bytes.insert(33, chunk("tEXt", std::string("Title\0a heart", 13)) + chunk("abCd", "private"));
  EXPECT_EQ(read_depth_png(folder_.write("d.png", bytes), 0.001, kNoLimit).z_m, std::vector<double>{0.005});
}

// RGB and grey with alpha, and a palette whose colours have alpha, can be transparent: such a pixel has no
// colour.
TEST_F(DepthPng, ReadsColoursOfEveryFormat) {
  const std::vector<std::uint32_t> two = {0x102030, 0xFFEE00}, half = {kNoColour, 0xFFEE00};
  const std::uint8_t rgb[6] = {0x10, 0x20, 0x30, 0xFF, 0xEE, 0x00}, grey[2] = {0x00, 0xA7};
  const std::uint8_t palette[6] = {0xFF, 0xEE, 0x00, 0x10, 0x20, 0x30}, swapped[2] = {1, 0},
                     indices[2] = {0, 1};
  const std::uint8_t faint[8] = {0x10, 0x20, 0x30, 0x01,
                                 0xFF, 0xEE, 0x00, 0x80};  // the alpha changes nothing
  const std::uint8_t rgba[8] = {0x10, 0x20, 0x30, 0x00, 0xFF, 0xEE, 0x00, 0xFF},
                     grey_alpha[4] = {0x40, 0x00, 0xA7, 0xFF};
  expect_colours(folder_.write_png("rgb.png", 2, 1, PNG_FORMAT_RGB, rgb), two);
  expect_colours(folder_.write_png("faint.png", 2, 1, PNG_FORMAT_RGBA, faint), two);
  expect_colours(folder_.write_png("grey.png", 1, 2, PNG_FORMAT_GRAY, grey), {0x000000, 0xA7A7A7}, true);
  expect_colours(folder_.write_png("palette.png", 2, 1, PNG_FORMAT_RGB_COLORMAP, swapped, palette, 2), two);
  expect_colours(folder_.write_png("rgba.png", 2, 1, PNG_FORMAT_RGBA, rgba), half);
  expect_colours(folder_.write_png("ga.png", 2, 1, PNG_FORMAT_GA, grey_alpha), {kNoColour, 0xA7A7A7});
  expect_colours(folder_.write_png("clear.png", 2, 1, PNG_FORMAT_RGBA_COLORMAP, indices, rgba, 2), half);
}

}  // namespace
}  // namespace remote_touch::depth_images_test

namespace remote_touch::depth_npy_test {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

std::string npy(const std::string& dictionary, const std::string& data, int version = 1) {
  std::string file = "\x93NUMPY" + std::string(1, static_cast<char>(version)) + '\0';
  const std::string header = dictionary + std::string(20, ' ') + "\n";
  file += version == 1 ? raw(static_cast<std::uint16_t>(header.size()))
                       : raw(static_cast<std::uint32_t>(header.size()));
  return file + header + data;
}
std::string header(const std::string& type, const std::string& shape, const std::string& fortran = "False") {
  return "{'descr': '" + type + "', 'fortran_order': " + fortran + ", 'shape': " + shape + ", }";
}
template <class Value>
std::string data(const std::vector<double>& values, bool is_big_endian = false) {
  std::string bytes;
  for (const double value : values) {
    std::string one = raw(static_cast<Value>(value));
    if (is_big_endian) std::reverse(one.begin(), one.end());
    bytes += one;
  }
  return bytes;
}

class DepthNpy : public ::testing::Test {
 protected:
  DepthImage read(const std::string& bytes, double unit_m = 1, double max_depth_m = kNoLimit) const {
    return read_depth_npy(folder_.write("d.npy", bytes), unit_m, max_depth_m);
  }
  std::string refused(const std::string& bytes) const {
    return refusal([&] { read(bytes); });
  }
  const TestFolder folder_{"depth_npy_test"};
};

TEST_F(DepthNpy, IsReadExactlyInEachTypeAndOrder) {
  const std::vector<double> rows{0.5, 1.25, 3, 7, 1024.5, 65000}, columns{0.5, 7, 1.25, 1024.5, 3, 65000};
  const auto expect = [&](const std::string& bytes) {
    const DepthImage depth = read(bytes);
    EXPECT_EQ(depth.width, 3);
    EXPECT_EQ(depth.height, 2);
    EXPECT_EQ(depth.z_m, rows);
  };
  expect(npy(header("<f4", "(2, 3)"), data<float>(rows)));
  expect(npy(header("<f8", "(2, 3)"), data<double>(rows), 2));
  expect(npy(header(">f4", "(2, 3)"), data<float>(rows, true), 3));
  expect(npy(header("<f8", "(2, 3)", "True"), data<double>(columns)));
  expect(npy("{'shape': (2, 3), 'fortran_order': False, 'descr': '>f8'}", data<double>(rows, true)));
  const DepthImage integers = read(npy(header("<u2", "(1, 2)"), data<std::uint16_t>({1, 65534})), 0.001);
  EXPECT_EQ(integers.z_m, (std::vector<double>{0.001, 65534 * 0.001}));
  const double third = 1.0 / 3;
  EXPECT_EQ(read(npy(header("<f8", "(1, 1)"), data<double>({third}))).z_m[0], third);
  EXPECT_EQ(read(npy(header("<f4", "(1, 1)"), data<float>({third}))).z_m[0],
            static_cast<double>(static_cast<float>(third)));
}

TEST_F(DepthNpy, NoMeasurementAndTooFarAreNaN) {
  const DepthImage depth =
      read(npy(header("<f4", "(1, 6)"), data<float>({0, std::nan(""), kNoLimit, -kNoLimit, 3, 3.5})), 1, 3);
  for (const std::size_t i : {0, 1, 2, 3, 5}) EXPECT_TRUE(std::isnan(depth.z_m[i])) << i;
  EXPECT_EQ(depth.z_m[4], 3);
  const std::string largest = data<std::uint16_t>({65535});
  EXPECT_TRUE(std::isnan(read(npy(header("<u2", "(1, 1)"), largest)).z_m[0]));
  EXPECT_EQ(read(npy(header("<f8", "(1, 1)"), data<double>({65535}))).z_m[0], 65535);
}

TEST_F(DepthNpy, RefusesWhatIsNoDepthImage) {
  const std::string four = data<float>({1, 1, 1, 1}), whole = npy(header("<f4", "(2, 2)"), four);
  const std::pair<std::string, std::string> rows[] = {
      {"P5 2 2", "d.npy: does not begin as a NumPy file"},
      {npy(header("<f4", "(4,)"), four), "has the shape \"(4,)\": expected (height, width)"},
      {npy(header("<f4", "(2, 2, 1)"), four), "has the shape \"(2,2,1)\""},
      {npy(header("<f4", "(0, 2)"), ""), "has the shape \"(0,2)\""},
      {npy(header("<f2", "(2, 2)"), four), "has values of type \"<f2\": expected float32"},
      {npy(header("|O", "(2, 2)"), four), "has values of type"},
      {npy(header("<f4", "(2, 2)"), four.substr(1)), "has 15 bytes of data: expected 16"},
      {npy(header("<f4", "(2, 2)"), four + "x"), "has 17 bytes of data: expected 16"},
      {npy(header("<f4", "(65535, 65535)"), four), "pixels: expected at most"},
      {npy(header("<f4", "(1, 2)"), data<float>({1, -2})), "pixel 1, 0 has the depth -2"},
  };
  for (const auto& [bytes, text] : rows) EXPECT_HAS(refused(bytes), text);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_HAS(refused(whole.substr(0, size)), "d.npy: ");
}

// The point at the distance is where the ray of the pixel meets a ball around the camera.
TEST_F(DepthNpy, DistancesBecomeDepths) {
  const CameraIntrinsics camera{64, 48, 50, 55, 30.5, 25};
  DepthImage image{64, 48, std::vector<double>(camera.pixels(), 2.5)};
  image.z_m[7] = std::nan("");
  distances_to_depths(camera, image);
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 64; ++u) {
      const double z_m = image.z_m[static_cast<std::size_t>(v * 64 + u)];
      if (v == 0 && u == 7)
        EXPECT_TRUE(std::isnan(z_m));
      else
        EXPECT_NEAR(unproject(camera, u, v, z_m).norm(), 2.5, 1e-14);
    }
}

}  // namespace
}  // namespace remote_touch::depth_npy_test
