// Shared by the tests of the file readers: a folder to write in, PNG and PCD files, and the message of a
// refusal.
#pragma once

#include <gtest/gtest.h>
#include <png.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "core/parameters/parameter.h"
#include "core/points/point_cloud.h"

namespace remote_touch {

bool contains(const std::string& text, const std::string& part);
#define EXPECT_HAS(text, part) EXPECT_PRED2(contains, text, part)

// Returns the message of the InputError that call throws, which must be one line.
template <class Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const InputError& error) {
    std::string message = error.what();
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }
  return "no InputError";
}

// An empty folder of this process, which is removed at the end with its content. Names are relative to it.
class TestFolder {
 public:
  explicit TestFolder(const std::string& name);
  ~TestFolder();
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

  // Makes the folders in the name, and returns the file.
  std::filesystem::path write(const std::string& name, const std::string& bytes) const;

  // The samples are rows in the order of the format, e.g. PNG_FORMAT_LINEAR_Y: one 16-bit grey sample per
  // pixel. Only formats with a colour map have a palette.
  std::filesystem::path write_png(const std::string& name, int width, int height, std::uint32_t format,
                                  const void* samples, const void* palette = nullptr,
                                  int palette_size = 0) const;
  // A depth image of width x 2 pixels: first, first + 1, ... in the file's units.
  void write_depth(const std::string& name, std::uint16_t first, int width = 3) const;
  // A colour image of width x 2 pixels, all of one grey.
  void write_colour(const std::string& name, std::uint8_t grey, int width = 3) const;

 private:
  std::filesystem::path path_;
};

std::string bytes_of(const std::filesystem::path& file);

// Returns the names of the entries of a folder, in order.
std::vector<std::string> files_in(const std::filesystem::path& folder);

// Returns the bytes of a value as they are in memory.
template <class Value>
std::string raw(Value value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

// A complete PCD header, up to and including the line DATA (11 lines).
std::string pcd_header(const std::string& fields, const std::string& size, const std::string& type,
                       const std::string& count, const std::string& width, const std::string& height,
                       const std::string& points, const std::string& data);

// Header of an unorganised cloud of the float fields x, y, z.
std::string xyz_header(const std::string& points, const std::string& data);

// Returns a PCD file of pcd_header() with another line VIEWPOINT.
std::string seen_from(std::string pcd, const std::string& viewpoint);

// An LZF block of literal runs only, as a compressor writes data that does not repeat.
std::string lzf_literals(const std::string& bytes);

// Body of a PCD file with DATA binary_compressed: both sizes in bytes, then the block.
std::string compressed(const std::string& block, std::uint32_t raw_size);

// An organised binary PCD file: a slanted plane as floats, with holes at the points 0, 5 and 7 (each marked
// in another way). shift_px moves point 11 sideways.
std::string organised_pcd(const CameraIntrinsics& camera, double shift_px);

}  // namespace remote_touch
