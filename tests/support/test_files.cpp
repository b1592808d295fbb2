#include "tests/support/test_files.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numeric>

namespace remote_touch {

namespace fs = std::filesystem;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

// The process id separates tests that run at the same time. A folder of that name may exist nevertheless,
// because a test was killed or runs in another container with the same temporary folder.
TestFolder::TestFolder(const std::string& name) {
  const fs::path wanted = fs::temp_directory_path() / (name + "_" + std::to_string(::getpid()));
  path_ = wanted;
  for (int i = 1; !fs::create_directory(path_); ++i) path_ = wanted.string() + "_" + std::to_string(i);
}

TestFolder::~TestFolder() {
  std::error_code ignored;  // a folder that stays is no reason to end the process
  fs::remove_all(path_, ignored);
}

fs::path TestFolder::write(const std::string& name, const std::string& bytes) const {
  fs::path file = path_ / name;
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

fs::path TestFolder::write_png(const std::string& name, int width, int height, std::uint32_t format,
                               const void* samples, const void* palette, int palette_size) const {
  fs::path file = path_ / name;
  fs::create_directories(file.parent_path());
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width), image.height = static_cast<png_uint_32>(height);
  image.format = format;
  image.colormap_entries = static_cast<png_uint_32>(palette_size);
  EXPECT_NE(png_image_write_to_file(&image, file.c_str(), 0, samples, 0, palette), 0) << image.message;
  return file;
}

void TestFolder::write_depth(const std::string& name, std::uint16_t first, int width) const {
  std::vector<std::uint16_t> samples(static_cast<std::size_t>(2 * width));
  std::iota(samples.begin(), samples.end(), first);
  write_png(name, width, 2, PNG_FORMAT_LINEAR_Y, samples.data());
}

void TestFolder::write_colour(const std::string& name, std::uint8_t grey, int width) const {
  const std::vector<std::uint8_t> samples(static_cast<std::size_t>(2 * width), grey);
  write_png(name, width, 2, PNG_FORMAT_GRAY, samples.data());
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> files_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string pcd_header(const std::string& fields, const std::string& size, const std::string& type,
                       const std::string& count, const std::string& width, const std::string& height,
                       const std::string& points, const std::string& data) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size +
         "\nTYPE " + type + "\nCOUNT " + count + "\nWIDTH " + width + "\nHEIGHT " + height +
         "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n";
}

std::string xyz_header(const std::string& points, const std::string& data) {
  return pcd_header("x y z", "4 4 4", "F F F", "1 1 1", points, "1", points, data);
}

std::string seen_from(std::string pcd, const std::string& viewpoint) {
  const std::string at_origin = "VIEWPOINT 0 0 0 1 0 0 0";
  return pcd.replace(pcd.find(at_origin), at_origin.size(), "VIEWPOINT " + viewpoint);
}

// A run has at most 32 bytes, after a byte that holds its length - 1.
std::string lzf_literals(const std::string& bytes) {
  std::string block;
  for (std::size_t i = 0; i < bytes.size(); i += 32) {
    const std::string run = bytes.substr(i, 32);
    block += static_cast<char>(run.size() - 1) + run;
  }
  return block;
}

std::string compressed(const std::string& block, std::uint32_t raw_size) {
  return raw(static_cast<std::uint32_t>(block.size())) + raw(raw_size) + block;
}

std::string organised_pcd(const CameraIntrinsics& camera, double shift_px) {
  const std::string w = std::to_string(camera.width), h = std::to_string(camera.height);
  const std::string points = std::to_string(camera.width * camera.height);
  std::string bytes = pcd_header("x y z", "4 4 4", "F F F", "1 1 1", w, h, points, "binary");
  for (int i = 0; i < camera.width * camera.height; ++i) {
    const int u = i % camera.width, v = i / camera.width;
    Vec3 p = unproject(camera, u + (i == 11 ? shift_px : 0), v, 0.8 + 0.01 * u + 0.02 * v);
    if (i == 0) p = Vec3::Zero();
    if (i == 5) p.y() = INFINITY;
    if (i == 7) p.setConstant(NAN);
    for (int k = 0; k < 3; ++k) bytes += raw(static_cast<float>(p[k]));
  }
  return bytes;
}

}  // namespace remote_touch
