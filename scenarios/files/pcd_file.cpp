#include "scenarios/files/depth_images.h"

#include <lzf.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string_view>
#include <vector>

#include "core/points/point_cloud.h"
#include "core/points/vector.h"
#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

// The header of a PCD file (Point Cloud Library, versions 0.5 to 0.7): text lines "KEYWORD value..." and #
// comments, up to and including the line DATA. The points follow it.

// The part of a PCD file that is not yet read, and the number of the line that was read last.
struct PcdText {
  std::string_view text;
  std::size_t line = 0;

  // Returns the words of the next line and removes the line from text.
  std::vector<std::string_view> take_line() {
    const std::string_view taken = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(taken.size() + 1, text.size()));
    ++line;
    return words_of_line(taken, " \t\r");
  }
};

// One field of the point layout: count values of size bytes each.
struct PcdField {
  std::string_view name;
  char type = 'F';  // F: floating point, I: signed, U: unsigned
  std::size_t size = 0, count = 0;
  std::size_t first_byte = 0, first_value = 0;  // start of this field within a point

  // Returns TYPE, SIZE and COUNT as the header spells them, for messages.
  std::string text() const {
    return "TYPE " + std::string(1, type) + " SIZE " + std::to_string(size) + " COUNT " +
           std::to_string(count);
  }
};

// Content of the header that is needed to decode DATA. All lengths are checked: points = width * height, and
// none is 0.
struct PcdHeader {
  std::vector<PcdField> fields;
  std::size_t width = 0, height = 0, points = 0;
  std::size_t point_bytes = 0, point_values = 0;
  std::string_view encoding;       // ascii, binary or binary_compressed
  PcdField x, y, z;                // TYPE F, SIZE 4 or 8, COUNT 1
  std::optional<PcdField> colour;  // rgb or rgba: SIZE 4, COUNT 1
  // VIEWPOINT: position and rotation of the sensor in the coordinates of the points. Empty if the sensor was
  // at the origin and not rotated, which is also the meaning of a file without a VIEWPOINT.
  std::optional<RigidTransform> X_FV;
};

// Returns a word of the file for a message: quoted, short and printable, even if the file is not text at all.
std::string shown_word(std::string_view word) {
  std::string text(word.substr(0, 32));
  for (char& c : text) c = c >= ' ' && c <= '~' ? c : '?';
  return "'" + text + (word.size() > 32 ? "...'" : "'");
}

using Words = std::vector<std::string_view>;
using Entries = std::map<std::string_view, Words>;

constexpr std::array<std::string_view, 11> kKeywords = {"VERSION",   "FIELDS", "COLUMNS", "SIZE",
                                                        "TYPE",      "COUNT",  "WIDTH",   "HEIGHT",
                                                        "VIEWPOINT", "POINTS", "DATA"};
constexpr std::array<std::string_view, 6> kVersions = {"0.7", ".7", "0.6", ".6", "0.5", ".5"};

// Limit of width and of height: the image layout counts in int, and width * height fits in 64 bits.
constexpr std::size_t kMaxSide = std::numeric_limits<int>::max();

// No length in a header may be 0; signs, fractions and trailing letters are refused.
std::size_t integer_value(const std::string& file, const std::string& keyword, std::string_view word,
                          std::size_t max) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || value < 1 || value > max)
    refuse(file, keyword, " = ", shown_word(word), ": expected 1 to ", max);
  return value;
}

// Returns the lines up to DATA by keyword. If a keyword appears twice, the last line is used. Throws
// InputError for any other keyword, so that a file that is not PCD is detected at its first line.
Entries read_entries(const std::string& file, PcdText& rest) {
  Entries entries;
  while (!rest.text.empty() && !entries.contains("DATA")) {
    const Words words = rest.take_line();
    if (words.empty() || words[0].front() == '#') continue;
    if (std::ranges::find(kKeywords, words[0]) == kKeywords.end()) {
      std::string allowed;
      for (const std::string_view keyword : kKeywords) allowed.append(" ").append(keyword);
      refuse(file + ":" + std::to_string(rest.line), shown_word(words[0]),
             " is not a PCD header entry: expected", allowed);
    }
    entries[words[0] == "COLUMNS" ? "FIELDS" : words[0]].assign(words.begin() + 1, words.end());
  }
  return entries;
}

const Words& entry(const std::string& file, const Entries& entries, const std::string& keyword) {
  const auto found = entries.find(keyword);
  if (found == entries.end()) refuse(file, "the PCD header has no ", keyword, " entry");
  return found->second;
}

const Words& entry(const std::string& file, const Entries& entries, const std::string& keyword,
                   std::size_t count) {
  const Words& words = entry(file, entries, keyword);
  if (words.size() == count) return words;
  refuse(file, keyword, " has ", words.size(), " values: expected ", count);
}

// Reads FIELDS, SIZE, TYPE and COUNT, one value each per field. A missing COUNT means 1 everywhere.
void read_fields(const std::string& file, const Entries& entries, PcdHeader& header) {
  const Words& names = entry(file, entries, "FIELDS");
  const std::size_t n = names.size();
  const Words& sizes = entry(file, entries, "SIZE", n);
  const Words& types = entry(file, entries, "TYPE", n);
  const Words counts = entries.contains("COUNT") ? entry(file, entries, "COUNT", n) : Words(n, "1");
  for (std::size_t f = 0; f < n; ++f) {
    PcdField field{names[f], types[f].front(), integer_value(file, "SIZE", sizes[f], 8)};
    field.count = integer_value(file, "COUNT", counts[f], std::numeric_limits<int>::max());
    if (!std::has_single_bit(field.size))
      refuse(file, "SIZE = ", shown_word(sizes[f]), ": expected 1, 2, 4, 8");
    if (types[f] != "F" && types[f] != "I" && types[f] != "U")
      refuse(file, "TYPE = ", shown_word(types[f]), ": expected F, I, U");
    field.first_byte = header.point_bytes, header.point_bytes += field.size * field.count;
    field.first_value = header.point_values, header.point_values += field.count;
    header.fields.push_back(field);
  }
}

// A coordinate must be one floating-point value: integers would need a scale that PCD does not have.
PcdField coordinate(const std::string& file, const PcdHeader& header, const std::string& name) {
  const auto named = [&](const PcdField& field) { return field.name == name; };
  const auto found = std::ranges::find_if(header.fields, named);
  if (found == header.fields.end()) refuse(file, "FIELDS has no ", name, ": expected x, y and z");
  if (found->type != 'F' || found->size < 4 || found->count != 1)
    refuse(file, "field ", name, " = ", found->text(), ": expected TYPE F SIZE 4 or 8 COUNT 1");
  return *found;
}

// Returns the first field named rgb or rgba. Its TYPE may be anything: the library itself writes the colour
// word as a float.
std::optional<PcdField> colour_field(const std::string& file, const PcdHeader& header) {
  for (const PcdField& field : header.fields) {
    if (field.name != "rgb" && field.name != "rgba") continue;
    if (field.size == 4 && field.count == 1) return field;
    refuse(file, "field ", field.name, " = ", field.text(), ": expected SIZE 4 COUNT 1");
  }
  return std::nullopt;
}

// Reads WIDTH, HEIGHT and POINTS, which must agree.
void read_lengths(const std::string& file, const Entries& entries, PcdHeader& header) {
  const std::string_view points = entry(file, entries, "POINTS", 1)[0];
  const bool in_no_order = !entries.contains("WIDTH") && !entries.contains("HEIGHT");
  const std::string_view width = in_no_order ? points : entry(file, entries, "WIDTH", 1)[0];
  const std::string_view height = in_no_order ? "1" : entry(file, entries, "HEIGHT", 1)[0];
  header.width = integer_value(file, "WIDTH", width, kMaxSide);
  header.height = integer_value(file, "HEIGHT", height, kMaxSide);
  const std::size_t product = header.width * header.height;
  header.points = integer_value(file, "POINTS", points, std::numeric_limits<std::size_t>::max());
  if (header.points == product) return;
  refuse(file, "POINTS = ", shown_word(points), ": expected WIDTH * HEIGHT = ", product);
}

// Reads tx ty tz qw qx qy qz. Some programs write zeros for "unknown", which means no rotation if the
// position is the origin.
std::optional<RigidTransform> read_viewpoint(const std::string& file, const Entries& entries) {
  if (!entries.contains("VIEWPOINT")) return std::nullopt;
  std::array<double, 7> value{};
  const Words& words = entry(file, entries, "VIEWPOINT", value.size());
  for (std::size_t i = 0; i < value.size(); ++i) {
    const std::string_view word = words[i];
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value[i]);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value[i]))
      refuse(file, "VIEWPOINT has ", shown_word(word), ": expected numbers");
  }
  const Vec3 position(value[0], value[1], value[2]);
  const Eigen::Quaterniond turn(value[3], value[4], value[5], value[6]);
  if (position.isZero(0) && turn.vec().isZero(0)) return std::nullopt;
  if (!(std::abs(turn.norm() - 1) < 1e-3))
    refuse(file, "VIEWPOINT ends with a quaternion of length ", turn.norm(), ": expected 1");
  return Eigen::Translation3d(position) * turn.normalized();
}

// Removes the header from rest, which then starts after the DATA line. The header's names are views into the
// text. Older versions have no VIEWPOINT, may say COLUMNS for FIELDS, and have no WIDTH and HEIGHT for points
// in no order. Throws InputError about file (with ":line" for a line that is not a valid entry) if an entry
// is missing or not allowed.
PcdHeader read_pcd_header(const std::string& file, PcdText& rest) {
  const Entries entries = read_entries(file, rest);
  const std::string_view version = entry(file, entries, "VERSION", 1)[0];
  if (std::ranges::find(kVersions, version) == kVersions.end())
    refuse(file, "VERSION = ", shown_word(version), ": expected 0.5, 0.6 or 0.7");
  PcdHeader header;
  read_fields(file, entries, header);
  header.x = coordinate(file, header, "x");
  header.y = coordinate(file, header, "y");
  header.z = coordinate(file, header, "z");
  header.colour = colour_field(file, header);
  read_lengths(file, entries, header);
  header.X_FV = read_viewpoint(file, entries);
  header.encoding = entry(file, entries, "DATA", 1)[0];
  if (header.encoding != "ascii" && header.encoding != "binary" && header.encoding != "binary_compressed")
    refuse(file, "DATA = ", shown_word(header.encoding), ": expected ascii, binary, binary_compressed");
  return header;
}

static_assert(std::endian::native == std::endian::little, "PCD data are little-endian");

constexpr std::uint32_t kRgb = 0xFFFFFF;  // mask for the colour in a word 0xAARRGGBB
// Maximum number of raw bytes for one byte of an LZF block: the longest back reference makes 264 out of 3.
constexpr std::size_t kLzfMaxExpansion = 88;

// Returns the whole file. Header and data are views into it.
std::string read_bytes(const std::filesystem::path& file) {
  std::error_code no_size;
  const std::uintmax_t size = std::filesystem::file_size(file, no_size);  // fails also for a folder
  if (no_size) refuse(file.string(), "cannot be read (", no_size.message(), "): expected a PCD file");
  std::string bytes(size, '\0');  // the size on disk, not one that the header claims
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size)))
    refuse(file.string(), "cannot be read to its end");
  return bytes;
}

// Throws InputError if the bytes behind the header cannot hold the points that it claims. Called before
// anything is allocated.
void check_claimed_size(const std::string& file, const PcdHeader& header, std::size_t data_bytes) {
  std::size_t max = data_bytes / header.point_bytes;
  if (header.encoding == "ascii") {
    max = (data_bytes + 1) / (2 * header.point_values);  // a digit and a separator
  } else if (header.encoding == "binary_compressed") {
    max = data_bytes * kLzfMaxExpansion / header.point_bytes;
  }
  if (header.points <= max) return;
  refuse(file, "POINTS = ", header.points, ": the ", data_bytes, " bytes of ", header.encoding,
         " data hold at most ", max);
}

// Reads a number; also nan and inf, which from_chars reads in every spelling of printf. Throws InputError
// about where for any other word.
double real_number(const std::string& where, std::string_view word) {
  const std::optional<double> value = number_of_word(word);
  if (!value) refuse(where, shown_word(word), ": expected a number or nan");
  return *value;
}

// Returns the colour in a word of text. The word is an integer or, for TYPE F, the float that has the bits of
// the colour. Some programs write the integer itself as TYPE F: an integer without point and exponent is read
// as a colour if its float bits hold none.
std::uint32_t ascii_colour(const std::string& where, const PcdField& field, std::string_view word) {
  const double value = real_number(where, word);
  if (std::isnan(value)) return kNoColour;
  const bool is_integer = value == std::floor(value) && std::abs(value) < 4294967296.0;
  if (field.type == 'F') {
    const std::uint32_t colour = colour_of_float(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    if (colour != kNoColour || !is_integer || word.find_first_of(".eE") != word.npos) return colour;
  }
  if (!is_integer) refuse(where, shown_word(word), ": expected a 32-bit colour");
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(value)) & kRgb;
}

// Reads point i from the words of its line, in the order of FIELDS. A coordinate is rounded to its SIZE, so
// that a cloud has the same bits in every encoding.
void read_ascii_point(const std::string& where, const PcdHeader& header,
                      const std::vector<std::string_view>& words, std::size_t i, PointCloud& cloud) {
  if (words.size() != header.point_values)
    refuse(where, words.size(), " values: expected ", header.point_values, ", as FIELDS and COUNT say");
  const auto read = [&](const PcdField& field) {
    const double value = real_number(where, words[field.first_value]);
    return field.size == 4 ? static_cast<float>(value) : value;
  };
  cloud.x[i] = read(header.x), cloud.y[i] = read(header.y), cloud.z[i] = read(header.z);
  if (header.colour) cloud.colour[i] = ascii_colour(where, *header.colour, words[header.colour->first_value]);
}

// Reads one point from each line. Empty lines are skipped. Throws InputError if another line follows the last
// point.
void read_ascii(const std::string& file, const PcdHeader& header, PcdText rest, PointCloud& cloud) {
  const auto where = [&] { return file + ":" + std::to_string(rest.line); };
  for (std::size_t i = 0; i < header.points;) {
    if (rest.text.empty()) refuse(file, "the data end after ", i, " points: POINTS = ", header.points);
    const std::vector<std::string_view> words = rest.take_line();
    if (!words.empty()) read_ascii_point(where(), header, words, i++, cloud);
  }
  while (!rest.text.empty()) {
    if (rest.take_line().empty()) continue;
    refuse(where(), "a line behind the last point: POINTS = ", header.points);
  }
}

// binary stores point after point; the raw block of binary_compressed stores field after field.
void read_binary(const PcdHeader& header, const char* bytes, bool field_after_field, PointCloud& cloud) {
  const auto value_at = [&](const PcdField& field, std::size_t i) {
    return field_after_field ? bytes + header.points * field.first_byte + i * field.size * field.count
                             : bytes + i * header.point_bytes + field.first_byte;
  };
  const auto read = [&](const PcdField& field, std::vector<double>& column) {
    for (std::size_t i = 0; i < header.points; ++i) {
      float single = 0;
      if (field.size == 8) {
        std::memcpy(&column[i], value_at(field, i), 8);
      } else {
        std::memcpy(&single, value_at(field, i), 4), column[i] = single;
      }
    }
  };
  read(header.x, cloud.x), read(header.y, cloud.y), read(header.z, cloud.z);
  for (std::size_t i = 0; i < cloud.colour.size(); ++i) {
    std::uint32_t& colour = cloud.colour[i];
    std::memcpy(&colour, value_at(*header.colour, i), 4);
    colour = header.colour->type == 'F' ? colour_of_float(colour) : colour & kRgb;
  }
}

// Returns the block expanded to raw_size bytes. Throws InputError if it has another size when expanded.
std::vector<char> expand(const std::string& file, std::string_view block, std::uint32_t raw_size) {
  std::vector<char> raw(raw_size);
  // liblzf checks every access except the one to the first byte.
  const unsigned expanded =
      block.empty() ? 0
                    : lzf_decompress(block.data(), static_cast<unsigned>(block.size()), raw.data(), raw_size);
  if (expanded != raw_size)
    refuse(file, "damaged LZF block of ", block.size(), " bytes: expected ", raw_size, " bytes from it");
  return raw;
}

// binary_compressed: two uint32, the compressed and the raw size in bytes, then the LZF block.
std::vector<char> read_compressed_block(const std::string& file, const PcdHeader& header,
                                        std::string_view data) {
  std::array<std::uint32_t, 2> sizes{};
  if (data.size() < sizeof sizes) refuse(file, "the data end before the sizes of the compressed block");
  std::memcpy(sizes.data(), data.data(), sizeof sizes);
  data.remove_prefix(sizeof sizes);
  if (sizes[0] > data.size())
    refuse(file, "compressed size = ", sizes[0], ": the file has ", data.size(), " bytes left");
  const std::size_t needed = header.points * header.point_bytes;
  if (sizes[1] != needed)
    refuse(file, "raw size = ", sizes[1], ": expected ", needed, ", as the header says");
  return expand(file, data.substr(0, sizes[0]), sizes[1]);
}

// Reverses each row.
template <class Value>
void mirror_rows(std::vector<Value>& values, int width) {
  for (auto row = values.begin(); row != values.end(); row += width) std::reverse(row, row + width);
}

// Transforms the cloud to a camera at X_FC, if a pinhole explains it from there. Otherwise returns false, and
// the cloud is as it was.
bool see_from(const RigidTransform& X_FC, PcdCloud& file) {
  PcdCloud seen = file;
  PointCloud& cloud = seen.cloud;
  const RigidTransform X_CF = X_FC.inverse();
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Vec3 p = X_CF * cloud.point(i);
    cloud.x[i] = p.x(), cloud.y[i] = p.y(), cloud.z[i] = p.z();
  }
  const auto each_column = [&](const auto& change) {
    change(cloud.x), change(cloud.y), change(cloud.z), change(cloud.colour);
  };
  // Tries the image as it is, mirrored left to right, upside down, and both.
  for (const bool upside_down : {false, true}) {
    if (upside_down) each_column([](auto& values) { std::ranges::reverse(values); });
    for (const bool mirrored : {false, true}) {
      if (mirrored) each_column([&](auto& values) { mirror_rows(values, seen.width); });
      cloud.image = fit_pinhole(cloud, seen.width, seen.height);
      if (!cloud.image) continue;
      seen.X_FC = X_FC;
      file = std::move(seen);
      return true;
    }
  }
  return false;
}

// Returns true if the camera is at the origin and looks along the z axis of the file or against it, with its
// rows along x. Programs disagree about these signs. Such a rotation therefore says nothing about an image
// that is seen from the origin along z.
bool keeps_axes(const RigidTransform& X_FV) {
  constexpr double kRounding = 1e-4;  // tolerance for quaternions that are written with few digits
  return X_FV.translation().isZero(0) && X_FV.linear().cwiseAbs().isIdentity(kRounding);
}

void find_image(const std::optional<RigidTransform>& X_FV, PcdCloud& file) {
  const bool is_organised = file.height > 1;
  if (is_organised) file.cloud.grid_columns = file.width;
  if (is_organised && X_FV && keeps_axes(*X_FV)) {  // first as it is: the points keep their bits
    file.cloud.image = fit_pinhole(file.cloud, file.width, file.height);
    if (file.cloud.image) return;
  }
  if (X_FV && is_organised) {
    const RigidTransform about_face(Eigen::AngleAxisd(std::numbers::pi, Vec3::UnitX()));
    if (see_from(*X_FV, file) || see_from(*X_FV * about_face, file)) return;
  }
  const PointCloud& cloud = file.cloud;
  const bool has_points = std::ranges::any_of(cloud.z, [](double z_m) { return !std::isnan(z_m); });
  file.has_unused_viewpoint = X_FV.has_value() && has_points;
  if (is_organised) file.cloud.image = fit_pinhole(file.cloud, file.width, file.height);
}

}  // namespace

PcdCloud read_pcd(const std::filesystem::path& file) {
  const std::string name = file.string();
  const std::string bytes = read_bytes(file);
  PcdText rest{without_byte_order_mark(bytes)};
  const PcdHeader header = read_pcd_header(name, rest);
  check_claimed_size(name, header, rest.text.size());

  PcdCloud result{{}, static_cast<int>(header.width), static_cast<int>(header.height)};
  PointCloud& cloud = result.cloud;
  cloud.x.resize(header.points), cloud.y.resize(header.points), cloud.z.resize(header.points);
  if (header.colour) cloud.colour.resize(header.points);
  if (header.encoding == "ascii") {
    read_ascii(name, header, rest, cloud);
  } else if (header.encoding == "binary") {
    read_binary(header, rest.text.data(), false, cloud);
  } else {
    read_binary(header, read_compressed_block(name, header, rest.text).data(), true, cloud);
  }
  mark_missing_points(cloud);
  find_image(header.X_FV, result);
  return result;
}

}  // namespace remote_touch
