#include "scenarios/recordings/images_and_clouds/pcd_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>

#include "scenarios/text_files/refuse.h"

namespace remote_touch {
namespace {

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
    refuse(file, keyword, " = ", shown(word), ": expected 1 to ", max);
  return value;
}

// Returns the lines up to DATA by keyword. If a keyword appears twice, the last line is used. Throws
// InputError for any other keyword, so that a file that is not PCD is detected at its first line.
Entries read_entries(const std::string& file, PcdText& rest) {
  Entries entries;
  while (!rest.text.empty() && !entries.contains("DATA")) {
    const Words words = rest.take_line();
    if (words.empty() || words[0].front() == '#') continue;
    if (std::find(kKeywords.begin(), kKeywords.end(), words[0]) == kKeywords.end()) {
      std::string allowed;
      for (const std::string_view keyword : kKeywords) allowed.append(" ").append(keyword);
      refuse(file + ":" + std::to_string(rest.line), shown(words[0]), " is not a PCD header entry: expected",
             allowed);
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
    if (!std::has_single_bit(field.size)) refuse(file, "SIZE = ", shown(sizes[f]), ": expected 1, 2, 4, 8");
    if (types[f] != "F" && types[f] != "I" && types[f] != "U")
      refuse(file, "TYPE = ", shown(types[f]), ": expected F, I, U");
    field.first_byte = header.point_bytes, header.point_bytes += field.size * field.count;
    field.first_value = header.point_values, header.point_values += field.count;
    header.fields.push_back(field);
  }
}

// A coordinate must be one floating-point value: integers would need a scale that PCD does not have.
PcdField coordinate(const std::string& file, const PcdHeader& header, const std::string& name) {
  const auto named = [&](const PcdField& field) { return field.name == name; };
  const auto found = std::find_if(header.fields.begin(), header.fields.end(), named);
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
  refuse(file, "POINTS = ", shown(points), ": expected WIDTH * HEIGHT = ", product);
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
      refuse(file, "VIEWPOINT has ", shown(word), ": expected numbers");
  }
  const Vec3 position(value[0], value[1], value[2]);
  const Eigen::Quaterniond turn(value[3], value[4], value[5], value[6]);
  if (position.isZero(0) && turn.vec().isZero(0)) return std::nullopt;
  if (!(std::abs(turn.norm() - 1) < 1e-3))
    refuse(file, "VIEWPOINT ends with a quaternion of length ", turn.norm(), ": expected 1");
  return Eigen::Translation3d(position) * turn.normalized();
}

}  // namespace

std::vector<std::string_view> PcdText::take_line() {
  const std::size_t length = std::min(text.find('\n'), text.size());
  const std::string_view taken = text.substr(0, length);
  text.remove_prefix(std::min(length + 1, text.size()));
  ++line;
  Words words;
  for (std::size_t at = taken.find_first_not_of(" \t\r"); at != taken.npos;) {
    const std::size_t end = std::min(taken.find_first_of(" \t\r", at), taken.size());
    words.push_back(taken.substr(at, end - at));
    at = taken.find_first_not_of(" \t\r", end);
  }
  return words;
}

std::string PcdField::text() const {
  return "TYPE " + std::string(1, type) + " SIZE " + std::to_string(size) + " COUNT " + std::to_string(count);
}

PcdHeader read_pcd_header(const std::string& file, PcdText& rest) {
  const Entries entries = read_entries(file, rest);
  const std::string_view version = entry(file, entries, "VERSION", 1)[0];
  if (std::find(kVersions.begin(), kVersions.end(), version) == kVersions.end())
    refuse(file, "VERSION = ", shown(version), ": expected 0.5, 0.6 or 0.7");
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
    refuse(file, "DATA = ", shown(header.encoding), ": expected ascii, binary, binary_compressed");
  return header;
}

std::string shown(std::string_view word) {
  std::string text(word.substr(0, 32));
  for (char& c : text) c = c >= ' ' && c <= '~' ? c : '?';
  return "'" + text + (word.size() > 32 ? "...'" : "'");
}

}  // namespace remote_touch
