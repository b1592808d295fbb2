#include "scenarios/recordings/images_and_clouds/depth_npy.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxNpySide = 65535, kMaxNpyPixels = 1u << 26;  // as of PNG files

struct NpyHeader {
  std::string type;  // as NumPy writes it: "<f4"
  bool is_fortran = false;
  std::size_t height = 0, width = 0;
  std::size_t data_at = 0;
};

std::string bytes_in(const std::filesystem::path& file) {
  std::error_code unreachable;
  const std::uintmax_t size = std::filesystem::file_size(file, unreachable);
  if (unreachable) refuse(file, "cannot be read: ", unreachable.message());
  constexpr std::uintmax_t kMaxBytes = kMaxNpyPixels * sizeof(double) + 65536;
  if (size > kMaxBytes)
    refuse(file, "has ", size, " bytes: expected an image of at most ", kMaxNpyPixels, " pixels");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!in) refuse(file, "cannot be read");
  return bytes;
}

// Returns the values of a dictionary of Python, such as {'descr': '<f4', 'fortran_order': False, 'shape': (2,
// 3), }, by their keys and without blanks and quotes.
std::map<std::string, std::string> dictionary(std::string_view text) {
  std::map<std::string, std::string> values;
  std::string key, word;
  bool is_in_brackets = false;
  for (const char c : text) {
    if (c == '(') is_in_brackets = true;
    if (c == ')') is_in_brackets = false;
    if (c == ':' && key.empty()) {
      key = std::exchange(word, {});
    } else if ((c == ',' && !is_in_brackets) || c == '}') {
      if (!key.empty()) values[std::exchange(key, {})] = word;
      word.clear();
    } else if (std::string_view(" \n\t{'\"").find(c) == std::string_view::npos) {
      word += c;
    }
  }
  return values;
}

// Returns false unless the text is "(HEIGHT,WIDTH)" with sides from 1 to kMaxNpySide.
bool read_shape(const std::string& text, NpyHeader& header) {
  const char *at = text.data(), *const end = at + text.size();
  const auto read = [&](char before, std::size_t& side) {
    if (at == end || *at++ != before) return false;
    const auto [next, error] = std::from_chars(at, end, side);
    at = next;
    return error == std::errc() && side >= 1 && side <= kMaxNpySide;
  };
  return read('(', header.height) && read(',', header.width) && std::string_view(at, end) == ")";
}

NpyHeader header_of(const std::filesystem::path& file, const std::string& bytes) {
  constexpr std::string_view kMagic{"\x93NUMPY", 6};
  constexpr std::size_t kVersion = kMagic.size(), kLength = kVersion + 2;
  if (!bytes.starts_with(kMagic) || bytes.size() < kLength + 4)
    refuse(file, "does not begin as a NumPy file");
  const auto byte = [&](std::size_t at) { return std::size_t{static_cast<unsigned char>(bytes[at])}; };
  const std::size_t length_bytes = byte(kVersion) == 1 ? 2 : 4;
  NpyHeader header;
  std::size_t length = 0;
  for (std::size_t i = length_bytes; i-- > 0;) length = length << 8 | byte(kLength + i);
  if (length > bytes.size() - kLength - length_bytes) refuse(file, "ends within its header");
  header.data_at = kLength + length_bytes + length;
  auto values = dictionary(std::string_view(bytes).substr(kLength + length_bytes, length));
  header.type = values["descr"];
  header.is_fortran = values["fortran_order"] == "True";
  if (!read_shape(values["shape"], header))
    refuse(file, "has the shape \"", values["shape"].substr(0, 32),
           "\": expected (height, width) of an image");
  if (header.height * header.width > kMaxNpyPixels)
    refuse(file, "has ", header.height * header.width, " pixels: expected at most ", kMaxNpyPixels);
  return header;
}

// Returns the values in the order of the file.
template <class Value>
std::vector<double> values_of(const std::filesystem::path& file, const std::string& bytes,
                              const NpyHeader& header) {
  const std::size_t count = header.height * header.width;
  if (bytes.size() - header.data_at != count * sizeof(Value))
    refuse(file, "has ", bytes.size() - header.data_at, " bytes of data: expected ", count * sizeof(Value),
           ", as its header says");
  static_assert(std::endian::native == std::endian::little);
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::array<char, sizeof(Value)> one;
    std::memcpy(one.data(), bytes.data() + header.data_at + i * sizeof(Value), one.size());
    if (header.type[0] == '>') std::reverse(one.begin(), one.end());
    values[i] = static_cast<double>(std::bit_cast<Value>(one));
  }
  return values;
}

std::vector<double> numbers_in(const std::filesystem::path& file, const std::string& bytes,
                               const NpyHeader& header) {
  const std::string kind = header.type.empty() ? "" : header.type.substr(1);
  if (kind == "f4") return values_of<float>(file, bytes, header);
  if (kind == "f8") return values_of<double>(file, bytes, header);
  if (kind == "u2") return values_of<std::uint16_t>(file, bytes, header);
  refuse(file, "has values of type \"", header.type.substr(0, 16), "\": expected float32, float64 or uint16");
}

}  // namespace

DepthImage read_depth_npy(const std::filesystem::path& file, double metres_per_unit, double max_depth_m) {
  const std::string bytes = bytes_in(file);
  const NpyHeader header = header_of(file, bytes);
  const std::vector<double> values = numbers_in(file, bytes, header);
  const double missing = header.type.ends_with("u2") ? 65535 : 0;
  DepthImage depth{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  depth.z_m.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t u = header.is_fortran ? i / header.height : i % header.width;
    const std::size_t v = header.is_fortran ? i % header.height : i / header.width;
    if (values[i] < 0 && std::isfinite(values[i]))
      refuse(file, "pixel ", u, ", ", v, " has the depth ", values[i],
             ": expected above 0, or 0 or NaN for none");
    const double z_m = values[i] * metres_per_unit;
    const bool is_measured = values[i] != missing && z_m > 0 && std::isfinite(z_m) && z_m <= max_depth_m;
    depth.z_m[v * header.width + u] = is_measured ? z_m : std::numeric_limits<double>::quiet_NaN();
  }
  return depth;
}

void distances_to_depths(const CameraIntrinsics& camera, DepthImage& image) {
  const auto width = static_cast<std::size_t>(image.width);
  for (std::size_t i = 0; i < image.z_m.size(); ++i) {
    const std::size_t column = i % width, row = i / width;
    image.z_m[i] /= unproject(camera, static_cast<double>(column), static_cast<double>(row), 1).norm();
  }
}

}  // namespace remote_touch
