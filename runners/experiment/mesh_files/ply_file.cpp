#include "runners/experiment/mesh_files/mesh_file.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "scenarios/files/input_files.h"

namespace remote_touch {
namespace {

constexpr std::size_t kMaxHeader = 1 << 20;

// The property as written in the file: types may be unknown.
struct PlyProperty {
  std::string name, type;
  std::string count;  // type of a list's length; empty: no list
  bool is_list() const { return !count.empty(); }
};
struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  std::string lines;  // lines of the header that describe it, without comments
};
struct PlyHeader {
  std::string format;   // ascii, binary_little_endian, binary_big_endian
  std::string opening;  // the lines before the first element, without comments
  std::vector<PlyElement> elements;
  std::size_t size = 0;  // number of bytes before the first element's data
  bool ends = false;
  std::optional<std::string> bad_count;  // count of an element if it is not a number
  bool is_ascii() const { return format == "ascii" || format.empty(); }
};

// Returns the size in bytes of a value of this type in a binary file; 0 if the type is unknown.
std::size_t size_of_ply(std::string_view type) {
  for (const char* one : {"char", "uchar", "int8", "uint8"})
    if (type == one) return 1;
  for (const char* two : {"short", "ushort", "int16", "uint16"})
    if (type == two) return 2;
  for (const char* four : {"int", "uint", "int32", "uint32", "float", "float32"})
    if (type == four) return 4;
  return type == "double" || type == "float64" ? 8 : 0;
}

// Returns the least number of bytes of an element. Each value of a text is a digit and a separator. A list
// may have no members. An unknown type counts as one byte.
std::uint64_t min_bytes(const PlyElement& element, bool is_ascii) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties)
    bytes += is_ascii
                 ? 2
                 : std::max<std::size_t>(1, size_of_ply(property.is_list() ? property.count : property.type));
  return bytes;
}

void take(std::string_view line, PlyHeader& header) {
  const std::vector<std::string_view> words = words_of_line(line);
  const auto word = [&](std::size_t i) { return std::string(i < words.size() ? words[i] : ""); };
  if (word(0) == "format" && words.size() > 1) {
    header.format = words[1];
  } else if (word(0) == "element") {
    PlyElement& added = header.elements.emplace_back();
    added.name = word(1);
    const std::string count = word(2);
    const char* end = count.data() + count.size();
    const auto [at, error] = std::from_chars(count.data(), end, added.count);
    if (error != std::errc() || at != end) header.bad_count = count;
  } else if (word(0) == "property" && !header.elements.empty()) {
    const bool is_list = word(1) == "list";
    header.elements.back().properties.push_back(is_list ? PlyProperty{word(4), word(3), word(2)}
                                                        : PlyProperty{word(2), word(1), ""});
  }
}

// Returns the header that begins the bytes. Lines end in \n, \r\n or \r. If the header has no end, all lines
// belong to it.
PlyHeader ply_header_in(const std::string& bytes) {
  PlyHeader header;
  while (header.size < bytes.size() && !header.ends) {
    const std::size_t begin = header.size, end = bytes.find_first_of("\r\n", begin);
    if (end == std::string::npos) break;
    const std::string line = bytes.substr(begin, end - begin);
    header.size = end + (bytes.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    header.ends = line == "end_header";
    take(line, header);
    // Comments are left out, because the library loses the properties that follow a comment within an
    // element.
    if (header.ends || line.starts_with("comment") || line.starts_with("obj_info")) continue;
    std::string& part = header.elements.empty() ? header.opening : header.elements.back().lines;
    part += bytes.substr(begin, header.size - begin);
  }
  return header;
}

bool is_float(std::string_view type) {
  return type == "float" || type == "float32" || type == "double" || type == "float64";
}

// True if the word is a value of this type.
bool is_value(std::string_view word, std::string_view type) {
  return is_float(type) ? number_of_word(word).has_value() : integer_of_word(word).has_value();
}

void require_known(const PlyHeader& header) {
  if (!header.is_ascii() && header.format != "binary_little_endian" && header.format != "binary_big_endian")
    throw std::runtime_error("format " + in_quotes(header.format) + ": expected ascii or a binary one");
  for (const PlyElement& element : header.elements)
    for (const PlyProperty& property : element.properties)
      if (size_of_ply(property.type) == 0 ||
          (property.is_list() && (size_of_ply(property.count) == 0 || is_float(property.count))))
        throw std::runtime_error("property " + in_quotes(property.name) + " of element " +
                                 in_quotes(element.name) + " has a type that is unknown");
}

[[noreturn]] void refuse_end(const PlyElement& element, std::uint64_t found) {
  throw std::runtime_error("it ends after " + std::to_string(found) + " of " + std::to_string(element.count) +
                           " elements " + in_quotes(element.name));
}

// Reads the data of an ASCII file line by line, and writes them without empty lines.
class TextRows {
 public:
  TextRows(const std::string& ply, std::size_t at) : ply_(ply), at_(at) {}

  // Returns the data of one element.
  std::string pass(const PlyElement& element) {
    std::string data;
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i) {
      const std::vector<std::string_view> words = next_line();
      if (words.empty()) refuse_end(element, i);
      require_row(element, words);
      for (const std::string_view word : words) data.append(word) += ' ';
      data.back() = '\n';
    }
    return data;
  }

  void finish() {
    if (!next_line().empty()) refuse_line(ply_, line_at_, "more than the elements that the header counts");
  }

 private:
  // Returns the words of the next line that is not empty; none at the end.
  std::vector<std::string_view> next_line() {
    while (at_ < ply_.size()) {
      line_at_ = at_;
      const std::size_t end = std::min(ply_.find_first_of("\r\n", at_), ply_.size());
      at_ = std::min(end + 1, ply_.size());
      std::vector<std::string_view> words =
          words_of_line(std::string_view(ply_).substr(line_at_, end - line_at_));
      if (!words.empty()) return words;
    }
    return {};
  }

  void require_row(const PlyElement& element, const std::vector<std::string_view>& words) const {
    std::size_t used = 0;
    const auto take = [&](const std::string& type) {
      if (used == words.size())
        refuse_line(ply_, line_at_,
                    "an element " + in_quotes(element.name) + " has only " + std::to_string(words.size()) +
                        " values");
      if (!is_value(words[used], type))
        refuse_line(ply_, line_at_, in_quotes(words[used]) + ": expected a number of type " + type);
      return words[used++];
    };
    for (const PlyProperty& property : element.properties) {
      std::int64_t values = 1;
      if (property.is_list()) values = integer_of_word(take(property.count)).value_or(0);
      if (values < 0) refuse_line(ply_, line_at_, "a list has " + std::to_string(values) + " values");
      for (std::int64_t i = 0; i < values; ++i) take(property.type);
    }
    if (used != words.size())
      refuse_line(ply_, line_at_,
                  "an element " + in_quotes(element.name) + " has " + std::to_string(words.size()) +
                      " values: expected " + std::to_string(used));
  }

  const std::string& ply_;
  std::size_t at_, line_at_ = 0;
};

// Copies the data of a binary file, element by element.
class BinaryRows {
 public:
  BinaryRows(const std::string& ply, std::size_t at, bool is_big_endian)
      : ply_(ply), at_(at), is_big_endian_(is_big_endian) {}

  std::string pass(const PlyElement& element) {
    const std::size_t begin = at_;
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const PlyProperty& property : element.properties) {
        std::uint64_t values = 1;
        if (property.is_list()) values = count(property.count, element, i);
        const std::uint64_t size = size_of_ply(property.type);
        if (values > (ply_.size() - at_) / size) refuse_end(element, i);
        at_ += values * size;
      }
    return ply_.substr(begin, at_ - begin);
  }

  // Accepts line feeds and blanks after the last element, and nothing else.
  void finish() const {
    if (ply_.find_first_not_of(" \t\r\n\v\f", at_) == std::string::npos) return;
    throw std::runtime_error("it has " + std::to_string(ply_.size() - at_) + " bytes after the last element");
  }

 private:
  // Reads the length of a list, of this type. Throws std::runtime_error if it is negative.
  std::uint64_t count(const std::string& type, const PlyElement& element, std::uint64_t done) {
    const std::size_t size = size_of_ply(type);
    if (size > ply_.size() - at_) refuse_end(element, done);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t byte = is_big_endian_ ? i : size - 1 - i;
      value = value << 8 | static_cast<unsigned char>(ply_[at_ + byte]);
    }
    at_ += size;
    if (!type.starts_with('u') && value >> (8 * size - 1) != 0)
      throw std::runtime_error("element " + in_quotes(element.name) + " " + std::to_string(done) +
                               " has a list of negative length");
    return value;
  }

  const std::string& ply_;
  std::size_t at_;
  bool is_big_endian_;
};

std::string with_line_feeds(const std::string& lines) {
  std::string text;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i] != '\r')
      text += lines[i];
    else if (lines.compare(i, 2, "\r\n") != 0)
      text += '\n';
  return text;
}

bool is_vertex(const PlyElement& element) {
  return element.name == "vertex";
}

// Returns the file with the vertices first.
template <class Rows>
std::string in_order(const PlyHeader& header, Rows rows) {
  std::string vertex_lines, lines, vertex_data, data;
  for (const PlyElement& element : header.elements) {
    (is_vertex(element) ? vertex_lines : lines) += element.lines;
    (is_vertex(element) ? vertex_data : data) += rows.pass(element);
  }
  rows.finish();
  const std::string body = vertex_data + data;
  // The library counts a line feed at the beginning of binary data as a part of the header. A second one is
  // therefore added.
  const char* const kept = !header.is_ascii() && body.starts_with('\n') ? "\n" : "";
  return with_line_feeds(header.opening + vertex_lines + lines) + "end_header\n" + kept + body;
}

}  // namespace

std::string ply_problem(const std::filesystem::path& file) {
  const std::uint64_t whole = std::filesystem::file_size(file);
  std::string bytes(std::min<std::uint64_t>(whole, kMaxHeader), '\0');
  std::ifstream in(file, std::ios::binary);
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  const PlyHeader header = ply_header_in(bytes);
  if (!header.ends) return "its header has no end";
  if (header.bad_count) return "its header has a count that is not a number: " + *header.bad_count;
  const std::uint64_t rest = whole - header.size;
  std::uint64_t claimed = 0, elements = 0;
  for (const PlyElement& element : header.elements) {
    const std::uint64_t bytes_of_one = std::max<std::uint64_t>(1, min_bytes(element, header.is_ascii()));
    std::uint64_t all = 0;
    if (__builtin_mul_overflow(element.count, bytes_of_one, &all) ||
        __builtin_add_overflow(claimed, all, &claimed) ||
        __builtin_add_overflow(elements, element.count, &elements))
      return "its header claims more than any file holds";
  }
  // The last number of a text needs no separator behind it.
  if (claimed > rest + (header.is_ascii() ? 1 : 0))
    return "its header claims " + std::to_string(elements) + " elements, more than its " +
           std::to_string(rest) + " bytes hold";
  return {};
}

std::string with_vertices_first(const std::string& ply) {
  const PlyHeader header = ply_header_in(ply);
  require_known(header);
  if (header.is_ascii()) return in_order(header, TextRows(ply, header.size));
  return in_order(header, BinaryRows(ply, header.size, header.format == "binary_big_endian"));
}

}  // namespace remote_touch
