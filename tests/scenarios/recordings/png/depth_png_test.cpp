#include "scenarios/recordings/png/depth_png.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/test_files.h"

namespace remote_touch {
namespace {

namespace fs = std::filesystem;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

class DepthPng : public ::testing::Test {
 protected:
  const TestFolder folder_{"depth_png_test"};
};

TEST_F(DepthPng, KeepsEverySampleAndScalesIt) {
  const std::uint16_t samples[6] = {1, 255, 256, 1000, 32768, 65535};
  const DepthImage depth =
      read_depth_png(folder_.write_png("d.png", 3, 2, PNG_FORMAT_LINEAR_Y, samples), 0.0002, kNoLimit);
  ASSERT_EQ(depth.width, 3);
  ASSERT_EQ(depth.height, 2);
  ASSERT_EQ(depth.z_m.size(), 6u);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(depth.z_m[i], samples[i] * 0.0002) << i;
}

TEST_F(DepthPng, NoMeasurementAndTooFarAreNaN) {
  const std::uint16_t samples[4] = {0, 2000, 3000, 3001};
  const DepthImage depth =
      read_depth_png(folder_.write_png("d.png", 4, 1, PNG_FORMAT_LINEAR_Y, samples), 0.001, 3.0);
  EXPECT_TRUE(std::isnan(depth.z_m[0]));
  EXPECT_EQ(depth.z_m[1], 2.0);
  EXPECT_EQ(depth.z_m[2], 3.0);  // the limit itself is kept
  EXPECT_TRUE(std::isnan(depth.z_m[3]));
}

TEST_F(DepthPng, RefusesOtherPixelFormats) {
  const std::uint8_t grey[1] = {7}, rgb[3] = {1, 2, 3};
  const std::uint16_t rgb16[3] = {1, 2, 3};
  const fs::path grey_file = folder_.write_png("grey.png", 1, 1, PNG_FORMAT_GRAY, grey);
  const std::string text = refusal([&] { read_depth_png(grey_file, 0.001, kNoLimit); });
  EXPECT_HAS(text, grey_file.string());
  EXPECT_HAS(text, "8-bit grey: allowed 16-bit grey (one channel)");
  const fs::path rgb_file = folder_.write_png("rgb.png", 1, 1, PNG_FORMAT_RGB, rgb);
  EXPECT_HAS(refusal([&] { read_depth_png(rgb_file, 0.001, kNoLimit); }), "8-bit RGB");
  const fs::path rgb16_file = folder_.write_png("rgb16.png", 1, 1, PNG_FORMAT_LINEAR_RGB, rgb16);
  EXPECT_HAS(refusal([&] { read_depth_png(rgb16_file, 0.001, kNoLimit); }), "16-bit RGB");
  int width = 0, height = 0;
  EXPECT_HAS(refusal([&] { read_colour_png(rgb16_file, width, height); }),
             "16-bit RGB: allowed up to 8 bits");
}

TEST_F(DepthPng, RefusesEveryTruncation) {
  std::uint16_t samples[64];
  for (int i = 0; i < 64; ++i) samples[i] = static_cast<std::uint16_t>(i * 997);
  const std::string bytes = bytes_of(folder_.write_png("d.png", 8, 8, PNG_FORMAT_LINEAR_Y, samples));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const fs::path cut = folder_.write("cut.png", bytes.substr(0, length));
    const std::string text = refusal([&] { read_depth_png(cut, 0.001, kNoLimit); });
    EXPECT_HAS(text, cut.string() + ": is not a whole PNG file: ") << "cut to " << length;
  }
}

TEST_F(DepthPng, RefusesDamagedPixels) {
  std::uint16_t samples[64] = {1, 2, 3};
  std::string bytes = bytes_of(folder_.write_png("d.png", 8, 8, PNG_FORMAT_LINEAR_Y, samples));
  bytes[bytes.find("IDAT") + 8] ^= 0x55;
  EXPECT_HAS(refusal([&] { read_depth_png(folder_.write("d.png", bytes), 0.001, kNoLimit); }),
             "not a whole PNG");
}

TEST_F(DepthPng, RefusesAClaimedSizeThatTheFileCannotHold) {
  const std::uint16_t samples[1] = {5};
  std::string bytes = bytes_of(folder_.write_png("d.png", 1, 1, PNG_FORMAT_LINEAR_Y, samples));
  // IHDR: 4 bytes type, then width and height, big-endian; the CRC over type and data follows the 13 data
  // bytes.
  const std::size_t type = bytes.find("IHDR");
  bytes.replace(type + 4, 8, std::string("\0\x0f\x42\x40\0\x0f\x42\x40", 8));  // 1000000 x 1000000
  std::uint32_t crc = 0xFFFFFFFFu;
  for (std::size_t i = type; i < type + 17; ++i) {
    crc ^= static_cast<unsigned char>(bytes[i]);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) ? crc >> 1 ^ 0xEDB88320u : crc >> 1;
  }
  for (int k = 0; k < 4; ++k) bytes[type + 17 + k] = static_cast<char>(~crc >> (24 - 8 * k));
  const fs::path file = folder_.write("d.png", bytes);
  const std::string text = refusal([&] { read_depth_png(file, 0.001, kNoLimit); });
  EXPECT_HAS(text, file.string() + ": claims 1000000 x 1000000 pixels");
}

TEST_F(DepthPng, RefusesMissingFilesAndFolders) {
  const fs::path missing = folder_ / "missing.png";
  EXPECT_HAS(refusal([&] { read_depth_png(missing, 0.001, kNoLimit); }),
             missing.string() + ": cannot be read");
  EXPECT_HAS(refusal([&] { read_depth_png(folder_.path(), 0.001, kNoLimit); }),
             folder_.path().string() + ": cannot be read");
}

TEST_F(DepthPng, ReadsColoursOfEveryFormat) {
  int width = 0, height = 0;
  const std::vector<std::uint32_t> expected = {0x102030, 0xFFEE00};
  const std::uint8_t rgb[6] = {0x10, 0x20, 0x30, 0xFF, 0xEE, 0x00};
  EXPECT_EQ(read_colour_png(folder_.write_png("rgb.png", 2, 1, PNG_FORMAT_RGB, rgb), width, height),
            expected);
  EXPECT_EQ(width, 2);
  EXPECT_EQ(height, 1);
  const std::uint8_t rgba[8] = {0x10, 0x20, 0x30, 0x00, 0xFF, 0xEE, 0x00, 0x80};  // the alpha changes nothing
  EXPECT_EQ(read_colour_png(folder_.write_png("rgba.png", 2, 1, PNG_FORMAT_RGBA, rgba), width, height),
            expected);
  const std::uint8_t grey[2] = {0x00, 0xA7};
  const std::vector<std::uint32_t> expected_grey = {0x000000, 0xA7A7A7};
  EXPECT_EQ(read_colour_png(folder_.write_png("grey.png", 1, 2, PNG_FORMAT_GRAY, grey), width, height),
            expected_grey);
  EXPECT_EQ(width, 1);
  EXPECT_EQ(height, 2);
  const std::uint8_t indices[2] = {1, 0};
  const std::uint8_t palette[6] = {0xFF, 0xEE, 0x00, 0x10, 0x20, 0x30};
  const fs::path file = folder_.write_png("palette.png", 2, 1, PNG_FORMAT_RGB_COLORMAP, indices, palette, 2);
  EXPECT_EQ(read_colour_png(file, width, height), expected);
}

}  // namespace
}  // namespace remote_touch
