#include "scenarios/recordings/bags/depth_from_message.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <vector>

#include "scenarios/recordings/images_and_clouds/depth_png.h"
#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

// Returns z_m, or NaN if it is not above 0, above max_depth_m, or not finite.
double measured_or_nan(double z_m, double max_depth_m) {
  const bool measured = z_m > 0 && z_m <= max_depth_m && z_m <= std::numeric_limits<double>::max();
  return measured ? z_m : std::numeric_limits<double>::quiet_NaN();
}

template <class Value>
DepthImage depth_of_rows(const ImageMessage& message, double scale, double max_depth_m,
                         const std::string& subject) {
  const std::uint64_t width = message.width, height = message.height, row = width * sizeof(Value);
  if (width * height == 0 || width * height > kMaxImagePixels)
    refuse(subject, "has ", width, " x ", height, " pixels: expected 1 to ", kMaxImagePixels);
  if (message.step < row)
    refuse(subject, "step = ", message.step, ": expected ", row, " or more, a row of pixels");
  const std::uint64_t needed = (height - 1) * message.step + row;
  if (message.data.size() < needed)
    refuse(subject, "has ", message.data.size(), " bytes of data: expected ", needed,
           " or more, as its height and step say");
  DepthImage depth{static_cast<int>(width), static_cast<int>(height), std::vector<double>(width * height)};
  for (std::uint64_t i = 0; i < width * height; ++i) {
    std::array<char, sizeof(Value)> bytes;
    const std::uint64_t at = i / width * message.step + i % width * sizeof(Value);
    std::memcpy(bytes.data(), message.data.data() + at, bytes.size());
    if (message.big_endian) std::reverse(bytes.begin(), bytes.end());
    depth.z_m[i] = measured_or_nan(std::bit_cast<Value>(bytes) * scale, max_depth_m);
  }
  return depth;
}

float float_at(std::string_view bytes, std::size_t at) {
  float value = 0;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace

bool is_depth_encoding(const std::string& encoding) {
  return encoding == "16UC1" || encoding == "mono16" || encoding == "Z16" || encoding == "32FC1";
}

DepthImage depth_from_message(const ImageMessage& message, const DepthUnits& units, double max_depth_m,
                              const std::string& subject) {
  const std::string& encoding = message.encoding;
  if (!is_depth_encoding(encoding))
    refuse(subject, "encoding = \"", encoding.substr(0, 32), "\": expected depths as ", kDepthEncodings);
  if (encoding == "32FC1") return depth_of_rows<float>(message, units.of_floats_m, max_depth_m, subject);
  return depth_of_rows<std::uint16_t>(message, units.of_integers_m, max_depth_m, subject);
}

DepthImage depth_from_message(const CompressedImageMessage& message, const DepthUnits& units,
                              double max_depth_m, const std::string& subject) {
  constexpr std::size_t kHeader = 12;
  const bool integers = message.format.starts_with("16UC1"), floats = message.format.starts_with("32FC1");
  const bool transport = message.format.find("compressedDepth") != std::string::npos;
  if (!transport || !(integers || floats) || message.format.find("rvl") != std::string::npos)
    refuse(subject, "format = \"", message.format.substr(0, 64),
           "\": expected \"16UC1; compressedDepth\" or \"32FC1; compressedDepth\", "
           "with PNG inside");
  if (message.data.size() < kHeader)
    refuse(subject, "has ", message.data.size(),
           " bytes of data: expected a header of 12 bytes and a PNG image");
  const float a = float_at(message.data, 4), b = float_at(message.data, 8);
  const GreyImage image = decode_grey_png(message.data.substr(kHeader), subject);
  DepthImage depth{image.width, image.height, std::vector<double>(image.values.size())};
  for (std::size_t i = 0; i < depth.z_m.size(); ++i) {
    const double q = image.values[i];
    const double z_m = integers ? q * units.of_integers_m : q > 0 ? a / (q - b) * units.of_floats_m : 0;
    depth.z_m[i] = measured_or_nan(z_m, max_depth_m);
  }
  return depth;
}

}  // namespace remote_touch
